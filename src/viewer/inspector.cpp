#include "viewer/inspector.h"

#include "frame/frame_dump.h"
#include "plan/conditions.h"
#include "reference/classify.h"
#include "reference/evaluate.h"
#include "scene/factor_rule.h"
#include "shared/visibility.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tessera::view
{

namespace
{

using reference::HostScene;
using reference::ReferencePiece;

dvec3 toWorld(const Instance& instance, const vec3& p)
{
	return dvec3(instance.world * dvec4(dvec3(p), 1));
}

// Twice the area in domain units; positive in the base triangle's winding.
int64_t doubledArea(const DomainPoint& a, const DomainPoint& b, const DomainPoint& c)
{
	return (int64_t(b.u) - a.u) * (int64_t(c.v) - a.v) - (int64_t(c.u) - a.u) * (int64_t(b.v) - a.v);
}

// Whether the middle of the part lies in the piece; either may be mirrored.
bool holds(const DomainPiece& piece, const std::array<DomainPoint, 3>& part)
{
	const DomainPoint middle = { (part[0].u + part[1].u + part[2].u) / 3, (part[0].v + part[1].v + part[2].v) / 3 };
	const int64_t a = doubledArea(piece.c0, piece.c1, middle), b = doubledArea(piece.c1, piece.c2, middle),
				  c = doubledArea(piece.c2, piece.c0, middle);
	return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// The split triangles that led to the part: those of its base triangle that hold it, largest first. The reference cuts the cluster again; the device
// makes the same bits.
std::vector<SplitStep> splitPath(const HostScene& scene, const View& view, const Renderer& renderer, const Inspection& found)
{
	const uint32_t max_split = std::min(renderer.planInput().options.max_split, scene.tableSize());
	const ClusterRef clusters[] = { found.cluster };
	const reference::Classified classified = reference::classify(scene, view, factorRule(view, scene.tableSize(), max_split), clusters);
	std::vector<DomainPiece> path;
	for (const ReferencePiece& split : classified.splits)
		if (split.piece.triangle == found.triangle && holds(split.piece, found.part))
			path.push_back(split.piece);
	const auto size = [](const DomainPiece& piece) {
		return std::abs(doubledArea(piece.c0, piece.c1, piece.c2));
	};
	std::stable_sort(path.begin(), path.end(), [&](const DomainPiece& a, const DomainPiece& b) { return size(a) > size(b); });
	std::vector<SplitStep> steps;
	for (const DomainPiece& piece : path)
		steps.push_back({ { piece.c0, piece.c1, piece.c2 }, { piece.a, piece.b, piece.c } });
	return steps;
}

template <typename T>
Result<std::vector<T>> readItems(Renderer& renderer, std::string_view name)
{
	TRY_ASSIGN(const std::vector<std::byte> bytes, renderer.readResource(name));
	std::vector<T> items(bytes.size() / sizeof(T));
	if (!items.empty())
		std::memcpy(static_cast<void*>(items.data()), bytes.data(), items.size() * sizeof(T));
	return items;
}

Status findBatch(Renderer& renderer, uint32_t part, Inspection& found)
{
	TRY_ASSIGN(const std::vector<Batch> batches, readItems<Batch>(renderer, "batches"));
	TRY_ASSIGN(const std::vector<PartPlace> places, readItems<PartPlace>(renderer, "part_places"));
	const bool soft = kBuffered.holds(renderer.planInput());
	found.most_batch_vertices = soft ? RASTER_BATCH_VERTICES : BATCH_MAX_VERTICES;
	found.most_batch_triangles = soft ? RASTER_BATCH_TRIANGLES : BATCH_MAX_TRIANGLES;
	for (size_t b = 0; b < batches.size(); ++b)
	{
		const uint32_t first = batchFirst(batches[b].parts), count = batchCount(batches[b].parts);
		for (uint32_t i = first; i < first + count && i < places.size(); ++i)
			if (places[i].part == part)
			{
				found.batch = static_cast<uint32_t>(b);
				found.batch_parts = count;
				found.batch_vertices = batchVertices(batches[b]);
				found.batch_triangles = batchTriangles(batches[b]);
				return {};
			}
	}
	return {};
}

// Corners of the micro-triangle: where they are on the base triangle and in the world.
void evaluateVertices(const HostScene& scene, const View& view, const std::array<DomainPoint, 3>& corners, Inspection& found)
{
	const Instance& instance = scene.built().instances[found.cluster.instance];
	for (size_t i = 0; i < 3; ++i)
	{
		const reference::MicroVertex vertex = reference::evaluatePoint(scene, view, found.cluster, found.triangle, corners[i]);
		found.vertices[i].domain = corners[i];
		found.vertices[i].position_world = toWorld(instance, vertex.displaced);
		found.vertices[i].displacement = glm::length(vertex.displaced - vertex.base);
	}
	const dvec3 facet = glm::cross(found.vertices[1].position_world - found.vertices[0].position_world,
								   found.vertices[2].position_world - found.vertices[0].position_world);
	for (InspectedVertex& vertex : found.vertices)
		vertex.normal_world = glm::length(facet) > 0 ? vec3(glm::normalize(facet)) : vec3(0);
}

void fillPattern(const HostScene& scene, Inspection& found)
{
	const auto [a, b, c] = found.factors;
	const PatternRange& range = scene.pattern(a, b, c);
	found.config = patternIndex(a, b, c);
	// In the pattern's own corners: a piece of the whole domain, turned as the table has it.
	DomainPiece whole = {};
	whole.c0 = domainCorner(0);
	whole.c1 = domainCorner(1);
	whole.c2 = domainCorner(2);
	whole.a = a;
	whole.b = b;
	whole.c = c;
	for (uint32_t v = 0; v < patternVertices(range); ++v)
	{
		const DomainPoint point = patternPoint(whole, v, range, scene.table(), 0);
		found.pattern_points.emplace_back(float(point.u) / float(DOMAIN_SIZE), float(point.v) / float(DOMAIN_SIZE));
	}
	for (uint32_t t = 0; t < patternTriangles(range); ++t)
		found.pattern_triangles.push_back(patternTriangle(t, range, scene.table(), 0));
}

Status fillPart(Renderer& renderer, const HostScene& scene, const View& view, const FrameDump& lists, uint32_t payload, Inspection& found)
{
	const uint32_t index = payloadIndex(payload);
	if (index >= lists.parts.size())
		return fail(ExitCode::CheckFailed, "pixel {}, {} names part {} of {}", found.pixel.x, found.pixel.y, index, lists.parts.size());
	const DomainPiece& piece = lists.parts[index];
	found.is_part = true;
	found.cluster = lists.visible[piece.visible_cluster];
	found.triangle = piece.triangle;
	found.micro = payloadTriangle(payload);
	found.factors = { piece.a, piece.b, piece.c };
	found.mirrored = piece.mirror != 0;
	found.part = { piece.c0, piece.c1, piece.c2 };
	reference::DomainMesh mesh;
	reference::evaluateDomain(scene, { found.cluster, piece }, mesh);
	if (found.micro >= mesh.triangles.size())
		return fail(ExitCode::CheckFailed, "pixel {}, {} names micro-triangle {} of {}", found.pixel.x, found.pixel.y, found.micro,
					mesh.triangles.size());
	const uvec3 corners = mesh.triangles[found.micro];
	evaluateVertices(scene, view, { mesh.points[corners.x], mesh.points[corners.y], mesh.points[corners.z] }, found);
	found.splits = splitPath(scene, view, renderer, found);
	fillPattern(scene, found);
	return findBatch(renderer, index, found);
}

}  // namespace

Result<Inspection> inspectPixel(Renderer& renderer, const HostScene& scene, const FrameResult& result, uvec2 pixel)
{
	Inspection found;
	found.pixel = pixel;
	const RenderOptions& options = renderer.planInput().options;
	if (pixel.x >= options.width_px || pixel.y >= options.height_px)
		return badInput("pixel {}, {} is outside the picture", pixel.x, pixel.y);
	if (result.rounds > 1)
	{
		found.why_not = "the frame is drawn in rounds: its lists hold the last of them only";
		return found;
	}
	TRY_ASSIGN(const std::vector<uint64_t> words, readVisibility(renderer));
	const uint64_t word = words.at(size_t(pixel.y) * options.width_px + pixel.x);
	if (word == 0)
	{
		found.why_not = "background";
		return found;
	}
	TRY_ASSIGN(const FrameDump lists, readLists(renderer));
	const View view = renderer.view();
	const View& drawn = renderer.drawnView();
	const double depth = double(std::bit_cast<float>(static_cast<uint32_t>(word >> 32)));
	found.depth_world = (double(drawn.depth_offset) - depth * double(drawn.w_offset)) / (depth * double(drawn.w_slope) - double(drawn.depth_slope)) /
						double(drawn.unit);
	found.covered = true;
	const auto payload = static_cast<uint32_t>(word);
	if (payloadKind(payload) == KIND_PART_TRIANGLE)
		TRY(fillPart(renderer, scene, view, lists, payload, found));
	else if (payloadIndex(payload) < lists.visible.size())
	{
		found.cluster = lists.visible[payloadIndex(payload)];
		found.triangle = payloadTriangle(payload);
		found.part = { domainCorner(0), domainCorner(1), domainCorner(2) };
		evaluateVertices(scene, view, found.part, found);
		fillPattern(scene, found);
	}
	else
		return fail(ExitCode::CheckFailed, "pixel {}, {} names a visible cluster that does not exist", pixel.x, pixel.y);
	const BuiltScene& built = scene.built();
	const ClusterRecord& cluster = scene.cluster(found.cluster);
	found.mesh = built.instances[found.cluster.instance].mesh;
	found.material = cluster.material;
	found.material_name = built.materials[cluster.material].name;
	found.source_triangle = built.source_triangles[cluster.first_triangle + found.triangle];
	return found;
}

}  // namespace tessera::view
