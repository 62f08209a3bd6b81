// Loads a scene beside the window.
#pragma once
#include "app/scene_load.h"

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

namespace tessera::view
{

struct LoadRequest
{
	std::string scene;
	AppOptions options;
	bool keeps_camera = false;  // the scene that is there, built anew: the view stays
};

struct LoadedScene
{
	LoadRequest request;
	Subject subject;
};

class SceneLoader
{
public:
	~SceneLoader();

	// Starts loading; a request while one runs waits for it and replaces what waited before.
	void start(LoadRequest request);
	bool isLoading() const { return running_.valid(); }
	std::string loading() const { return request_.scene; }
	// What is being done, and how far it is: 0..1, of steps of very unequal length.
	std::string step() const;
	float progress() const { return progress_; }

	// The scene when it is there, the error when it could not be loaded, else nothing. Never waits.
	std::optional<Result<std::shared_ptr<LoadedScene>>> take();

private:
	Result<std::shared_ptr<LoadedScene>> load(const LoadRequest& request);
	void say(const std::string& step, float progress);

	LoadRequest request_;
	std::optional<LoadRequest> next_;
	std::future<Result<std::shared_ptr<LoadedScene>>> running_;
	mutable std::mutex step_mutex_;
	std::string step_;
	std::atomic<float> progress_ = 0;
};

}  // namespace tessera::view
