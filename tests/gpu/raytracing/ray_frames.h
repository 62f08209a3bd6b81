// Frames that tests of primary rays draw, and how they are compared with those of the compute rasteriser.
#pragma once
#include "gpu/gpu_test.h"
#include "verify/cameras.h"

namespace tessera::test
{

std::unique_ptr<Renderer> rendererOf(const GpuScene& scene, const RenderOptions& options);

struct Drawn
{
	FrameResult result;
	std::vector<uint8_t> picture;
};
// Fails the test (and gives nothing) when the frame cannot be drawn.
Drawn drawnBy(Renderer& renderer, const Camera& camera);

// The list's numbers; fails the test when there is none of this name.
const ListStats& listOf(const FrameResult& result, std::string_view name);

// The scene's camera and random ones: far, close, within, grazing, narrow and wide.
std::vector<verify::NamedCamera> camerasOf(const GpuScene& scene, uint64_t seed, uint32_t count);

// From all cameras, rays may differ from the compute rasteriser only at edges. Gives how many instances shared a structure in all frames together.
uint64_t expectSameVisibility(const GpuScene& scene, const std::string& name, RenderOptions options, const std::vector<verify::NamedCamera>& cameras);
uint64_t expectSameVisibility(const GpuScene& scene, const std::string& name, float rate, const std::vector<verify::NamedCamera>& cameras);

}  // namespace tessera::test
