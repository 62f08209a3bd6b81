// The built shaders, read as binaries: records lie where C++ has them, and shared float code was compiled as it is written
// (DESIGN.md, section 5: NoContraction, exact operations only, rounding modes). Needs no device.
#include "culling/cluster_cull.h"
#include "raster/dump_micro.h"
#include "raster/evaluate_vertices.h"
#include "raytracing/expand_meshes.h"
#include "raytracing/list_clusters.h"
#include "raytracing/place_instances.h"
#include "shading/shade.h"
#include "spirv_module.h"
#include "tessellation/rate_fit.h"
#include "tessellation/rate_search.h"
#include "tessellation/triangle_split.h"

#include "base/file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace tessera::test
{

namespace
{

using Paths = std::vector<std::filesystem::path>;

Paths filesBelow(const std::filesystem::path& folder, const std::string& suffix)
{
	Paths paths;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
		if (entry.path().extension() == suffix)
			paths.push_back(entry.path());
	std::sort(paths.begin(), paths.end());
	return paths;
}

std::string textOf(const std::filesystem::path& path)
{
	std::ifstream file(path);
	return (std::stringstream() << file.rdbuf()).str();
}

const std::vector<SpirvModule>& builtModules()
{
	static const std::vector<SpirvModule> modules = [] {
		std::vector<SpirvModule> read;
		for (const auto& path : filesBelow(programFolder() / "shaders", ".spv"))
			read.push_back(readSpirv(spirvWords(path), path.filename().string()));
		return read;
	}();
	return modules;
}

std::vector<std::smatch> matchesOf(const std::string& text, const std::regex& pattern)
{
	return { std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator() };
}

// --- layout ----------------------------------------------------------------------------------------------------------------------

struct Field
{
	std::string name;
	size_t offset;
};

struct HostLayout
{
	std::string name;
	size_t size;
	std::vector<Field> fields;
};

#define FIELD(T, member)             \
	Field                            \
	{                                \
#member, offsetof(T, member) \
	}
#define FIELDS_1(T, a) FIELD(T, a)
#define FIELDS_2(T, a, ...) FIELD(T, a), FIELDS_1(T, __VA_ARGS__)
#define FIELDS_3(T, a, ...) FIELD(T, a), FIELDS_2(T, __VA_ARGS__)
#define FIELDS_4(T, a, ...) FIELD(T, a), FIELDS_3(T, __VA_ARGS__)
#define FIELDS_5(T, a, ...) FIELD(T, a), FIELDS_4(T, __VA_ARGS__)
#define FIELDS_6(T, a, ...) FIELD(T, a), FIELDS_5(T, __VA_ARGS__)
#define FIELDS_7(T, a, ...) FIELD(T, a), FIELDS_6(T, __VA_ARGS__)
#define FIELDS_8(T, a, ...) FIELD(T, a), FIELDS_7(T, __VA_ARGS__)
#define FIELDS_9(T, a, ...) FIELD(T, a), FIELDS_8(T, __VA_ARGS__)
#define FIELDS_10(T, a, ...) FIELD(T, a), FIELDS_9(T, __VA_ARGS__)
#define FIELDS_11(T, a, ...) FIELD(T, a), FIELDS_10(T, __VA_ARGS__)
#define FIELDS_12(T, a, ...) FIELD(T, a), FIELDS_11(T, __VA_ARGS__)
#define FIELDS_13(T, a, ...) FIELD(T, a), FIELDS_12(T, __VA_ARGS__)
#define FIELDS_14(T, a, ...) FIELD(T, a), FIELDS_13(T, __VA_ARGS__)
#define FIELDS_15(T, a, ...) FIELD(T, a), FIELDS_14(T, __VA_ARGS__)
#define FIELDS_16(T, a, ...) FIELD(T, a), FIELDS_15(T, __VA_ARGS__)
#define FIELDS_17(T, a, ...) FIELD(T, a), FIELDS_16(T, __VA_ARGS__)
#define FIELDS_18(T, a, ...) FIELD(T, a), FIELDS_17(T, __VA_ARGS__)
#define FIELDS_19(T, a, ...) FIELD(T, a), FIELDS_18(T, __VA_ARGS__)
#define FIELDS_20(T, a, ...) FIELD(T, a), FIELDS_19(T, __VA_ARGS__)
#define FIELDS_21(T, a, ...) FIELD(T, a), FIELDS_20(T, __VA_ARGS__)
#define FIELDS_22(T, a, ...) FIELD(T, a), FIELDS_21(T, __VA_ARGS__)
#define FIELDS_23(T, a, ...) FIELD(T, a), FIELDS_22(T, __VA_ARGS__)
#define LAYOUT(count, T, ...)              \
	HostLayout                             \
	{                                      \
#T, sizeof(T),                     \
		{                                  \
			FIELDS_##count(T, __VA_ARGS__) \
		}                                  \
	}

HostLayout viewLayout()
{
	HostLayout layout = LAYOUT(13, View, eye_high, eye_low, right, up, forward, unit, inverse_unit_squared, focal_x, focal_y, depth_slope,
							   depth_offset, w_slope, w_offset);
	const HostLayout rest =
		LAYOUT(16, View, near, distance_weight, distance_floor_squared, rate_over_focal_squared, sample_over_focal_squared, displacement_scale,
			   displacement_offset, width_px, height_px, width_subpixels, height_subpixels, ray_first, ray_x, ray_y, draw_eye, draw_offset);
	layout.fields.insert(layout.fields.end(), rest.fields.begin(), rest.fields.end());
	const HostLayout sides = LAYOUT(9, View, side_x, side_y, ahead, side_x_ahead, side_y_ahead, side_x_from, side_y_from, behind_from, unseen_growth);
	layout.fields.insert(layout.fields.end(), sides.fields.begin(), sides.fields.end());
	return layout;
}

HostLayout clusterWorkLayout()
{
	HostLayout layout = LAYOUT(12, ClusterWork, counts, instances, templates, transient_units, instantiations, instantiation_destinations,
							   instantiation_places, transients, transient_destinations, transient_places, vertices, indices);
	const HostLayout rest = LAYOUT(13, ClusterWork, payloads, references, structures, structure_addresses, structure_bytes, data, reserved,
								   unit_bytes, scene_clusters, scene_instances, truncated_bits, geometry, unused);
	layout.fields.insert(layout.fields.end(), rest.fields.begin(), rest.fields.end());
	return layout;
}

// Records that several stages share, member by member.
std::vector<HostLayout> hostLayouts()
{
	return {
		viewLayout(),
		LAYOUT(11, InstanceRecord, row0, row1, row2, translation_high, translation_low, inverse_scale_squared, mesh, mirrored, vertex_place,
			   triangle_place, reach),
		LAYOUT(4, ClusterRecord, first_vertex, first_triangle, counts, material),
		LAYOUT(2, MeshRecord, first_cluster, cluster_count),
		LAYOUT(2, ClusterRef, instance, cluster),
		LAYOUT(10, HeightMap, texels, width, height, level_count, format, wrap_u, wrap_v, factor, offset, level_first),
		LAYOUT(5, SeamEdge, uv_first, uv_second, density_first, density_second, height_map),
		LAYOUT(3, SeamCorner, uv, density, height_map),
		LAYOUT(2, TriangleDetail, curves, bias),
		LAYOUT(3, HiddenInstance, distance_world, margin, frames),
		LAYOUT(15, Surface, positions, directions, uvs, densities, triangles, first_seam_edges, seam_edges, seam_corner_indices, seam_corners,
			   material_height_maps, height_maps, triangle_details, edge_roughness, pn_directions, hidden_instances),
		LAYOUT(8, ListHead, group_width, group_rows, group_depth, wanted, capacity, peak, peak_used, unused),
		LAYOUT(23, FrameCounts, overflow, covered_pixels, micro_low, micro_high, full_cluster_triangles, expanded_triangles, rate_step, listed_again,
			   levels_missing, search_finished, second_batches, hidden_parts, revealed_parts, hidden_clusters, revealed_clusters, dump_vertices,
			   dump_triangles, left_items, hidden_instances, shown_instances, shared_instances, shared_clusters, split_count),
		LAYOUT(11, RateStep, rate_over_focal_squared, sample_over_focal_squared, rule, split_triangles, part_triangles, part_vertices,
			   part_micro_triangles, full_clusters, full_vertices, full_micro_triangles, abandoned),
		LAYOUT(3, ClusterGroup, instance, first_cluster, cluster_count),
		LAYOUT(3, FullCluster, visible_cluster, first_vertex, phase),
		LAYOUT(3, Batch, parts, counts, first_vertex),
		LAYOUT(4, PatternRange, first_triangle, first_vertex, counts, unused),
		LAYOUT(3, TableView, patterns, vertices, triangles),
		LAYOUT(1, DomainTriangle, words),
		LAYOUT(10, DisplacedBounds, low, high, direction_low, direction_high, reach_low, reach_high, cone_axis, cone_cutoff, bulge, longest_edge),
		LAYOUT(7, RasterInputs, instances, clusters, visible_clusters, part_triangles, part_places, material_flags, table),
		LAYOUT(5, MaterialRecord, base_color, emissive, metallic, roughness, color_texture),
		LAYOUT(4, ShadingData, normals, color_uvs, colors, materials),
		LAYOUT(5, IndexedDraw, index_count, instance_count, first_index, vertex_offset, first_instance),
		LAYOUT(2, FactorRule, table_size, max_split),
		LAYOUT(5, DumpVertex, displaced, normal, owner, u, v),
		LAYOUT(2, DumpTriangle, corners, payload),
		LAYOUT(5, InstantiationInfo, id, geometry, source, vertices, vertex_bytes),
		LAYOUT(11, TransientInfo, id, flags, counts, geometry, strides, more_strides, indices, vertices, geometries, micromaps, micromap_indices),
		LAYOUT(3, StructureInfo, count, stride, clusters),
		LAYOUT(3, ClusterTemplate, address, units, counts),
		LAYOUT(2, ClusterPlace, instance, place),
		LAYOUT(4, InstanceClusters, count, first, structure, unused),
		LAYOUT(7, ClusterCounts, wanted, built_instantiations, built_transients, structures, references, structure_units, unused),
		clusterWorkLayout(),
		LAYOUT(7, ListClustersArgs, inputs, heads, counts, full_clusters, window_vertices, vertices, work),
		LAYOUT(6, RayInstance, row0, row1, row2, index_and_mask, offset_and_flags, structure),
		LAYOUT(3, RaySharing, most_reach_squared, most_span_squared, tessellates),
		LAYOUT(7, ExpandMeshesArgs, clusters, vertices, indices, first_cluster, cluster_count, vertex_place, triangle_place),
		LAYOUT(4, DumpItem, first_vertex, vertex_count, first_triangle, triangle_count),
		LAYOUT(7, DumpHead, items, vertices, triangles, item_capacity, vertex_capacity, triangle_capacity, unused),
	};
}

// What differs between host and one module's struct, empty when nothing does.
std::string layoutDifference(const HostLayout& host, const SpirvStruct& device)
{
	if (device.members.size() != host.fields.size())
		return fmt::format("{} members, {} in C++", device.members.size(), host.fields.size());
	for (size_t i = 0; i < host.fields.size(); ++i)
	{
		if (device.members[i] != host.fields[i].name)
			return fmt::format("member {} is {}, {} in C++", i, device.members[i], host.fields[i].name);
		if (device.offsets[i] != host.fields[i].offset)
			return fmt::format("{} at {}, {} in C++", host.fields[i].name, *device.offsets[i], host.fields[i].offset);
	}
	if (device.stride && *device.stride != host.size)
		return fmt::format("stride {}, {} bytes in C++", *device.stride, host.size);
	return {};
}

// Structs of a name that lie in buffers or push constants.
std::vector<std::pair<const SpirvModule*, const SpirvStruct*>> laidOut(const std::string& name)
{
	std::vector<std::pair<const SpirvModule*, const SpirvStruct*>> found;
	for (const SpirvModule& module : builtModules())
		for (const SpirvStruct& candidate : module.structs)
			if (candidate.name == name && !candidate.offsets.empty() && candidate.offsets[0])
				found.emplace_back(&module, &candidate);
	return found;
}

}  // namespace

TEST(sharedLayout, everyMemberOfTheMainRecordsLiesWhereCppHasIt)
{
	for (const HostLayout& host : hostLayouts())
	{
		const auto found = laidOut(host.name);
		EXPECT_FALSE(found.empty()) << host.name << ": no shader has it";
		for (const auto& [module, device] : found)
			EXPECT_EQ(layoutDifference(host, *device), "") << module->file << ": " << host.name;
	}
}

// C++ holds every record's size and last offset to its SHARED_LAYOUT line when it compiles; here the shaders are held to it.
TEST(sharedLayout, everyRecordHasTheSizeAndLastOffsetThatItsHeaderSays)
{
	const std::regex line(R"(\nSHARED_LAYOUT\((\w+), (\d+), (\w+), (\d+)\))");
	size_t records = 0, strides = 0;
	for (const auto& path : filesBelow(TESSERA_SHADER_SOURCES, ".h"))
	{
		const std::string text = textOf(path);
		for (const std::smatch& match : matchesOf(text, line))
			for (const auto& [module, device] : laidOut(match[1]))
			{
				++records;
				EXPECT_EQ(device->members.back(), match[3]) << module->file << ": " << match[1];
				EXPECT_EQ(device->offsets.back(), std::stoul(match[4])) << module->file << ": " << match[1] << "." << match[3];
				if (device->stride)
				{
					++strides;
					EXPECT_EQ(*device->stride, std::stoul(match[2])) << module->file << ": stride of " << match[1];
				}
			}
	}
	EXPECT_GT(records, 100u);
	EXPECT_GT(strides, 50u);
}

TEST(sharedLayout, aMovedMemberIsSeen)
{
	const auto found = laidOut("View");
	ASSERT_FALSE(found.empty());
	SpirvStruct moved = *found[0].second;
	moved.offsets[5] = *moved.offsets[5] + 4;
	EXPECT_NE(layoutDifference(viewLayout(), moved), "");
	SpirvStruct wider = *found[0].second;
	wider.stride = 128;
	EXPECT_NE(layoutDifference(viewLayout(), wider), "");
}

// --- float code ------------------------------------------------------------------------------------------------------------------

namespace
{

// Functions of the shared headers whose floats must be the same everywhere. bounds.h only culls: it is conservative instead. ray_sharing.h chooses
// between two ways to the same picture.
std::set<std::string> exactFunctions()
{
	const std::regex function(R"(\nSHARED_FN [\w ]*?(\w+)\()");
	std::set<std::string> names;
	for (const auto& path : filesBelow(std::filesystem::path(TESSERA_SHADER_SOURCES) / "shared", ".h"))
		if (path.filename() != "bounds.h" && path.filename() != "ray_sharing.h")
		{
			const std::string text = textOf(path);
			for (const std::smatch& match : matchesOf(text, function))
				names.insert(match[1]);
		}
	return names;
}

// Extended instructions (GLSL.std.450) that are exact: |x|, sign and floor, minimum, maximum and clamp, bit search.
bool isExact(uint32_t extended)
{
	constexpr uint32_t kExact[] = { 4, 5, 6, 7, 8, 37, 38, 39, 40, 41, 42, 43, 44, 45, 73, 74, 75 };
	return std::find(std::begin(kExact), std::end(kExact), extended) != std::end(kExact);
}

// Division, remainders, products of vectors and matrices, dot: rounded as a device likes, or contracted inside. Texture reads.
bool isForbidden(uint32_t opcode)
{
	return opcode == kOpFDiv || (opcode >= 140 && opcode <= 148) || (opcode >= 86 && opcode <= 98);
}

struct FloatCheck
{
	uint64_t operations = 0;
	std::set<std::string> functions;  // that were seen
	std::vector<std::string> problems;

	void check(const SpirvModule& module, const SpirvFunction& function)
	{
		functions.insert(function.name);
		for (const SpirvInstruction& instruction : function.body)
		{
			const auto report = [&](const std::string& what) {
				problems.push_back(fmt::format("{}: {}: {}", module.file, function.name, what));
			};
			if (instruction.opcode == kOpFAdd || instruction.opcode == kOpFSub || instruction.opcode == kOpFMul)
			{
				++operations;
				if (!module.no_contraction.count(instruction.operands[1]))
					report(fmt::format("opcode {} at word {} may be contracted", instruction.opcode, instruction.first_word));
			}
			if (isForbidden(instruction.opcode))
				report(fmt::format("opcode {} at word {} is not exact", instruction.opcode, instruction.first_word));
			if (instruction.opcode == kOpExtInst && !isExact(instruction.operands[3]))
				report(fmt::format("extended instruction {} at word {} is not exact", instruction.operands[3], instruction.first_word));
		}
	}

	void check(const SpirvModule& module, const std::set<std::string>& exact)
	{
		if (!module.modes.count({ kModeRoundingRte, 32 }))
			problems.push_back(module.file + ": does not declare RoundingModeRTE 32");
		if (!module.modes.count({ kModeSignedZeroInfNanPreserve, 32 }))
			problems.push_back(module.file + ": does not declare SignedZeroInfNanPreserve 32");
		for (const SpirvFunction& function : module.functions)
			if (exact.count(function.name))
				check(module, function);
	}
};

std::string joined(const std::vector<std::string>& lines)
{
	std::string text;
	for (const std::string& line : lines)
		text += line + "\n";
	return text;
}

std::vector<std::string> problemsOf(const std::vector<uint32_t>& words)
{
	FloatCheck check;
	check.check(readSpirv(words, "changed"), exactFunctions());
	return check.problems;
}

// The shader with most of the shared code.
std::vector<uint32_t> shadeWords()
{
	return spirvWords(programFolder() / "shaders/shading/shade.comp.spv");
}

// The place of the first instruction with this opcode in an exact function.
size_t firstWordOf(const std::vector<uint32_t>& words, uint32_t opcode)
{
	const std::set<std::string> exact = exactFunctions();
	for (const SpirvFunction& function : readSpirv(words, "shade").functions)
		if (exact.count(function.name))
			for (const SpirvInstruction& instruction : function.body)
				if (instruction.opcode == opcode)
					return instruction.first_word;
	return 0;
}

}  // namespace

TEST(sharedFloatCode, isNeverContractedAndUsesOnlyExactOperations)
{
	const std::set<std::string> exact = exactFunctions();
	FloatCheck check;
	for (const SpirvModule& module : builtModules())
		check.check(module, exact);
	EXPECT_EQ(joined(check.problems), "");
	EXPECT_GT(check.operations, 200u);
	for (const char* name :
		 { "edgeHasAtLeast", "viewEdge",       "unseenSquared",  "hiddenSquared",  "triangleReach",   "weighted",      "weightedVec3",
		   "normalized",     "placed",         "affineRow",      "clipPosition",   "cameraRelative",  "scaledRow",     "rateDistanceSquared",
		   "placementOf",    "domainWeights",  "foldCoordinate", "texelPlace",     "texelHeight",     "blendHeights",  "levelHeight",
		   "roughLog2",      "heightLevel",    "heightAt",       "displacementAt", "displacedPoint",  "displaced",     "sampleAtPoint",
		   "sampleAtVertex", "seamEdgeSource", "edgeByMetric",   "edgeByDetail",   "edgeAsDisplaced", "longestWithin", "nearestDistanceSquared",
		   "basePoint",      "pnRise",         "pnCoefficient",  "pnCoefficients", "pnTakenAway",     "pnPoint" })
		EXPECT_TRUE(check.functions.count(name)) << name << ": no shader has it, so it was not checked";
}

TEST(sharedFloatCode, everyLostNoContractionIsSeen)
{
	const std::vector<uint32_t> words = shadeWords();
	const SpirvModule module = readSpirv(words, "shade");
	ASSERT_TRUE(problemsOf(words).empty()) << joined(problemsOf(words));
	size_t stripped = 0;
	const std::set<std::string> exact = exactFunctions();
	for (const SpirvFunction& function : module.functions)
		if (exact.count(function.name))
			for (const SpirvInstruction& instruction : function.body)
				if (instruction.opcode == kOpFMul && stripped < 20)
				{
					std::vector<uint32_t> changed = words;
					const size_t decoration = module.no_contraction_words.at(instruction.operands[1]);
					changed[decoration + 2] = 0;  // RelaxedPrecision instead
					EXPECT_EQ(problemsOf(changed).size(), 1u) << function.name;
					++stripped;
				}
	EXPECT_EQ(stripped, 20u);
}

TEST(sharedFloatCode, aDivisionASquareRootAndAMissingModeAreSeen)
{
	const std::vector<uint32_t> words = shadeWords();
	std::vector<uint32_t> divides = words;
	const size_t product = firstWordOf(words, kOpFMul);
	divides[product] = (words[product] & 0xffff0000u) | kOpFDiv;
	EXPECT_EQ(problemsOf(divides).size(), 1u);

	std::vector<uint32_t> takes_root = words;
	takes_root[firstWordOf(words, kOpExtInst) + 4] = 31;
	EXPECT_EQ(problemsOf(takes_root).size(), 1u);

	for (const uint32_t mode : { kModeRoundingRte, kModeSignedZeroInfNanPreserve })
	{
		std::vector<uint32_t> changed = words;
		for (size_t at = 5; at < changed.size(); at += changed[at] >> 16)
			if ((changed[at] & 0xffffu) == 16 && changed[at + 2] == mode)
				changed[at + 3] = 64;
		EXPECT_EQ(problemsOf(changed).size(), 1u) << mode;
	}
}

TEST(sharedFloatCode, theHeadersAreReallyScanned)
{
	const std::set<std::string> exact = exactFunctions();
	EXPECT_GT(exact.size(), 50u);
	EXPECT_TRUE(exact.count("edgeHasAtLeast") && exact.count("clipPosition") && exact.count("surfaceVertex"));
	EXPECT_FALSE(exact.count("displacedBox"));
}

}  // namespace tessera::test
