#include "app/verify_report.h"

#include "app/stats_json.h"

#include <cmath>

namespace tessera
{

using nlohmann::ordered_json;
using verify::NamedCheck;

namespace
{

// Numbers that JSON cannot say become text.
ordered_json number(double value)
{
	if (std::isfinite(value))
		return value;
	return std::isnan(value) ? "nan" : value > 0 ? "infinity" : "-infinity";
}

bool wasRun(const NamedCheck& check)
{
	return !check.result.sums.empty() || check.result.violations > 0;
}

ordered_json checkJson(const NamedCheck& check)
{
	ordered_json json = { { "run", wasRun(check) }, { "violations", check.result.violations } };
	if (check.result.violations > 0)
	{
		const verify::Place& place = check.result.place;
		json["worst"] = { { "size", number(check.result.worst) }, { "measure", check.measure }, { "what", place.what }, { "frame", place.frame } };
		const auto put = [&](const char* name, uint32_t index) {
			json["worst"][name] = index == NO_INDEX ? ordered_json(nullptr) : ordered_json(index);
		};
		put("instance", place.cluster.instance);
		put("cluster", place.cluster.cluster);
		put("triangle", place.triangle);
		if (place.point.u != NO_INDEX)
			json["worst"]["point"] = { place.point.u, place.point.v };
	}
	json["looked_at"] = ordered_json::object();
	for (const auto& [name, count] : check.result.sums)
		json["looked_at"][name] = count;
	json["measured"] = ordered_json::object();
	for (const auto& [name, value] : check.result.largest)
		json["measured"][name] = number(value);
	return json;
}

ordered_json seamsJson(const verify::SeamJump& seams)
{
	return {
		{ "points", seams.points },         { "largest_mesh_units", seams.largest_mesh },   { "mean_mesh_units", seams.meanMesh() },
		{ "largest_px", seams.largest_px }, { "largest_over_row", seams.largest_over_row }, { "place", seams.points > 0 ? describe(seams.place) : "" }
	};
}

std::string lookedAt(const verify::CheckResult& result)
{
	std::string text;
	for (const auto& [name, count] : result.sums)
		text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
	for (const auto& [name, value] : result.largest)
		text += fmt::format("{}{}: {:.3g}", text.empty() ? "" : ", ", name, value);
	return text;
}

}  // namespace

std::string verifyTable(const verify::Report& report, const Device& device, const BuiltScene& scene)
{
	std::string text = fmt::format("{} on {}, {} frames\n", scene.path, device.name, report.frames.size());
	if (!report.injected.empty())
		text += fmt::format("FAULT INJECTED: {}\n", report.injected);
	text += fmt::format("\n{:<22}{:>11}  {}\n", "check", "violations", "looked at");
	for (const NamedCheck& check : report.checks)
	{
		if (!wasRun(check))
		{
			text += fmt::format("{:<22}{:>11}  not run\n", check.name, "-");
			continue;
		}
		text += fmt::format("{:<22}{:>11}  {}\n", check.name, check.result.violations, lookedAt(check.result));
		if (check.result.violations > 0)
			text += fmt::format("{:<22}{:>11}  worst: {}\n", "", "", describe(check.result.place));
	}
	const verify::SeamJump& seams = report.seams;
	if (seams.points > 0)
		text += fmt::format(
			"\nseams: {} points whose height another triangle owns; jump within the first row at most {:.3g} mesh units ({:.3g} px, {:.3g} of "
			"the row's length), {:.3g} on average\n       largest: {}\n",
			seams.points, seams.largest_mesh, seams.largest_px, seams.largest_over_row, seams.meanMesh(), describe(seams.place));
	const verify::UsualWay& usual = report.usual_way;
	if (usual.points > 0)
		text += fmt::format("\nthe usual way, {} points on shared edges: {} cracks when each side displaces by its own normals and texture "
							"coordinates (largest gap {:.3g} "
							"mesh units), {} with float barycentrics too ({:.3g}), {} triangles lost by clamping to the lists; here {}\n",
							usual.points, usual.own_sides, usual.own_sides_gap, usual.barycentrics, usual.barycentrics_gap, usual.lost,
							report.checks.front().result.violations);
	return text;
}

std::string violatedChecks(const verify::Report& report)
{
	std::string text;
	for (const NamedCheck& check : report.checks)
		if (check.result.violations > 0)
			text += fmt::format("{}{} {}", text.empty() ? "" : ", ", check.name, check.result.violations);
	return text;
}

ordered_json verifyJson(const verify::Report& report, const Device& device, const BuiltScene& scene, const AppOptions& options, uint64_t seed,
						const std::string& inject)
{
	ordered_json json = { { "schema", 1 },  { "device", deviceJson(device) },     { "scene", sceneJson(scene) }, { "options", optionsJson(options) },
						  { "seed", seed }, { "violations", report.violations() } };
	json["injected"] = inject.empty() ? ordered_json(nullptr) : ordered_json{ { "fault", inject }, { "where", report.injected } };
	for (const NamedCheck& check : report.checks)
		json["checks"][std::string(check.name)] = checkJson(check);
	json["seams"] = seamsJson(report.seams);
	const verify::UsualWay& usual = report.usual_way;
	if (usual.points > 0)
		json["usual_way"] = { { "points", usual.points },
							  { "own_sides", { { "cracks", usual.own_sides }, { "largest_gap_mesh_units", usual.own_sides_gap } } },
							  { "float_barycentrics", { { "cracks", usual.barycentrics }, { "largest_gap_mesh_units", usual.barycentrics_gap } } },
							  { "lost_triangles", usual.lost } };
	json["frames"] = ordered_json::array();
	for (const verify::FrameLine& frame : report.frames)
		json["frames"].push_back({ { "camera", frame.camera },
								   { "rate_wanted", frame.rate_wanted },
								   { "rate_granted", frame.every_factor_one ? ordered_json("every factor is 1") : ordered_json(frame.rate_granted) },
								   { "micro_triangles", frame.micro_triangles },
								   { "covered_pixels", frame.covered_pixels },
								   { "violations", frame.violations } });
	return json;
}

}  // namespace tessera
