#include "frame/cluster_templates.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

TemplateShapes templateShapes(const BuiltScene& scene, const TessellationTable& table)
{
	TemplateShapes all;
	all.scene_clusters = scene.clusters.size();
	const auto add = [&](std::array<uint32_t, 3> corners) {
		for (const uint32_t corner : corners)
			all.indices.push_back(static_cast<uint8_t>(corner));
	};
	const auto begin = [&](uint32_t triangles, uint32_t first_vertex, uint32_t vertices) {
		all.shapes.push_back({ static_cast<uint32_t>(all.indices.size()), triangles, first_vertex, vertices });
	};
	for (const ClusterRecord& cluster : scene.clusters)
	{
		begin(clusterTriangles(cluster), cluster.first_vertex, clusterVertices(cluster));
		for (uint32_t i = 0; i < clusterTriangles(cluster); ++i)
		{
			const uint32_t triangle = scene.triangles[cluster.first_triangle + i];
			add({ triangleVertex(triangle, 0), triangleVertex(triangle, 1), triangleVertex(triangle, 2) });
		}
	}
	for (const TableConfig& config : table.configs)
		for (const bool mirrored : { false, true })
		{
			begin(config.triangle_count, config.first_vertex, config.vertex_count);
			for (uint32_t i = 0; i < config.triangle_count; ++i)
			{
				const uint32_t triangle = table.triangles[config.first_triangle + i];
				const uint32_t corners[] = { triangle & 0xff, (triangle >> 8) & 0xff, (triangle >> 16) & 0xff };
				add({ corners[mirrored ? 1 : 0], corners[mirrored ? 0 : 1], corners[2] });
			}
		}
	for (const uint32_t vertex : table.vertices)
		all.pattern_positions.push_back({ float(vertex & 0xffff) / 32768, float(vertex >> 16) / 32768, 0 });
	return all;
}

uint64_t ClusterTemplates::bytes() const
{
	uint64_t bytes = records_.bytes();
	for (const Buffer& buffer : memory_)
		bytes += buffer.bytes();
	return bytes;
}

#ifdef VK_NV_cluster_acceleration_structure

namespace
{

using TemplateInfo = VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV;

// Memory for a build's inputs and scratch is bounded by building so many at a time.
constexpr size_t kBuiltAtOnce = 16384;

class TemplateBuilder
{
public:
	TemplateBuilder(Device& device, CommandRecorder& commands, const TemplateShapes& shapes, const TemplateOptions& options)
		: device_(device), commands_(commands), shapes_(shapes), options_(options)
	{}

	Status upload()
	{
		TRY_ASSIGN(indices_, uploadBuffer(device_, commands_, std::as_bytes(std::span(shapes_.indices)), "template indices"));
		TRY_ASSIGN(pattern_positions_, uploadBuffer(device_, commands_, std::as_bytes(std::span(shapes_.pattern_positions)), "template positions"));
		return {};
	}

	// Templates [first, first + count): gives the memory that holds them, and adds their records.
	Result<Buffer> build(size_t first, size_t count, std::vector<ClusterTemplate>& records)
	{
		ClusterBuild templates = bound(first, count);
		templates.operation = ClusterOperation::BuildTemplates;
		templates.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
		std::vector<TemplateInfo> infos;
		for (size_t i = first; i < first + count; ++i)
			infos.push_back(infoOf(i));
		TRY_ASSIGN(const Buffer info_buffer, uploadBuffer(device_, commands_, std::as_bytes(std::span(infos)), "template infos"));
		TRY_ASSIGN(const std::vector<uint32_t> template_bytes, sizesOf(templates, info_buffer.address()));
		TRY_ASSIGN(Buffer memory, buildAt(templates, info_buffer.address(), template_bytes));
		TRY(addRecords(bound(first, count), memory.address(), first, template_bytes, records));
		return memory;
	}

private:
	ClusterBuild bound(size_t first, size_t count) const
	{
		ClusterBuild build;
		build.count = static_cast<uint32_t>(count);
		build.truncated_bits = options_.truncated_bits;
		for (size_t i = first; i < first + count; ++i)
		{
			const TemplateShape& shape = shapes_.shapes[i];
			build.triangles_each = std::max(build.triangles_each, shape.triangle_count);
			build.vertices_each = std::max(build.vertices_each, shape.vertex_count);
			build.triangles += shape.triangle_count;
			build.vertices += shape.vertex_count;
		}
		return build;
	}

	TemplateInfo infoOf(size_t index) const
	{
		const TemplateShape& shape = shapes_.shapes[index];
		const uint64_t vertices = index < shapes_.scene_clusters ? options_.positions : pattern_positions_.address();
		TemplateInfo info = {};
		info.triangleCount = shape.triangle_count & 0x1ff;
		info.vertexCount = shape.vertex_count & 0x1ff;
		info.positionTruncateBitCount = options_.truncated_bits & 0x3f;
		info.indexType = VK_CLUSTER_ACCELERATION_STRUCTURE_INDEX_FORMAT_8BIT_NV;
		info.baseGeometryIndexAndGeometryFlags.geometryFlags = options_.opaque ? VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV & 7 : 0;
		info.indexBufferStride = 1;
		info.vertexBufferStride = sizeof(vec3);
		info.indexBuffer = indices_.address() + shape.first_index;
		info.vertexBuffer = vertices + sizeof(vec3) * uint64_t(shape.first_vertex);
		return info;
	}

	Result<Buffer> scratchFor(const ClusterBuild& build)
	{
		const uint64_t bytes = clusterBuildSizes(device_, build).scratch_bytes + device_.limits.clusters.scratch_alignment;
		return Buffer::create(device_, bytes, MemoryKind::Device, "template scratch");
	}

	uint64_t scratchAddress(const Buffer& scratch) const { return alignedUp(scratch.address(), device_.limits.clusters.scratch_alignment); }

	// Bytes that the device computes for each.
	Result<std::vector<uint32_t>> sizesOf(ClusterBuild build, uint64_t infos)
	{
		build.destination = ClusterDestination::SizesOnly;
		const uint64_t bytes = build.count * sizeof(uint32_t);
		TRY_ASSIGN(const Buffer scratch, scratchFor(build));
		TRY_ASSIGN(const Buffer sizes,
				   Buffer::create(device_, bytes, MemoryKind::Device, "template sizes", VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
		TRY_ASSIGN(const Buffer readback, Buffer::create(device_, bytes, MemoryKind::Readback, "template sizes readback"));
		TRY(commands_.begin());
		ClusterBuildAddresses addresses;
		addresses.infos = infos;
		addresses.sizes = sizes.address();
		addresses.scratch = scratchAddress(scratch);
		recordClusterBuild(device_, commands_.buffer(), build, addresses);
		fullBarrier(commands_.buffer());
		const VkBufferCopy copy = { 0, 0, bytes };
		vkCmdCopyBuffer(commands_.buffer(), sizes.handle(), readback.handle(), 1, &copy);
		fullBarrier(commands_.buffer());
		TRY(commands_.submitAndWait());
		readback.invalidateMapped();
		std::vector<uint32_t> result(build.count);
		std::memcpy(result.data(), readback.mapped(), bytes);
		return result;
	}

	// Where each begins when they lie side by side; the last entry: their end.
	std::vector<uint64_t> offsetsOf(std::span<const uint32_t> bytes) const
	{
		std::vector<uint64_t> offsets = { 0 };
		for (const uint32_t one : bytes)
			offsets.push_back(alignedUp(offsets.back() + one, device_.limits.clusters.template_alignment));
		return offsets;
	}

	Result<Buffer> buildAt(ClusterBuild build, uint64_t infos, std::span<const uint32_t> bytes)
	{
		std::vector<uint64_t> places = offsetsOf(bytes);
		TRY_ASSIGN(Buffer memory, Buffer::create(device_, places.back(), MemoryKind::Device, "ray_templates",
												 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
		places.pop_back();
		for (uint64_t& place : places)
			place += memory.address();
		TRY_ASSIGN(const Buffer destinations, uploadBuffer(device_, commands_, std::as_bytes(std::span(places)), "template places",
														   VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
		build.destination = ClusterDestination::Explicit;
		TRY_ASSIGN(const Buffer scratch, scratchFor(build));
		TRY(commands_.begin());
		ClusterBuildAddresses addresses;
		addresses.infos = infos;
		addresses.destinations = destinations.address();
		addresses.scratch = scratchAddress(scratch);
		recordClusterBuild(device_, commands_.buffer(), build, addresses);
		fullBarrier(commands_.buffer());
		TRY(commands_.submitAndWait());
		return memory;
	}

	// What a cluster made from each takes, whatever its vertices: none are given.
	Status addRecords(ClusterBuild build, uint64_t memory, size_t first, std::span<const uint32_t> template_bytes,
					  std::vector<ClusterTemplate>& records)
	{
		const std::vector<uint64_t> places = offsetsOf(template_bytes);
		std::vector<VkClusterAccelerationStructureInstantiateClusterInfoNV> infos(build.count);
		for (size_t i = 0; i < infos.size(); ++i)
			infos[i].clusterTemplateAddress = memory + places[i];
		TRY_ASSIGN(const Buffer info_buffer, uploadBuffer(device_, commands_, std::as_bytes(std::span(infos)), "template instantiations"));
		build.operation = ClusterOperation::Instantiate;
		TRY_ASSIGN(const std::vector<uint32_t> bytes, sizesOf(build, info_buffer.address()));
		const uint32_t unit_bytes = device_.limits.clusters.cluster_alignment;
		for (size_t i = 0; i < bytes.size(); ++i)
		{
			const TemplateShape& shape = shapes_.shapes[first + i];
			records.push_back({ memory + places[i], (bytes[i] + unit_bytes - 1) / unit_bytes, shape.triangle_count | shape.vertex_count << 16 });
		}
		return {};
	}

	Device& device_;
	CommandRecorder& commands_;
	const TemplateShapes& shapes_;
	const TemplateOptions& options_;
	Buffer indices_, pattern_positions_;
};

}  // namespace

Result<ClusterTemplates> ClusterTemplates::create(Device& device, CommandRecorder& commands, const TemplateShapes& shapes,
												  const TemplateOptions& options)
{
	ClusterTemplates templates;
	TemplateBuilder builder(device, commands, shapes, options);
	TRY(builder.upload());
	std::vector<ClusterTemplate> records;
	for (size_t first = 0; first < shapes.shapes.size(); first += kBuiltAtOnce)
	{
		TRY_ASSIGN(Buffer memory, builder.build(first, std::min(kBuiltAtOnce, shapes.shapes.size() - first), records));
		templates.memory_.push_back(std::move(memory));
	}
	for (const TemplateShape& shape : shapes.shapes)
	{
		templates.most_triangles_ = std::max(templates.most_triangles_, shape.triangle_count);
		templates.most_vertices_ = std::max(templates.most_vertices_, shape.vertex_count);
	}
	templates.count_ = static_cast<uint32_t>(records.size());
	TRY_ASSIGN(templates.records_, uploadBuffer(device, commands, std::as_bytes(std::span(records)), "cluster_templates"));
	return templates;
}

#else

Result<ClusterTemplates> ClusterTemplates::create(Device& device, CommandRecorder&, const TemplateShapes&, const TemplateOptions&)
{
	return fail(ExitCode::DeviceCannot, "{}: {}", device.name, device.gates.why_no_clusters);
}

#endif

}  // namespace tessera
