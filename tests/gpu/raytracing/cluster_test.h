// What tests of rays through clusters share: a device under the layer that emulates and checks VK_NV_cluster_acceleration_structure, which ends the
// process at the first rule that is broken.
#pragma once
#include "ray_test.h"

#include "pipeline/passes.h"

namespace tessera::test
{

class ClusterTest : public testing::Test
{
protected:
	void SetUp() override;
	void TearDown() override;
};

// The process's device under the layer; only within a ClusterTest.
Device& clusterDevice();

struct ClusterFrame
{
	FrameResult result;
	std::vector<uint8_t> picture;

	const RayClusterStats& clusters() const { return result.rays.clusters; }
	const ListStats& list(std::string_view name) const;
};

std::unique_ptr<Renderer> clusterRenderer(const GpuScene& scene, const RenderOptions& options, std::vector<std::string_view> more_outputs = {});
ClusterFrame drawnBy(Renderer& renderer, const Camera& camera);
// A frame of a renderer of its own.
ClusterFrame drawn(const GpuScene& scene, const RenderOptions& options, const Camera& camera);

// As rayOptions, through clusters or through all triangles at once.
RenderOptions pathOptions(float rate, RayPath path, Raster raster = Raster::Rt);

}  // namespace tessera::test
