#include "layers/layer_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace tessera::test
{

namespace
{

// The report of the only device that was given this name; a number follows it where the layer has written others in this process, as it has where
// something keeps it loaded between instances.
std::filesystem::path reportAt(const std::filesystem::path& file)
{
	for (const auto& entry : std::filesystem::directory_iterator(file.parent_path()))
		if (entry.path().filename().string().starts_with(file.filename().string()))
			return entry.path();
	return file;
}

}  // namespace

LayerReport underTheLayer(const std::function<void(Gpu&)>& use, bool feature)
{
	LayerReport report;
	static int calls = 0;
	const auto file =
		std::filesystem::temp_directory_path() / ("tessera_layer_report_" + std::to_string(getpid()) + "_" + std::to_string(++calls) + ".json");
	setenv("TESSERA_CLUSTER_LAYER_REPORT", file.c_str(), 1);
	{
		const std::unique_ptr<Gpu> gpu = Gpu::make(feature);
		if (!gpu)
			return report;
		report.device = true;
		use(*gpu);
	}
	const auto written = reportAt(file);
	const auto json = nlohmann::json::parse(std::ifstream(written), nullptr, false);
	EXPECT_FALSE(json.is_discarded()) << "no report in " << written;
	std::filesystem::remove(written);
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
