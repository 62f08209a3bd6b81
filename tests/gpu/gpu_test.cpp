#include "gpu_test.h"

#include "base/check.h"
#include "pipeline/passes.h"
#include "reference/cover.h"
#include "scene/builtin.h"
#include "scene/factor_rule.h"
#include "scene/gltf_import.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numbers>

namespace tessera::test
{

namespace
{

struct DeviceOrReason
{
	std::unique_ptr<Device> device;
	std::string reason;
};

// Made at the first use: listing the tests needs no device.
DeviceOrReason& processDevice()
{
	static DeviceOrReason made = [] {
		auto device = Device::create({ .name = "", .validate = true });
		return device ? DeviceOrReason{ std::move(*device), "" } : DeviceOrReason{ nullptr, device.error().message };
	}();
	return made;
}

BuiltScene builtOrDie(const ImportedScene& imported, const BuildOptions& options)
{
	Result<BuiltScene> built = buildScene(imported, options);
	CHECK(built.has_value(), "{}", built.error().message);
	return std::move(*built);
}

// What the device's records stand for, in the list's order.
std::vector<reference::ReferencePiece> piecesOf(std::span<const DomainTriangle> records, std::span<const ClusterRef> visible)
{
	std::vector<reference::ReferencePiece> pieces;
	pieces.reserve(records.size());
	for (const DomainTriangle& record : records)
	{
		const DomainPiece piece = unpackTriangle(record);
		const bool known = piece.visible_cluster < visible.size();
		pieces.push_back({ known ? visible[piece.visible_cluster] : ClusterRef{ NO_INDEX, NO_INDEX }, piece });
	}
	return pieces;
}

void readLists(GpuFrame& frame)
{
	frame.visible = frame.read<ClusterRef>("visible_clusters");
	frame.part_records = frame.read<DomainTriangle>("part_triangles");
	frame.parts = piecesOf(frame.part_records, frame.visible);
	frame.splits = piecesOf(frame.read<DomainTriangle>("split_triangles"), frame.visible);
}

}  // namespace

// --- device ----------------------------------------------------------------------------------------------------------------------

void GpuTest::SetUp()
{
	if (!processDevice().device)
		GTEST_SKIP() << processDevice().reason;
	messages_before_ = gpu().validationMessages();
}

void GpuTest::TearDown()
{
	if (!processDevice().device)
		return;
	EXPECT_EQ(gpu().validationMessages() - messages_before_, 0u) << "the validation layer's messages are in the log";
}

Device& gpu()
{
	return *processDevice().device;
}

// --- scenes ----------------------------------------------------------------------------------------------------------------------

// The reference goes by the metric whose table was asked for.
static Metric metricOf(MetricTables tables)
{
	return tables.details ? Metric::Detail : tables.roughness ? Metric::Displaced : Metric::Edge;
}

GpuScene::GpuScene(const ImportedScene& imported, const TessellationTable& used_table, const BuildOptions& options)
	: table(used_table), built(builtOrDie(imported, options)), host(built, table, metricOf(options.tables)),
	  camera(built.cameras.empty() ? framingCamera(built) : cameraOf(built.cameras[0], built))
{}

std::unique_ptr<GpuScene> gpuScene(std::string_view name, const BuildOptions& options)
{
	const std::filesystem::path root = TESSERA_SOURCE_ROOT;
	const bool is_file = name.find('.') != std::string_view::npos;
	const std::filesystem::path below_data = root / "tests/data" / name, below_bench = root / "bench/scenes" / name;
	const Result<ImportedScene> imported =
		is_file ? importGltf(std::filesystem::exists(below_data) ? below_data : below_bench) : makeBuiltinScene(name);
	CHECK(imported.has_value(), "{}", imported.error().message);
	return std::make_unique<GpuScene>(*imported, defaultTable(), options);
}

TessellationTable smallTable(uint32_t max_edge_segments)
{
	TessellationTable table = defaultTable();
	table.max_edge_segments = max_edge_segments;
	table.configs.resize(configCount(max_edge_segments));
	return table;
}

ImportedScene squareScene()
{
	ImportedScene scene;
	Primitive square;
	square.material = addPlain(scene, "plain");
	for (const vec2 corner : { vec2(-0.5f, -0.5f), vec2(0.5f, -0.5f), vec2(0.5f, 0.5f), vec2(-0.5f, 0.5f) })
		addVertex(square, vec3(corner, 0), vec3(0, 0, 1), corner + vec2(0.5f));
	addTriangle(square, 0, 1, 2);
	addTriangle(square, 0, 2, 3);
	addPlacedMesh(scene, { square });
	return scene;
}

ImportedScene unevenScene()
{
	ImportedScene scene = cubeScene(2);
	const auto place = [&](const dmat4& world) {
		scene.instances.push_back({ 0, world });
	};
	place(glm::scale(glm::translate(dmat4(1), dvec3(3, 0, 0)), dvec3(-1, 1, 1)));
	place(glm::scale(glm::translate(dmat4(1), dvec3(0, 3, 0)), dvec3(0.3, 2, 1)));
	place(glm::rotate(glm::scale(glm::translate(dmat4(1), dvec3(-3, 0, 0)), dvec3(1, 0.5, -2)), 0.7, dvec3(1, 2, 3)));
	dmat4 sheared = glm::translate(dmat4(1), dvec3(0, -3, 0));
	sheared[1] += dvec4(0.8, 0, 0.2, 0);
	place(sheared);
	return scene;
}

Camera closeTo(const GpuScene& scene, double fraction)
{
	Camera camera = scene.camera;
	camera.eye = camera.target + (camera.eye - camera.target) * fraction;
	return camera;
}

Camera squareCamera(dvec3 eye, dvec3 target)
{
	Camera camera;
	camera.eye = eye;
	camera.target = target;
	camera.fov_y_rad = std::numbers::pi / 2;
	camera.near_world = 1e-3;
	return camera;
}

// --- frames ----------------------------------------------------------------------------------------------------------------------

RenderOptions smallOptions(float rate)
{
	RenderOptions options;
	options.rate = rate;
	options.width_px = 160;
	options.height_px = 90;
	options.raster = rasterPaths().front();
	return options;
}

std::vector<Raster> rasterPaths()
{
	std::vector<Raster> paths;
	if (gpu().gates.mesh_shader)
		paths.push_back(Raster::Mesh);
	if (gpu().gates.fragment_primitive_id)
		paths.push_back(Raster::Indexed);
	if (gpu().gates.buffer_atomics_64)
		paths.push_back(Raster::Soft);
	return paths;
}

std::vector<Raster> everyPath()
{
	std::vector<Raster> paths = rasterPaths();
	if (gpu().gates.rays())
		paths.push_back(Raster::Rt);
	return paths;
}

std::vector<Raster> drawingPaths()
{
	std::vector<Raster> paths = rasterPaths();
	std::erase(paths, Raster::Soft);
	return paths;
}

std::vector<std::byte> GpuFrame::readBytes(std::string_view name) const
{
	if (!renderer || !renderer->plan().keeps(name))
		return {};
	Result<std::vector<std::byte>> bytes = renderer->readResource(name);
	EXPECT_TRUE(bytes.has_value()) << name;
	return bytes ? std::move(*bytes) : std::vector<std::byte>();
}

std::vector<uint8_t> GpuFrame::picture() const
{
	Result<std::vector<uint8_t>> texels = renderer->readPicture();
	EXPECT_TRUE(texels.has_value());
	return texels ? std::move(*texels) : std::vector<uint8_t>();
}

const ListStats& GpuFrame::list(std::string_view name) const
{
	const auto found = std::find_if(result.lists.begin(), result.lists.end(), [&](const ListStats& stats) { return stats.name == name; });
	CHECK(found != result.lists.end(), "no list {}", name);
	return *found;
}

std::vector<ClusterRef> GpuFrame::fullClusters() const
{
	std::vector<uint32_t> indices;
	for (const FullCluster& full : read<FullCluster>("full_clusters"))
		indices.push_back(full.visible_cluster);
	return reference::canonicalClusters(indices, visible);
}

reference::Classified GpuFrame::expected() const
{
	const uint32_t max_split = std::min(renderer->planInput().options.max_split, scene.table.max_edge_segments);
	return reference::classify(scene.host, view(), factorRule(view(), scene.table.max_edge_segments, max_split), visible);
}

GpuFrame drawFrame(const GpuScene& scene, const RenderOptions& options, const Camera& camera)
{
	GpuFrame frame = { scene, nullptr, {}, {}, {}, {}, {} };
	auto renderer = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options);
	CHECK(renderer.has_value(), "{}", renderer.error().message);
	frame.renderer = std::move(*renderer);
	drawAgain(frame, camera);
	return frame;
}

void drawAgain(GpuFrame& frame, const Camera& camera)
{
	Result<FrameResult> result = frame.renderer->renderFrame(camera);
	CHECK(result.has_value(), "{}", result.error().message);
	frame.result = std::move(*result);
	readLists(frame);
}

// --- comparisons -----------------------------------------------------------------------------------------------------------------

namespace
{

// True when all micro-vertices lie beyond one side of the view: the piece cannot touch a pixel. By the definition of clip space.
bool isOutOfView(const GpuFrame& frame, const reference::ReferencePiece& part)
{
	std::array<bool, 5> all_beyond = { true, true, true, true, true };
	for (const auto& vertex : reference::evaluatePart(frame.scene.host, frame.view(), part).vertices)
	{
		const vec4 clip = vertex.clip;
		const std::array<bool, 5> beyond = { clip.x > clip.w, clip.x<-clip.w, clip.y> clip.w, clip.y<-clip.w, clip.z> clip.w };
		for (size_t side = 0; side < beyond.size(); ++side)
			all_beyond[side] &= beyond[side];
	}
	return std::any_of(all_beyond.begin(), all_beyond.end(), [](bool beyond) { return beyond; });
}

// What the device left out of the reference's pieces; what it has beside them fails the test.
std::vector<reference::ReferencePiece> missingPieces(std::vector<reference::ReferencePiece> expected, std::vector<reference::ReferencePiece> found,
													 const std::string& what)
{
	const auto less = [](const auto& a, const auto& b) {
		return reference::keyOf(a) < reference::keyOf(b);
	};
	reference::sortPieces(expected);
	reference::sortPieces(found);
	EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end(), less)) << what << ": a piece that the reference lacks";
	std::vector<reference::ReferencePiece> missing;
	std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(), std::back_inserter(missing), less);
	return missing;
}

// With frustum culling pieces may be missing: each of them must be out of view (C3), and the counts are those of the rest.
void expectOnlyUnseenMissing(const GpuFrame& frame, const reference::Classified& expected, const std::string& what)
{
	missingPieces(expected.splits, frame.splits, what + ": split triangles");
	size_t seen = 0;
	for (const reference::ReferencePiece& part : missingPieces(expected.parts, frame.parts, what + ": part triangles"))
		seen += !isOutOfView(frame, part);
	EXPECT_EQ(seen, 0u) << what << ": culled parts that reach into the view";
	EXPECT_EQ(frame.result.counts.part_triangles, frame.parts.size()) << what;
	EXPECT_EQ(frame.result.counts.split_triangles, frame.splits.size()) << what;
}

void expectEveryPiece(const GpuFrame& frame, const reference::Classified& expected, const std::string& what)
{
	EXPECT_EQ(reference::firstDifference(expected.parts, frame.parts).value_or(""), "") << what << ": part triangles";
	EXPECT_EQ(reference::firstDifference(expected.splits, frame.splits).value_or(""), "") << what << ": split triangles";
	EXPECT_EQ(frame.result.counts.micro_triangles, expected.microTriangles()) << what;
	EXPECT_EQ(frame.result.counts.part_triangles, expected.parts.size()) << what;
	EXPECT_EQ(frame.result.counts.split_triangles, expected.splits.size()) << what;
}

}  // namespace

void expectSameAsReference(const GpuFrame& frame, const std::string& what)
{
	const reference::Classified expected = frame.expected();
	if (frame.renderer->planInput().options.cull.frustum)
		expectOnlyUnseenMissing(frame, expected, what);
	else
		expectEveryPiece(frame, expected, what);
	EXPECT_EQ(reference::firstDifference(expected.full_clusters, frame.fullClusters()).value_or(""), "") << what << ": full clusters";
	EXPECT_EQ(frame.result.counts.full_clusters, expected.full_clusters.size()) << what;
	EXPECT_EQ(frame.result.counts.visible_clusters, frame.visible.size()) << what;
}

void expectCovered(const GpuFrame& frame, const std::string& what)
{
	std::vector<reference::ReferencePiece> sorted = frame.parts;
	reference::sortPieces(sorted);
	const reference::CoverReport report = reference::checkCover(frame.scene.host, frame.visible, frame.fullClusters(), sorted);
	EXPECT_EQ(report.first_problem, "") << what;
}

size_t differingPixels(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, int tolerance)
{
	EXPECT_EQ(a.size(), b.size());
	size_t count = 0;
	for (size_t pixel = 0; pixel + 3 < std::min(a.size(), b.size()); pixel += 4)
	{
		bool differs = false;
		for (size_t channel = 0; channel < 4; ++channel)
			differs |= std::abs(int(a[pixel + channel]) - int(b[pixel + channel])) > tolerance;
		count += differs;
	}
	return count;
}

}  // namespace tessera::test
