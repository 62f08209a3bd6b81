// What the cluster layer reports of one device's life.
#pragma once
#include "layers/cluster_harness.h"

#include <cstdint>
#include <map>

namespace tessera::test
{

struct LayerReport
{
	bool device = false;  // false: no device here can do it, the test is skipped
	std::map<std::string, uint64_t> violations, limits, counts;
	std::map<std::string, std::string> texts;  // of the first of each name
};

// Runs `use` on a device under the layer and returns what was reported when it was gone.
LayerReport underTheLayer(const std::function<void(Gpu&)>& use, bool feature = true);

}  // namespace tessera::test
