// What tests on a device share: one validated device per process, scenes with their CPU reference, and frames with their lists.
// Runs on whatever device is there; a software driver is one.
#pragma once
#include "cpu/build_test_scenes.h"
#include "frame/renderer.h"
#include "reference/classify.h"
#include "reference/evaluate.h"
#include "shared/lists.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessera::test
{

// Skips without a device or without the validation layer; fails when the layer had anything to say during the test.
class GpuTest : public testing::Test
{
protected:
	void SetUp() override;
	void TearDown() override;

private:
	uint32_t messages_before_ = 0;
};

// The process's device; only within a GpuTest.
Device& gpu();

// A built scene, its reference and a camera that shows it. Does not move: the reference holds addresses.
struct GpuScene
{
	explicit GpuScene(const ImportedScene& imported, const TessellationTable& used_table = defaultTable(), const BuildOptions& options = {});

	const TessellationTable& table;
	BuiltScene built;
	reference::HostScene host;
	Camera camera;
};

// The built-in scene of this name, or the one of a file below tests/data or bench/scenes.
std::unique_ptr<GpuScene> gpuScene(std::string_view name, const BuildOptions& options = {});

// The default table without the patterns of edges with more segments.
TessellationTable smallTable(uint32_t max_edge_segments);

// A flat square of side 1 around the origin, facing +z, of two triangles.
ImportedScene squareScene();

// Mirrored, sheared, flattened and turned copies of a displaced cube.
ImportedScene unevenScene();

// Near the surface: `fraction` of the way from the scene's camera to its target is left.
Camera closeTo(const GpuScene& scene, double fraction);
// Looks from `eye` to `target` with 90 degrees: the focal length is half the picture's height.
Camera squareCamera(dvec3 eye, dvec3 target);

// 160 x 90, mesh shaders where the device has them.
RenderOptions smallOptions(float rate);

// The rasterisers that this device has. A new one is added here and is then compared with the others.
std::vector<Raster> rasterPaths();
// Those and, last, rays: seconds a frame on a software device, so only where rays can make a difference.
std::vector<Raster> everyPath();
// Those that keep micro-vertices in a buffer and visibility in attachments.
std::vector<Raster> drawingPaths();

// A batch's or a full cluster's place is free, so lists are read back as they are and compared as sets.
struct GpuFrame
{
	const GpuScene& scene;
	std::unique_ptr<Renderer> renderer;
	FrameResult result;
	std::vector<ClusterRef> visible;
	std::vector<DomainTriangle> part_records;
	std::vector<reference::ReferencePiece> parts;   // as listed
	std::vector<reference::ReferencePiece> splits;  // as listed

	// Entries of a list, or the texels of an image; empty when the plan leaves it out.
	template <typename T>
	std::vector<T> read(std::string_view name) const
	{
		const std::vector<std::byte> bytes = readBytes(name);
		std::vector<T> items(bytes.size() / sizeof(T));
		if (!items.empty())
			std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
		return items;
	}
	std::vector<uint8_t> picture() const;
	const View& view() const { return renderer->view(); }
	const ListStats& list(std::string_view name) const;
	std::vector<ClusterRef> fullClusters() const;
	// What the reference makes of the clusters that the device found visible, at the granted rate.
	reference::Classified expected() const;

private:
	std::vector<std::byte> readBytes(std::string_view name) const;
};

// Draws a frame and reads its lists; fails the test (and returns an empty frame) when that is not possible.
GpuFrame drawFrame(const GpuScene& scene, const RenderOptions& options, const Camera& camera);
inline GpuFrame drawFrame(const GpuScene& scene, const RenderOptions& options)
{
	return drawFrame(scene, options, scene.camera);
}
// The same with a renderer that has drawn before.
void drawAgain(GpuFrame& frame, const Camera& camera);

// Parts, splits, full clusters and counts of the frame equal the reference's.
void expectSameAsReference(const GpuFrame& frame, const std::string& what);
// Every base triangle of a visible cluster is covered exactly once.
void expectCovered(const GpuFrame& frame, const std::string& what);

// Pixels of two pictures that differ in any channel by more than `tolerance`.
size_t differingPixels(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, int tolerance = 0);

}  // namespace tessera::test
