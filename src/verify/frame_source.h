// One way to draw a scene, and what a frame of it holds.
#pragma once
#include "verify/conservative_check.h"

namespace tessera::verify
{

struct Capture
{
	FrameResult result;
	View view = {};
	std::vector<uint8_t> picture;  // RGBA
	VisiblePicture visible;
	DrawnThings drawn;  // sorted
	MicroSet micro;     // sorted; empty unless asked for
};

// How a way of drawing differs from the usual one.
struct Variation
{
	std::string name;              // as in "again with other capacities"
	bool shuffled = false;         // instances, and clusters within their meshes, in another order
	uint32_t compute_threads = 0;  // 0: as usual
	uint32_t mesh_threads = 0, loop_workgroups = 0;
	bool height_texels = false;  // height maps as texels, not as footprints
	bool other_kernels = false;  // small triangles in a kernel of their own where they have none, or none where they have
};

class FrameSource
{
public:
	// `truth`: the scene that the device is held to; `given`: the one it gets, the same but for a fault. All must outlive the source. The raster path
	// of `options` must not be `auto`. Errors: those of Renderer::create.
	static Result<std::unique_ptr<FrameSource>> create(Device& device, const reference::HostScene& truth, const BuiltScene& given,
													   const TessellationTable& table, const RenderOptions& options, bool with_micro,
													   const Variation& variation, uint64_t seed);

	// Draws a frame and reads it back; `sorts`: so that it can be compared with others. Errors: those of Renderer::renderFrame and readDump;
	// CheckFailed when the device names what does not exist.
	Result<Capture> capture(const Camera& camera, float rate_px, bool sorts = true);

	const Variation& variation() const { return variation_; }

private:
	FrameSource(Device& device, const reference::HostScene& truth) : device_(device), truth_(truth) {}
	Status readRound(uint32_t round, Capture& capture);
	Status checkExistence(const FrameDump& dump) const;

	Device& device_;
	const reference::HostScene& truth_;
	BuiltScene shuffled_;
	SceneOrder order_;
	Variation variation_;
	std::unique_ptr<Renderer> renderer_;
	bool with_micro_ = false;
};

// Everything that must not differ between two frames of one camera and rate: counts, identities (but for ties), colours where identities
// agree, micro-triangles where both have them. Frames of different granted rates are not compared.
CheckResult compareFrames(const Capture& expected, const Capture& found, const std::string& what);

}  // namespace tessera::verify
