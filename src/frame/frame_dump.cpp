#include "frame/frame_dump.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

namespace
{

// All of a list or buffer; empty when the plan leaves it out.
template <typename T>
Result<std::vector<T>> readAll(Renderer& renderer, std::string_view name)
{
	if (!renderer.plan().keeps(name))
		return std::vector<T>();
	TRY_ASSIGN(const std::vector<std::byte> bytes, renderer.readResource(name));
	std::vector<T> items(bytes.size() / sizeof(T));
	if (!items.empty())
		std::memcpy(static_cast<void*>(items.data()), bytes.data(), items.size() * sizeof(T));
	return items;
}

// `count` records of a buffer from byte `first` on, fewer where it ends before.
template <typename T>
std::vector<T> recordsAt(std::span<const std::byte> bytes, uint64_t first, uint64_t count)
{
	std::vector<T> records(std::min<uint64_t>(count, first < bytes.size() ? (bytes.size() - first) / sizeof(T) : 0));
	if (!records.empty())
		std::memcpy(static_cast<void*>(records.data()), bytes.data() + first, records.size() * sizeof(T));
	return records;
}

// An item may name only what exists: later code indexes by it.
bool isSound(const FrameDump& dump, size_t index)
{
	const DumpItem& item = dump.items[index];
	if (item.vertex_count > DUMP_ITEM_VERTICES || item.triangle_count > DUMP_ITEM_TRIANGLES ||
		uint64_t(item.first_vertex) + item.vertex_count > dump.vertices.size() ||
		uint64_t(item.first_triangle) + item.triangle_count > dump.triangles.size())
		return false;
	const size_t owners = dump.isBatch(index) ? dump.parts.size() : dump.visible.size();
	for (const DumpVertex& vertex : dump.verticesOf(index))
		if (vertex.owner >= owners)
			return false;
	for (const DumpTriangle& triangle : dump.trianglesOf(index))
		for (uint32_t corner = 0; corner < 3; ++corner)
			if (cornerOf(triangle, corner) >= item.vertex_count)
				return false;
	return true;
}

// A part is drawn when it has a place in a batch.
Status readDrawnParts(Renderer& renderer, FrameDump& dump)
{
	TRY_ASSIGN(const std::vector<Batch> batches, readAll<Batch>(renderer, "batches"));
	TRY_ASSIGN(const std::vector<PartPlace> places, readAll<PartPlace>(renderer, "part_places"));
	dump.part_is_drawn.resize(dump.parts.size());
	for (const Batch& batch : batches)
		for (uint32_t i = batchFirst(batch.parts); i < batchFirst(batch.parts) + batchCount(batch.parts); ++i)
		{
			if (i >= places.size() || places[i].part >= dump.parts.size())
				return fail(ExitCode::CheckFailed, "a batch of the frame names a part that does not exist");
			dump.part_is_drawn[places[i].part] = true;
		}
	return {};
}

}  // namespace

Result<FrameDump> readLists(Renderer& renderer)
{
	FrameDump dump;
	TRY_ASSIGN(dump.visible, readAll<ClusterRef>(renderer, "visible_clusters"));
	TRY_ASSIGN(const std::vector<DomainTriangle> records, readAll<DomainTriangle>(renderer, "part_triangles"));
	TRY_ASSIGN(const std::vector<FullCluster> full, readAll<FullCluster>(renderer, "full_clusters"));
	dump.parts.reserve(records.size());
	for (const DomainTriangle& record : records)
		dump.parts.push_back(unpackTriangle(record));
	for (const FullCluster& cluster : full)
	{
		dump.full_clusters.push_back(cluster.visible_cluster);
		dump.cluster_is_drawn.push_back(cluster.phase != PHASE_HIDDEN);
	}
	TRY(readDrawnParts(renderer, dump));
	const auto exists = [&](uint32_t visible) {
		return visible < dump.visible.size();
	};
	if (!std::all_of(dump.full_clusters.begin(), dump.full_clusters.end(), exists) ||
		!std::all_of(dump.parts.begin(), dump.parts.end(), [&](const DomainPiece& part) { return exists(part.visible_cluster); }))
		return fail(ExitCode::CheckFailed, "a full cluster or part triangle of the frame names a visible cluster that does not exist");
	return dump;
}

Result<FrameDump> readDump(Renderer& renderer)
{
	TRY_ASSIGN(FrameDump dump, readLists(renderer));
	TRY_ASSIGN(const std::vector<Batch> batches, readAll<Batch>(renderer, "batches"));
	TRY_ASSIGN(const std::vector<std::byte> bytes, renderer.readResource("micro_dump"));
	const DumpLayout& layout = renderer.dumpLayout();
	const size_t wanted = dump.full_clusters.size() + batches.size();
	dump.items = recordsAt<DumpItem>(bytes, layout.firstItem(), std::min<uint64_t>(wanted, layout.items));
	dump.vertices = recordsAt<DumpVertex>(bytes, layout.firstVertex(), layout.vertices);
	dump.triangles = recordsAt<DumpTriangle>(bytes, layout.firstTriangle(), layout.triangles);
	if (dump.items.size() < wanted)
		return badInput("the frame has {} full clusters and batches, and {} were read back", wanted, dump.items.size());
	for (size_t i = 0; i < wanted; ++i)
		if (!isSound(dump, i))
			return fail(ExitCode::CheckFailed, "item {} of the frame's {} full clusters and batches names what does not exist", i, wanted);
	return dump;
}

Result<std::vector<uint64_t>> readVisibility(Renderer& renderer)
{
	TRY_ASSIGN(std::vector<uint64_t> words, readAll<uint64_t>(renderer, "kept_visibility"));
	// Buffers end at a multiple of 16 bytes: with an odd number of pixels there is one word more.
	const RenderOptions& options = renderer.planInput().options;
	words.resize(std::min(words.size(), size_t(options.width_px) * options.height_px));
	return words;
}

}  // namespace tessera
