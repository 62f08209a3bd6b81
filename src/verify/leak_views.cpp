#include "verify/leak_views.h"

#include "base/log.h"
#include "verify/leak_check.h"
#include "verify/overlay.h"

#include <algorithm>
#include <deque>
#include <future>
#include <thread>

namespace tessera::verify
{

namespace
{

constexpr size_t kTellEvery = 500;

class LeakRun
{
public:
	explicit LeakRun(const Request& request) : request_(request), truth_(*request.scene, *request.table, request.options.metric)
	{
		report_.checks = { { kNoLeaks, "pixels", {} } };
	}

	Result<Report> run()
	{
		for (const Raster path : request_.paths)
			for (const float rate : request_.rates)
				TRY(runViews(path, rate));
		return std::move(report_);
	}

private:
	Result<std::unique_ptr<FrameSource>> source(RenderOptions options, Raster path, float rate, bool with_micro) const
	{
		options.raster = path;
		options.rate = rate;
		return FrameSource::create(*request_.device, truth_, *request_.scene, *request_.table, options, with_micro, {}, request_.seed);
	}

	// The device draws views one after another; what it drew is looked at on all threads meanwhile.
	Status runViews(Raster path, float rate)
	{
		TRY_ASSIGN(const auto uncut, source(request_.uncut_options, path, rate, true));
		TRY_ASSIGN(const auto culled, source(request_.options, path, rate, false));
		std::deque<std::future<ViewOutcome>> looked_at;
		for (size_t i = 0; i < request_.cameras.size(); ++i)
		{
			if (i % kTellEvery == 0)
				logInfo("--raster {}, rate {}: view {} of {}", rasterName(path), rate, i + 1, request_.cameras.size());
			const NamedCamera& camera = request_.cameras[i];
			Drawn drawn = { &camera, {}, {} };
			TRY_ASSIGN(drawn.all, uncut->capture(camera.camera, rate, false));
			TRY_ASSIGN(drawn.seen, culled->capture(camera.camera, rate, false));
			looked_at.push_back(std::async(std::launch::async, [this, path, rate, drawn = std::move(drawn)] { return look(drawn, path, rate); }));
			if (looked_at.size() < 2 * std::max(std::thread::hardware_concurrency(), 1u))
				continue;
			add(looked_at.front().get());
			looked_at.pop_front();
		}
		for (std::future<ViewOutcome>& view : looked_at)
			add(view.get());
		return {};
	}

	// Without and with culling.
	struct Drawn
	{
		const NamedCamera* camera;
		Capture all, seen;
	};
	struct ViewOutcome
	{
		CheckResult result;
		FrameLine frame;
		std::vector<uint8_t> picture;  // with its violations
	};

	ViewOutcome look(const Drawn& drawn, Raster path, float rate) const
	{
		const Capture &all = drawn.all, &seen = drawn.seen;
		const Silhouette silhouette(Screen(truth_, all.view), all.micro);
		ViewOutcome view;
		view.result = silhouette.leaks(all.visible);
		if (seen.result.rate_granted == all.result.rate_granted)
			view.result.merge(silhouette.leaks(seen.visible));
		view.result.setFrame(fmt::format("camera {}, rate {}, {}", drawn.camera->name, rate, rasterName(path)));
		++view.result.sums["views"];
		view.frame = {
			drawn.camera->name,    all.result.rate_wanted, all.result.rate_granted, all.result.every_factor_one, all.result.counts.micro_triangles,
			all.visible.covered(), view.result.violations
		};
		view.picture = paintViolations(all.visible, all.picture, view.result);
		return view;
	}

	void add(ViewOutcome view)
	{
		if (report_.picture.empty() || (view.frame.violations > 0 && report_.violations() == 0))
		{
			report_.picture = std::move(view.picture);
			report_.picture_frame = fmt::format("camera {}, rate {}", view.frame.camera, view.frame.rate_wanted);
		}
		report_.checks.front().result.merge(view.result);
		report_.frames.push_back(std::move(view.frame));
	}

	const Request& request_;
	reference::HostScene truth_;
	Report report_;
};

}  // namespace

Result<Report> runLeaks(const Request& request)
{
	return LeakRun(request).run();
}

}  // namespace tessera::verify
