#include "report/metric_fronts.h"
#include "report/page_original.h"

namespace tessera::report
{

namespace
{

// The floor is that of any run of its size.
nlohmann::json originalJson(const ReportData& data)
{
	if (!data.original)
		return {};
	nlohmann::json json = { { "path", data.original->path }, { "triangles", data.original->triangles }, { "words", describeOriginal(data) } };
	for (const auto& runs : bySize(data.runs))
		for (const Run* run : runs)
			if (hasOriginal(*run))
			{
				json["sizes"].push_back({ { "size", { run->setting.width, run->setting.height } },
										  { "floor", originalErrorJson(run->surface->original->floor) },
										  { "undisplaced", originalErrorJson(run->surface->original->undisplaced) } });
				break;
			}
	return json;
}

}  // namespace

nlohmann::json reportJson(const ReportData& data)
{
	nlohmann::json json = {
		{ "schema", 1 },         { "scene", data.scene },   { "command", data.command },       { "version", data.version },
		{ "facts", data.facts }, { "closed", data.closed }, { "bytes_kept", data.bytes_kept }, { "bytes_saved", data.bytes_saved }
	};
	json["runs"] = nlohmann::json::array();
	for (const Run& run : data.runs)
		json["runs"].push_back(runJson(run));
	json["front"] = nlohmann::json::object();
	for (const ErrorKind kind : kErrorKinds)
		for (const auto& runs : bySize(data.runs))
			for (const size_t i : paretoFront(runs, kind))
				json["front"][std::string(keyOf(kind))].push_back(runs[i]->setting.label());
	json["metrics"] = nlohmann::json::array();
	for (const ErrorKind kind : { ErrorKind::SeenP99, ErrorKind::SeenMax })
		for (const Cost cost : { Cost::Time, Cost::Triangles })
			for (const MetricComparison& c : compareMetrics(data.runs, kind, cost))
				json["metrics"].push_back({ { "metric", c.metric },
											{ "baseline", c.baseline },
											{ "raster", c.raster },
											{ "size", { c.width, c.height } },
											{ "error", keyOf(kind) },
											{ "cost", cost == Cost::Time ? "gpu_ms" : "micro_triangles" },
											{ "ratio", c.ratio },
											{ "worst_ratio", c.worst_ratio },
											{ "least_px", c.least_px },
											{ "most_px", c.most_px } });
	json["original"] = originalJson(data);
	json["left_out"] = nlohmann::json::array();
	for (const LeftOut& item : data.left_out)
		json["left_out"].push_back({ { "kind", item.kind },
									 { "name", item.name },
									 { "reason", item.reason },
									 { "bytes", item.bytes },
									 { "saved_ms", item.saved_ms ? nlohmann::json(*item.saved_ms) : nlohmann::json() },
									 { "noise_ms", item.noise_ms },
									 { "not_measured", item.not_measured },
									 { "measured_with", item.measured_with } });
	json["advice"] = nlohmann::json::array();
	for (const Advice& advice : recommend(data.runs, data.limits))
		json["advice"].push_back(advice.text);
	return json;
}

}  // namespace tessera::report
