#include "layers/layer_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace tessera::test
{

LayerReport underTheLayer(const std::function<void(Gpu&)>& use, bool feature)
{
	LayerReport report;
	const auto file = std::filesystem::temp_directory_path() / ("tessera_layer_report_" + std::to_string(getpid()) + ".json");
	setenv("TESSERA_CLUSTER_LAYER_REPORT", file.c_str(), 1);
	{
		const std::unique_ptr<Gpu> gpu = Gpu::make(feature);
		if (!gpu)
			return report;
		report.device = true;
		use(*gpu);
	}
	const auto json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
	EXPECT_FALSE(json.is_discarded()) << "no report in " << file;
	std::filesystem::remove(file);
	if (json.is_discarded())
		return report;
	for (const auto& [name, entry] : json["violations"].items())
	{
		report.violations[name] = entry["count"];
		report.texts[name] = entry["first"];
	}
	for (const auto& [name, entry] : json["limits"].items())
		report.limits[name] = entry["count"];
	report.counts = json["counts"].get<std::map<std::string, uint64_t>>();
	return report;
}

}  // namespace tessera::test
