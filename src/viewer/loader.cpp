#include "viewer/loader.h"

#include "app/option_text.h"
#include "base/log.h"
#include "scene/build.h"

#include <chrono>
#include <new>

namespace tessera::view
{

SceneLoader::~SceneLoader()
{
	if (running_.valid())
		running_.wait();
}

void SceneLoader::start(LoadRequest request)
{
	if (isLoading())
	{
		next_ = std::move(request);
		return;
	}
	request_ = std::move(request);
	say("starting", 0);
	running_ = std::async(std::launch::async, [this, wanted = request_] { return load(wanted); });
}

std::string SceneLoader::step() const
{
	const std::lock_guard lock(step_mutex_);
	return step_;
}

void SceneLoader::say(const std::string& step, float progress)
{
	const std::lock_guard lock(step_mutex_);
	step_ = step;
	progress_ = progress;
}

Result<std::shared_ptr<LoadedScene>> SceneLoader::load(const LoadRequest& request)
{
	try
	{
		auto loaded = std::make_shared<LoadedScene>();
		loaded->request = request;
		Subject& subject = loaded->subject;
		TRY_ASSIGN(subject.table, loadChosenTable(request.options));
		say("reading", 0.1f);
		TRY_ASSIGN(const ImportedScene imported, importScene(request.scene, request.options));
		say("building clusters, seams and bounds", 0.5f);
		TRY_ASSIGN(subject.scene, buildScene(imported, buildOptionsOf(request.options)));
		for (const std::string& warning : subject.scene.warnings)
			logWarning("{}", warning);
		say("sending to the device", 0.95f);
		TRY_ASSIGN(subject.camera, chooseCamera(subject.scene, request.options));
		logInfo("built {} in {}", counted(subject.scene.traits.base_triangles, "triangle"), counted(subject.scene.clusters.size(), "cluster"));
		return loaded;
	}
	catch (const std::bad_alloc&)
	{
		return badInput("{}: out of memory", request.scene);
	}
}

std::optional<Result<std::shared_ptr<LoadedScene>>> SceneLoader::take()
{
	if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
		return {};
	Result<std::shared_ptr<LoadedScene>> loaded = running_.get();
	if (next_)
	{
		LoadRequest next = std::move(*next_);
		next_.reset();
		start(std::move(next));
	}
	return loaded;
}

}  // namespace tessera::view
