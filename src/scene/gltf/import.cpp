#include "scene/gltf_import.h"

#include "base/check.h"
#include "base/file.h"
#include "base/parallel.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/material.h"
#include "scene/gltf/material_variants.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/primitive.h"

#include <algorithm>
#include <limits>

namespace tessera
{

namespace
{

// One primitive to decode, and what came of it.
struct PrimitiveJob
{
	size_t mesh = 0;
	size_t primitive = 0;
	Result<std::optional<Primitive>> result = std::nullopt;
	GltfWarnings warnings;

	std::string place() const { return fmt::format("meshes[{}].primitives[{}]", mesh, primitive); }
};

}  // namespace

static void warnAboutAnimation(GltfDocument& document)
{
	if (const size_t count = entryCount(document.json, "animations"); count > 0)
		document.warnings.add("animations",
							  fmt::format("{} animation{} not supported; the static pose is drawn", count, count == 1 ? " is" : "s are"));
}

// TEXCOORD sets that the material reads; set 0 too, because --displacement reads it.
static std::set<uint32_t> texcoordsOf(const Material& material)
{
	std::set<uint32_t> sets = { 0 };
	if (material.base_color_texture)
		sets.insert(material.base_color_texture->texcoord);
	if (material.displacement)
		sets.insert(material.displacement->height.texcoord);
	return sets;
}

static std::vector<PrimitiveJob> listPrimitives(const tinygltf::Model& model, const FlatNodes& nodes)
{
	std::vector<bool> drawn(model.meshes.size(), false);
	for (const Instance& instance : nodes.instances)
		drawn[instance.mesh] = true;
	std::vector<PrimitiveJob> jobs;
	for (size_t mesh = 0; mesh < model.meshes.size(); ++mesh)
		for (size_t primitive = 0; drawn[mesh] && primitive < model.meshes[mesh].primitives.size(); ++primitive)
		{
			jobs.emplace_back();
			jobs.back().mesh = mesh;
			jobs.back().primitive = primitive;
		}
	return jobs;
}

// Decodes all primitives in parallel; results and warnings are gathered in the file's order afterwards.
static Status decodePrimitives(GltfDocument& document, const tinygltf::Model& model, const std::vector<GltfAccessor>& accessors,
							   const std::vector<Material>& materials, uint32_t default_material, std::vector<PrimitiveJob>& jobs)
{
	parallelFor(jobs.size(), [&](size_t i) {
		PrimitiveJob& job = jobs[i];
		const tinygltf::Primitive& source = model.meshes[job.mesh].primitives[job.primitive];
		const uint32_t material = source.material >= 0 ? static_cast<uint32_t>(source.material) : default_material;
		try
		{
			job.result = importPrimitive({ document, accessors, source, job.place(), material, texcoordsOf(materials[material]) }, job.warnings);
		}
		catch (const std::bad_alloc&)
		{
			job.result = document.bad(job.place(), "does not fit into memory");
		}
	});
	for (PrimitiveJob& job : jobs)
	{
		if (!job.result)
			return tl::unexpected(job.result.error());
		document.warnings.append(job.warnings);
	}
	return {};
}

// Moves the decoded primitives into meshes, and the instances of meshes that have any to those meshes' new numbers.
// Returns for each mesh and primitive of the scene its place in the file.
static std::vector<std::vector<std::string>> assembleMeshes(const tinygltf::Model& model, std::vector<PrimitiveJob>& jobs, const FlatNodes& nodes,
															ImportedScene& scene)
{
	constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
	std::vector<uint32_t> number(model.meshes.size(), kNone);
	std::vector<std::vector<std::string>> places;
	for (PrimitiveJob& job : jobs)
	{
		if (!job.result->has_value())
			continue;
		if (number[job.mesh] == kNone)
		{
			number[job.mesh] = static_cast<uint32_t>(scene.meshes.size());
			scene.meshes.push_back({ model.meshes[job.mesh].name, {} });
			places.emplace_back();
		}
		scene.meshes[number[job.mesh]].primitives.push_back(std::move(**job.result));
		places[number[job.mesh]].push_back(job.place());
	}
	for (const Instance& instance : nodes.instances)
		if (number[instance.mesh] != kNone)
			scene.instances.push_back({ number[instance.mesh], instance.world });
	return places;
}

// Why the first primitive without triangles has none, for the message when nothing else is left.
static std::string firstLeftOut(const std::vector<PrimitiveJob>& jobs)
{
	const auto found = std::find_if(jobs.begin(), jobs.end(), [](const PrimitiveJob& job) { return !job.result->has_value(); });
	if (found == jobs.end())
		return "";
	const std::vector<std::string> lines = found->warnings.lines("");
	return lines.empty() ? "" : " (" + lines.front().substr(2) + ")";
}

static bool usesMaterial(const ImportedScene& scene, uint32_t material)
{
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			if (primitive.material == material)
				return true;
	return false;
}

static Result<ImportedScene> importDocument(GltfDocument& document)
{
	TRY(decodeDraco(document));
	TRY_ASSIGN(const tinygltf::Model model, parseGltfModel(document));
	TRY_ASSIGN(const std::vector<GltfAccessor> accessors, checkAccessors(document, model));
	warnAboutAnimation(document);

	ImportedScene scene;
	scene.path = document.file;
	TRY_ASSIGN(scene.materials, importMaterials(document, model));
	const uint32_t default_material = static_cast<uint32_t>(scene.materials.size());
	scene.materials.push_back({ .name = "default" });

	TRY_ASSIGN(FlatNodes nodes, flattenNodes(document, model, accessors));
	std::vector<PrimitiveJob> jobs = listPrimitives(model, nodes);
	TRY(decodePrimitives(document, model, accessors, scene.materials, default_material, jobs));
	const std::vector<std::vector<std::string>> places = assembleMeshes(model, jobs, nodes, scene);
	if (default_material > 0 && !usesMaterial(scene, default_material))
		scene.materials.pop_back();
	scene.cameras = std::move(nodes.cameras);
	if (scene.instances.empty())
		return document.bad("scene", "has nothing to draw: no node of it has a mesh with triangles{}", firstLeftOut(jobs));

	for (const LostTexture& lost : dropTexturesWithoutTexcoords(scene))
		document.warnings.add(places[lost.mesh][lost.primitive], lost.text);
	TRY(importTextures(document, model, scene));
	scene.warnings = document.warnings.lines(document.file);
	return scene;
}

Result<ImportedScene> importGltf(const std::filesystem::path& path)
{
	try
	{
		TRY_ASSIGN(std::vector<std::byte> bytes, readFile(path));
		return importGltf(path, std::move(bytes));
	}
	catch (const std::bad_alloc&)
	{
		return badInput("{}: does not fit into memory", path.string());
	}
}

Result<ImportedScene> importGltf(const std::filesystem::path& path, std::vector<std::byte> bytes)
{
	setWorkingOn(fmt::format("importing {}", path.string()));
	try
	{
		TRY_ASSIGN(GltfDocument document, readGltfDocument(path, std::move(bytes)));
		return importDocument(document);
	}
	catch (const std::bad_alloc&)
	{
		return badInput("{}: does not fit into memory", path.string());
	}
}

}  // namespace tessera
