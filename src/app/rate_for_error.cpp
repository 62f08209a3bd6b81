#include "app/rate_for_error.h"

#include "base/log.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

namespace
{

constexpr double kFinest = 1.0 / 16, kCoarsest = 256;
constexpr double kMargin = 0.97;  // of the error asked for
constexpr double kNear = 1.1;     // a coarser rate that is nearer than this is not looked for
constexpr uint32_t kMostTried = 16;
constexpr uint64_t kMostMicroTriangles = 40'000'000;
constexpr report::SamplingLimits kSampling = { 1 << 15, 1 << 19, 0.01 };

class RateSearch
{
public:
	RateSearch(const BuiltScene& scene, const TessellationTable& table, const Camera& camera, const AppOptions& options, double target_px)
		: scene_(scene), host_(scene, table, options.metric), camera_(camera), options_(options), target_px_(target_px), progress_(!options.quiet)
	{}

	Result<FoundRate> run()
	{
		double rate = std::clamp(options_.rate > 0 ? double(options_.rate) : 4.0, kFinest, kCoarsest);
		while (found_.tried < kMostTried)
		{
			TRY_ASSIGN(const report::RegionError seen, measure(rate));
			++found_.tried;
			logInfo("rate {:.4g}: largest error seen {:.3g} px", rate, seen.px.max);
			if (seen.px.max <= target_px_ && rate > found_.rate)
			{
				found_.rate = rate;
				found_.seen = seen;
			}
			else if (seen.px.max > target_px_ && (too_coarse_ == 0 || rate < too_coarse_))
			{
				too_coarse_ = rate;
				least_px_ = seen.px.max;
			}
			if (found_.rate >= kCoarsest || too_coarse_ == kFinest || (found_.rate > 0 && too_coarse_ > 0 && too_coarse_ <= found_.rate * kNear))
				break;
			rate = next(rate, seen.px.max);
		}
		if (found_.rate == 0)
			return badInput("--max-error-px: not held: at rate {:.4g} the largest error seen is still {:.3g} px; ask for more than that", too_coarse_,
							least_px_);
		return found_;
	}

private:
	// Where the error would be the target if it went with the square of the rate on a smooth surface, and slower on a rough one; between what
	// is known to hold and what is known not to.
	double next(double rate, double error_px) const
	{
		const double wanted = error_px > 0 ? rate * std::pow(target_px_ / error_px, 0.75) : rate * 8;
		const double step = std::clamp(wanted, rate / 8, rate * 8);
		if (found_.rate > 0 && too_coarse_ > 0)
		{
			// Well inside, so that every step narrows it down.
			const double width = std::log(too_coarse_ / found_.rate);
			return found_.rate * std::exp(std::clamp(std::log(step / found_.rate), 0.25 * width, 0.75 * width));
		}
		// One end is open: at least a step towards it.
		const double onward = found_.rate > 0 ? std::max(step, rate * 1.3) : std::min(step, rate / 1.3);
		return std::clamp(onward, kFinest, kCoarsest);
	}

	Result<report::RegionError> measure(double rate)
	{
		ViewRequest request = { options_.width_px, options_.height_px };
		request.rate_px = double(static_cast<float>(rate));
		request.displacement_scale = options_.displacement_scale;
		request.displacement_offset = options_.displacement_offset;
		TRY_ASSIGN(const View view, makeView(camera_, scene_, request));
		TRY_ASSIGN(const report::MicroScene micro, report::tessellate(host_, view, options_.max_split, kMostMicroTriangles));
		if (!surface_)
			surface_ = std::make_unique<report::ReferenceSurface>(host_, view);
		const report::SurfacePair pair(host_, view, *surface_, micro);
		return report::visibleError(pair, 2 * boundingRadius(scene_), kSampling, progress_);
	}

	const BuiltScene& scene_;
	reference::HostScene host_;
	const Camera& camera_;
	const AppOptions& options_;
	double target_px_;
	report::Progress progress_;
	std::unique_ptr<report::ReferenceSurface> surface_;
	FoundRate found_;
	double too_coarse_ = 0, least_px_ = 0;  // the finest rate that does not hold, and its error
};

}  // namespace

Result<FoundRate> rateForError(const BuiltScene& scene, const TessellationTable& table, const Camera& camera, const AppOptions& options,
							   double max_error_px)
{
	return RateSearch(scene, table, camera, options, max_error_px * kMargin).run();
}

}  // namespace tessera
