#include "verify/leak_views.h"

#include "base/log.h"
#include "verify/leak_check.h"
#include "verify/overlay.h"

namespace tessera::verify
{

namespace
{

constexpr size_t kTellEvery = 500;

class LeakRun
{
public:
	explicit LeakRun(const Request& request) : request_(request), truth_(*request.scene, *request.table)
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

	Status runViews(Raster path, float rate)
	{
		TRY_ASSIGN(const auto uncut, source(request_.uncut_options, path, rate, true));
		TRY_ASSIGN(const auto culled, source(request_.options, path, rate, false));
		for (size_t i = 0; i < request_.cameras.size(); ++i)
		{
			if (i % kTellEvery == 0)
				logInfo("--raster {}, rate {}: view {} of {}", rasterName(path), rate, i + 1, request_.cameras.size());
			TRY(runView(request_.cameras[i], path, rate, *uncut, *culled));
		}
		return {};
	}

	Status runView(const NamedCamera& camera, Raster path, float rate, FrameSource& uncut, FrameSource& culled)
	{
		TRY_ASSIGN(const Capture all, uncut.capture(camera.camera, rate));
		TRY_ASSIGN(const Capture seen, culled.capture(camera.camera, rate));
		CheckResult result = checkLeaks(Screen(truth_, all.view), all.micro, all.visible);
		if (seen.result.rate_granted == all.result.rate_granted)
			result.merge(checkLeaks(Screen(truth_, all.view), all.micro, seen.visible));
		result.setFrame(fmt::format("camera {}, rate {}, {}", camera.name, rate, rasterName(path)));
		++result.sums["views"];
		const uint64_t violations = result.violations;
		if (report_.picture.empty() || (violations > 0 && report_.violations() == 0))
		{
			report_.picture = paintViolations(all.visible, all.picture, result);
			report_.picture_frame = fmt::format("camera {}, rate {}", camera.name, rate);
		}
		report_.checks.front().result.merge(result);
		report_.frames.push_back({ camera.name, all.result.rate_wanted, all.result.rate_granted, all.result.every_factor_one,
								   all.result.counts.micro_triangles, all.visible.covered(), violations });
		return {};
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
