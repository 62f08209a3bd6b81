#include "frame/shared_structures.h"

#include "plan/conditions.h"

#include <algorithm>

namespace tessera
{

namespace
{

// Builds that run side by side share so much scratch memory, unless one alone needs more.
constexpr uint64_t kMostScratchBytes = 64u << 20;

bool movesNothing(const PlanInput& input)
{
	return !kDisplaced.holds(input) || input.options.rate <= 0;
}

// Behind builds: their structures are read, and their scratch memory is written again.
void buildBarrier(VkCommandBuffer commands)
{
	VkMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
	barrier.srcAccessMask = VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
	barrier.dstStageMask = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
	barrier.dstAccessMask = VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.memoryBarrierCount = 1;
	info.pMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands, &info);
}

const ClusterRecord& lastCluster(const BuiltScene& scene, const MeshRecord& mesh)
{
	return scene.clusters[mesh.first_cluster + mesh.cluster_count - 1];
}

// A mesh's clusters lie one after another, and so do their vertices and triangles.
uint32_t verticesOf(const BuiltScene& scene, const MeshRecord& mesh)
{
	const ClusterRecord& last = lastCluster(scene, mesh);
	return last.first_vertex + clusterVertices(last) - scene.clusters[mesh.first_cluster].first_vertex;
}

// Meshes whose vertices depend on nothing but options; empty where nothing may share, whatever the view.
std::vector<uint8_t> meshesThatMayShare(const BuiltScene& scene, const PlanInput& input)
{
	// Bounds know the edges of the metric `edge` alone.
	if (!mayShareStructures(input) || (kTessellates.holds(input) && input.options.metric != Metric::Edge))
		return {};
	std::vector<uint8_t> candidates = movesNothing(input) ? std::vector<uint8_t>(scene.meshes.size(), 1) : undisplacedMeshes(scene);
	for (size_t mesh = 0; mesh < candidates.size(); ++mesh)
		if (scene.meshes[mesh].cluster_count == 0 || trianglesOf(scene, scene.meshes[mesh]) > input.device.most_structure_triangles)
			candidates[mesh] = 0;
	const bool any = std::ranges::any_of(candidates, [](uint8_t candidate) { return candidate != 0; });
	return any ? candidates : std::vector<uint8_t>();
}

}  // namespace

std::vector<uint8_t> meshesThatShare(const BuiltScene& scene, const View& view, const PlanInput& input)
{
	std::vector<uint8_t> candidates = meshesThatMayShare(scene, input);
	return candidates.empty() ? candidates : sharingMeshes(scene, view, raySharing(view, kTessellates.holds(input)), std::move(candidates));
}

SharedStructures::~SharedStructures()
{
	if (sizes_)
		vkDestroyQueryPool(device_.handle, sizes_, nullptr);
}

bool SharedStructures::isCurrent(uint32_t mesh, const PlanInput& input) const
{
	if (mesh >= structures_.size() || !structures_[mesh].is_built)
		return false;
	const MeshStructure& made = structures_[mesh];
	const bool is_displaced = kDisplaced.holds(input) && !undisplaced_[mesh];
	if (made.is_displaced != is_displaced)
		return false;
	return !is_displaced || (input.options.rate <= 0 && made.displacement_scale == input.options.displacement_scale &&
							 made.displacement_offset == input.options.displacement_offset);
}

void SharedStructures::look(const View& view, PlanInput& input)
{
	if (undisplaced_.empty())
		undisplaced_ = undisplacedMeshes(scene_);
	const std::vector<uint8_t> sharing = meshesThatShare(scene_, view, input);
	missing_.clear();
	for (uint32_t mesh = 0; mesh < sharing.size(); ++mesh)
		if (sharing[mesh] && !isCurrent(mesh, input))
			missing_.push_back(mesh);
	input.view.shares_structures = std::ranges::any_of(sharing, [](uint8_t shares) { return shares != 0; });
	input.view.makes_structures = !missing_.empty();
	input.view.own_triangles = 0;
	if (!missing_.empty())
		input.view.own_triangles = trianglesNotShared(scene_, view, raySharing(view, kTessellates.holds(input)), meshesThatMayShare(scene_, input));
}

Status SharedStructures::prepare(const FramePlan& plan, const PlanInput& input, CommandRecorder& commands)
{
	if (!mayShareStructures(input))
		drop();
	if (!plan.keeps("mesh_addresses"))
		return {};
	structures_.resize(scene_.meshes.size());
	for (uint32_t mesh = 0; mesh < structures_.size(); ++mesh)
		if (!isCurrent(mesh, input))
			structures_[mesh] = {};
	TRY(compact(commands));
	builds_.clear();
	expanded_.clear();
	if (plan.has("build_meshes"))
	{
		TRY(makeInputs());
		TRY(makeStructures(input));
	}
	return uploadAddresses(commands);
}

Status SharedStructures::makeInputs()
{
	uint64_t vertices = 0, triangles = 0;
	for (const uint32_t index : missing_)
	{
		const MeshRecord& mesh = scene_.meshes[index];
		const ClusterRecord& first = scene_.clusters[mesh.first_cluster];
		expanded_.push_back({ index, mesh.first_cluster, mesh.cluster_count, static_cast<uint32_t>(vertices) - first.first_vertex,
							  static_cast<uint32_t>(triangles) - first.first_triangle });
		vertices += verticesOf(scene_, mesh);
		triangles += trianglesOf(scene_, mesh);
	}
	TRY_ASSIGN(vertices_, Buffer::create(device_, vertices * sizeof(vec3), MemoryKind::Device, "mesh_inputs"));
	TRY_ASSIGN(indices_, Buffer::create(device_, triangles * 3 * sizeof(uint32_t), MemoryKind::Device, "mesh_inputs"));
	return {};
}

// Any-hit shaders decide by the material where some material of the scene shows both sides and another one does not.
bool SharedStructures::isOpaque(uint32_t mesh) const
{
	if (!(scene_.traits.has_single_sided && scene_.traits.has_double_sided))
		return true;
	const MeshRecord& record = scene_.meshes[mesh];
	const auto clusters = std::span(scene_.clusters).subspan(record.first_cluster, record.cluster_count);
	return std::ranges::all_of(clusters, [&](const ClusterRecord& cluster) { return scene_.materials[cluster.material].double_sided; });
}

Status SharedStructures::makeStructures(const PlanInput& input)
{
	uint64_t offset = 0, most_bytes = 0;
	for (const ExpandedMesh& expanded : expanded_)
	{
		const MeshRecord& mesh = scene_.meshes[expanded.mesh];
		TriangleInput triangles;
		triangles.vertices = vertices_.address() + sizeof(vec3) * uint64_t(expanded.vertex_place + scene_.clusters[mesh.first_cluster].first_vertex);
		triangles.vertex_stride_bytes = sizeof(vec3);
		triangles.most_vertex = verticesOf(scene_, mesh) - 1;
		triangles.indices =
			indices_.address() + 3 * sizeof(uint32_t) * uint64_t(expanded.triangle_place + scene_.clusters[mesh.first_cluster].first_triangle);
		triangles.triangle_count = trianglesOf(scene_, mesh);
		triangles.opaque = isOpaque(expanded.mesh);
		BuildFlags flags;
		flags.fast_trace = flags.can_compact = true;
		Build build = { StructureBuild(triangles, flags), expanded.mesh, 0, false };
		const StructureBuild::Sizes sizes = build.build.sizes(device_);
		MeshStructure& made = structures_[expanded.mesh];
		made = {};
		made.is_displaced = kDisplaced.holds(input) && !undisplaced_[expanded.mesh];
		made.displacement_scale = input.options.displacement_scale;
		made.displacement_offset = input.options.displacement_offset;
		TRY_ASSIGN(made.structure, AccelerationStructure::create(device_, build.build.type(), sizes.structure_bytes, "mesh_structures"));
		if (offset > 0 && offset + sizes.build_scratch_bytes > kMostScratchBytes)
		{
			offset = 0;
			build.begins_batch = true;
		}
		build.scratch_offset = offset;
		const uint64_t alignment = device_.limits.scratch_alignment;
		offset += (sizes.build_scratch_bytes + alignment - 1) / alignment * alignment;
		most_bytes = std::max(most_bytes, offset);
		builds_.push_back(build);
	}
	TRY_ASSIGN(scratch_, Buffer::create(device_, scratchBytes(device_, most_bytes), MemoryKind::Device, "ray_scratch"));
	if (sizes_)
		vkDestroyQueryPool(device_.handle, sizes_, nullptr);
	sizes_ = VK_NULL_HANDLE;
	VkQueryPoolCreateInfo info = { VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO };
	info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
	info.queryCount = static_cast<uint32_t>(builds_.size());
	VK_TRY(vkCreateQueryPool(device_.handle, &info, nullptr, &sizes_), "creating the queries of compacted sizes");
	return {};
}

void SharedStructures::recordBuilds(VkCommandBuffer commands) const
{
	vkCmdResetQueryPool(commands, sizes_, 0, static_cast<uint32_t>(builds_.size()));
	std::vector<VkAccelerationStructureKHR> made;
	for (const Build& build : builds_)
	{
		if (build.begins_batch)
			buildBarrier(commands);
		const AccelerationStructure& structure = structures_[build.mesh].structure;
		build.build.record(device_, commands, structure.handle(), scratchAddress(device_, scratch_) + build.scratch_offset, BuildMode::Build);
		made.push_back(structure.handle());
	}
	buildBarrier(commands);
	device_.functions.write_structure_properties(commands, static_cast<uint32_t>(made.size()), made.data(),
												 VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, sizes_, 0);
}

Status SharedStructures::endFrame()
{
	if (builds_.empty())
		return {};
	std::vector<uint64_t> bytes(builds_.size());
	VK_TRY(vkGetQueryPoolResults(device_.handle, sizes_, 0, static_cast<uint32_t>(bytes.size()), bytes.size() * sizeof(uint64_t), bytes.data(),
								 sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
		   "reading compacted sizes");
	for (size_t i = 0; i < builds_.size(); ++i)
	{
		MeshStructure& made = structures_[builds_[i].mesh];
		made.is_built = true;
		made.compact_bytes = bytes[i];
	}
	builds_.clear();
	expanded_.clear();
	vertices_ = {};
	indices_ = {};
	scratch_ = {};
	return {};
}

// Copies are as good as what they are copied from, and smaller. Those that an option makes stale in every frame never come here.
Status SharedStructures::compact(CommandRecorder& commands)
{
	std::vector<std::pair<uint32_t, AccelerationStructure>> copies;
	for (uint32_t mesh = 0; mesh < structures_.size(); ++mesh)
	{
		MeshStructure& made = structures_[mesh];
		if (!made.is_built || made.is_compact)
			continue;
		made.is_compact = true;
		if (made.compact_bytes == 0 || made.compact_bytes >= made.structure.bytes())
			continue;
		TRY_ASSIGN(AccelerationStructure copy,
				   AccelerationStructure::create(device_, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, made.compact_bytes, "mesh_structures"));
		copies.emplace_back(mesh, std::move(copy));
	}
	if (copies.empty())
		return {};
	TRY(commands.begin());
	for (const auto& [mesh, copy] : copies)
		recordCompaction(device_, commands.buffer(), structures_[mesh].structure.handle(), copy.handle());
	fullBarrier(commands.buffer());
	TRY(commands.submitAndWait());
	for (auto& [mesh, copy] : copies)
		structures_[mesh].structure = std::move(copy);
	return {};
}

Status SharedStructures::uploadAddresses(CommandRecorder& commands)
{
	std::vector<uint64_t> addresses;
	for (const MeshStructure& made : structures_)
		addresses.push_back(made.structure.address());
	if (addresses_ && addresses == uploaded_)
		return {};
	TRY_ASSIGN(addresses_, uploadBuffer(device_, commands, std::as_bytes(std::span(addresses)), "mesh_addresses"));
	uploaded_ = std::move(addresses);
	return {};
}

void SharedStructures::drop()
{
	structures_.clear();
	uploaded_.clear();
	missing_.clear();
	builds_.clear();
	expanded_.clear();
	addresses_ = {};
	vertices_ = {};
	indices_ = {};
	scratch_ = {};
}

uint64_t SharedStructures::bytes() const
{
	uint64_t bytes = addresses_.bytes() + vertices_.bytes() + indices_.bytes() + scratch_.bytes();
	for (const MeshStructure& made : structures_)
		bytes += made.structure.bytes();
	return bytes;
}

void SharedStructures::addStats(RayStats& stats, uint32_t instances) const
{
	stats.shared_structures =
		static_cast<uint64_t>(std::ranges::count_if(structures_, [](const MeshStructure& made) { return bool(made.structure); }));
	stats.shared_instances = instances;
	stats.shared_bytes = bytes();
}

}  // namespace tessera
