// The viewer's scene: loading, options, and the frames of the scene.
#include "app/option_text.h"
#include "base/log.h"
#include "pipeline/passes.h"
#include "viewer/camera_control.h"
#include "viewer/option_text_form.h"
#include "viewer/viewer.h"

#include <cstring>
#include <utility>

namespace tessera::view
{

namespace
{

// What is drawn of a scene until the one that was asked for is there: a metric's tables come with the scene.
RenderOptions drawableOptions(const AppOptions& options, const LoadedScene& scene)
{
	RenderOptions drawable = options;
	drawable.metric = scene.request.options.metric;
	return drawable;
}

}  // namespace

void Viewer::load(const std::string& scene, bool keeps_camera)
{
	loaded_ = session_.options;
	loader_.start({ scene, session_.options, keeps_camera });
}

void Viewer::takeScene()
{
	if (auto loaded = loader_.take())
	{
		if (!*loaded)
		{
			report(loaded->error());
			keepSceneOptions();
		}
		else
			next_scene_ = std::move(**loaded);
	}
	if (!next_scene_)
		return;
	auto made = Renderer::create(*device_, next_scene_->subject.scene, next_scene_->subject.table, framePasses(),
								 drawableOptions(session_.options, *next_scene_));
	const std::shared_ptr<LoadedScene> scene = std::exchange(next_scene_, nullptr);
	if (!made)
		return report(made.error());
	if (const Status waited = presenter_->wait(); !waited)
		return report(waited.error());
	host_scene_.reset();
	session_.inspection.reset();
	session_.is_frozen = session_.debug_camera = false;
	renderer_ = std::move(*made);
	applied_ = session_.options;
	const bool keeps_camera = scene->request.keeps_camera && session_.scene;
	session_.scene = renderer_scene_ = scene;
	session_.scene_name = scene->request.scene;
	session_.error.clear();
	session_.high_water.clear();
	has_failed_ = false;
	if (!keeps_camera)
		session_.camera = scene->subject.camera;
	if (!session_.options.camera_path.empty())
		loadPath(session_.options.camera_path);
	window_->setTitle("tessera: " + session_.scene_name);
}

// A scene could not be had with these options: those that made it stay those of the scene that is there.
void Viewer::keepSceneOptions()
{
	if (!session_.scene)
		return;
	for (const OptionDesc& option : optionTable())
		if (option.rebuild == Rebuild::Scene || option.name == "table")
		{
			auto kept = withOption(option, printOption(option, session_.scene->request.options), session_.options);
			if (kept)
				session_.options = std::move(*kept);
			auto applied = withOption(option, printOption(option, session_.scene->request.options), applied_);
			if (applied)
				applied_ = std::move(*applied);
		}
}

// Another device: everything on the old one is let go of, the scene stays.
Status Viewer::changeDevice()
{
	wants_device_ = false;
	const std::string before = applied_.device;
	closeDevice();
	Status opened = openDevice();
	if (!opened)
	{
		report(opened.error());
		closeDevice();
		session_.options.device = before;
		opened = openDevice();
	}
	TRY(opened);
	next_scene_ = session_.scene;
	if (next_scene_)
		next_scene_->request.keeps_camera = true;
	return {};
}

bool Viewer::followOptions()
{
	session_.options.width_px = session_.viewport_size.x;
	session_.options.height_px = session_.viewport_size.y;
	const Rebuild stale = staleAfter(applied_, session_.options);
	const bool differs = optionsJson(applied_) != optionsJson(session_.options);
	if (!differs)
		return !has_failed_;
	if (const Status waited = presenter_->wait(); !waited)
		return report(waited.error()), false;
	if (stale == Rebuild::Device)
	{
		wants_device_ = true;
		return false;
	}
	const bool needs_scene = stale >= Rebuild::Scene || applied_.table != session_.options.table;
	if (const Status set = renderer_->setOptions(drawableOptions(session_.options, *renderer_scene_)); !set)
	{
		report(set.error());
		const uint32_t width = session_.options.width_px, height = session_.options.height_px;
		session_.options = applied_;
		session_.options.width_px = width;
		session_.options.height_px = height;
		return false;
	}
	applied_ = session_.options;
	has_failed_ = false;
	if (needs_scene)
		load(session_.scene_name, true);
	return true;
}

void Viewer::beginScene()
{
	if (!renderer_ || !followOptions())
		return;
	running_ = {};
	running_.number = ++begun_;
	running_.camera = session_.separates() ? session_.culled_camera : session_.camera;
	running_.drawn_from = session_.camera;
	running_.options = session_.options;
	FrameRequest request = { running_.camera, {}, {}, {} };
	if (session_.separates())
		request.drawn_from = session_.camera;
	asked_pixel_ = std::exchange(session_.requests.pick, std::nullopt);
	asked_centre_ = std::exchange(session_.requests.recentre, std::nullopt);
	if (asked_pixel_ || asked_centre_)
		request.more_outputs.assign(std::begin(kInspectionOutputs), std::end(kInspectionOutputs));
	if (const Status begun = renderer_->beginFrame(request); !begun)
	{
		has_failed_ = true;
		return report(begun.error());
	}
	is_running_ = true;
}

Status Viewer::pollScene()
{
	if (!is_running_)
		return {};
	auto polled = renderer_->pollFrame();
	if (!polled)
	{
		is_running_ = false;
		has_failed_ = true;
		if (polled.error().code == ExitCode::DeviceLost)
			return tl::unexpected(polled.error());
		report(polled.error());
		return {};
	}
	if (!*polled)
		return {};
	is_running_ = false;
	has_picture_ = true;
	running_.result = std::move(**polled);
	running_.plan = renderer_->plan();
	running_.input = renderer_->planInput();
	running_.memory = renderer_->memory();
	if (const Status read = readBack(); !read)
		report(read.error());
	return {};
}

// What was asked of this frame beside its picture; it is finished, so the copies take no time to speak of.
Status Viewer::readBack()
{
	if (session_.gizmos.any())
	{
		TRY_ASSIGN(const std::vector<std::byte> bytes, renderer_->readResource("visible_clusters"));
		running_.visible.resize(bytes.size() / sizeof(ClusterRef));
		if (!running_.visible.empty())
			std::memcpy(running_.visible.data(), bytes.data(), running_.visible.size() * sizeof(ClusterRef));
	}
	const std::optional<uvec2> pixel = asked_centre_ ? asked_centre_ : asked_pixel_;
	if (!pixel)
		return {};
	if (!host_scene_)
		host_scene_ =
			std::make_unique<reference::HostScene>(renderer_scene_->subject.scene, renderer_scene_->subject.table, running_.input.options.metric);
	const RenderOptions& options = running_.input.options;
	TRY_ASSIGN(Inspection found,
			   inspectPixel(*renderer_, *host_scene_, running_.result, glm::min(*pixel, uvec2(options.width_px - 1, options.height_px - 1))));
	if (asked_centre_ && found.covered)
		session_.camera =
			lookingAt(session_.camera, pointAt(running_.drawn_from, dvec2(*pixel) + 0.5, { options.width_px, options.height_px }, found.depth_world));
	session_.inspection = std::move(found);
	return {};
}

void Viewer::takeShaders()
{
	session_.shaders.is_compiling = reloader_.isCompiling();
	auto compiled = reloader_.take();
	if (!compiled || !renderer_)
		return;
	session_.shaders.is_compiling = false;
	if (!*compiled)
	{
		session_.shaders.error = compiled->error().message;
		logWarning("shaders: {}", compiled->error().message);
		return;
	}
	const auto replaced = renderer_->replaceShaders(**compiled);
	session_.shaders.error = replaced ? "" : replaced.error().message;
	if (!replaced)
		return logWarning("shaders: {}", replaced.error().message);
	session_.shaders.replaced = *replaced;
	++session_.shaders.reloads;
	logInfo("{} replaced", counted(*replaced, "shader"));
}

}  // namespace tessera::view
