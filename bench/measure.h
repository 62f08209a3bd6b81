// Draws the cases, one renderer each, on one device.
#pragma once
#include "bench/markdown.h"
#include "gpu/device.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace tessera::bench
{

// The rows that came of a run, and the raster paths that this device cannot do.
struct Measurements
{
	std::string device;
	std::string peer_device;
	std::vector<Row> rows;
	std::map<std::string, std::string> closed;
};

class Bench
{
public:
	// Finds scenes and the peer's times, makes the device. Errors: BadInput (no scenes folder, peer's file),
	// DeviceCannot (no device, one without timestamps).
	static Result<std::unique_ptr<Bench>> create(const Settings& settings);
	virtual ~Bench() = default;

	// Draws every case; one that fails becomes a failed row. A lost device is made anew. `after_row` sees all rows so far,
	// so that they can be written: an error of it ends the run.
	virtual Status run(const std::vector<Case>& cases, const std::function<Status(const Measurements&)>& after_row) = 0;

	virtual const Measurements& measurements() const = 0;
	// Of the layer, with --validate.
	virtual uint32_t validationMessages() const = 0;
};

}  // namespace tessera::bench
