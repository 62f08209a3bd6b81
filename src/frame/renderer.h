// Draws frames of one scene on one device: plans, holds resources and pipelines, coarsens when a list would overflow.
#pragma once
#include "frame/dump_layout.h"
#include "frame/stats.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "plan/plan.h"
#include "scene/camera.h"
#include "tables/table.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace tessera
{

// What every frame is planned back from.
inline constexpr std::string_view kWantedOutputs[] = { "picture", "counts", "heads" };

// Called after every drawn round of a frame (C2) that fitted, while the lists still hold it. A frame that turns out not to fit starts again
// at round 0.
using RoundReader = std::function<Status(uint32_t round)>;

// A frame that is asked for. `drawn_from`: the camera that sees it, when it is culled and tessellated for `camera` all the same.
struct FrameRequest
{
	Camera camera;
	std::optional<Camera> drawn_from;
	std::vector<std::string_view> more_outputs;  // resources wanted of this frame beside those of the renderer; static strings
	RoundReader after_round;
};

class Renderer
{
public:
	// `passes` in execution order (pipeline/passes.h). `more_outputs`: resources that are wanted beside kWantedOutputs, such as
	// micro_dump or kept_visibility; static strings. The scene, table and device must outlive the renderer.
	// Errors: DeviceCannot (a gate that the options need is closed), BadInput (out of memory, picture too large).
	static Result<std::unique_ptr<Renderer>> create(Device& device, const BuiltScene& scene, const TessellationTable& table,
													std::span<const PassDesc* const> passes, const RenderOptions& options,
													std::span<const std::string_view> more_outputs = {});
	virtual ~Renderer() = default;

	// One picture. When lists overflow it is counted again at a coarser rate until it fits; nothing is dropped (C2).
	virtual Result<FrameResult> renderFrame(const Camera& camera, const RoundReader& after_round = {}) = 0;

	// The same without waiting: submits the frame, and says from time to time whether it is there. Until then pollFrame draws it again as often as
	// needed and gives nothing; the picture is that of a whole frame only when it has given a result. One frame at a time; after an
	// error the frame is over.
	virtual Status beginFrame(const FrameRequest& request) = 0;
	virtual Result<std::optional<FrameResult>> pollFrame() = 0;

	// Other options for the frames that follow, between two frames. Remakes what they make stale and keeps the scene and every pipeline.
	// Errors: those of create; then the options are as before.
	virtual Status setOptions(const RenderOptions& options) = 0;

	// Another rate for the frames that follow, pixels. Pipelines are specialised by whether it is 0 and lists by the raster path, so neither
	// may change: both rates 0 or both above, and the raster path not `auto`.
	virtual void setRate(float rate_px) = 0;

	// Where the last picture lies on the device, until the next frame begins or options change.
	virtual VkBuffer pictureBuffer() const = 0;

	// The last picture: width x height x 4 bytes, RGBA, sRGB-encoded, rows top to bottom.
	virtual Result<std::vector<uint8_t>> readPicture() = 0;

	// Entries of a list or bytes of a named resource after the last frame (for tests and verification).
	virtual Result<std::vector<std::byte>> readResource(std::string_view name) = 0;

	// The plan of the last frame (before the first: of the framing camera).
	virtual const FramePlan& plan() const = 0;
	virtual const PlanInput& planInput() const = 0;
	// Of micro_dump, where it is kept.
	virtual const DumpLayout& dumpLayout() const = 0;
	virtual MemoryStats memory() const = 0;
	// The view of the last frame, as the shaders saw it: that it was tessellated for, and that it was drawn from.
	virtual const View& view() const = 0;
	virtual const View& drawnView() const = 0;

	// Shaders of the passes that the last frame ran, by name.
	virtual std::vector<std::string> shaderNames() const = 0;
	// Draws with these from now on, between two frames; gives how many differ from those before. When a pipeline of the last frame cannot be made of
	// them, all stay as they were. Errors: DeviceCannot.
	virtual Result<size_t> replaceShaders(std::span<const Shader> shaders) = 0;
};

// What the planner needs to know of the arrays of a scene and a table.
SceneSizes sizesOf(const BuiltScene& scene);  // without the table's
SceneSizes sizesOf(const BuiltScene& scene, const TessellationTable& table);
DeviceTraits traitsOf(const Device& device);

}  // namespace tessera
