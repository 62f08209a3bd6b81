// Every parameter through its range and back: counts follow the change and nothing else, and culling never changes a pixel on the way.
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

#include <cmath>

namespace tessera::verify
{

namespace
{

constexpr int kSteps = 16;

// One frame of an animation.
struct Step
{
	Camera camera;
	float rate_px = 4;
	// Most that the logarithm of any edge's length in segments can have changed since the step before.
	double change = 0;
};

using Animation = std::vector<Step>;

// `at(t)` for t from 0 to 1.
Animation steps(const std::function<Step(double t)>& at)
{
	Animation animation;
	for (int i = 0; i <= kSteps; ++i)
		animation.push_back(at(double(i) / kSteps));
	return animation;
}

double between(double low, double high, double t)
{
	return low * std::pow(high / low, t);
}

// Counts of one drawn step, without culling.
struct Counts
{
	uint64_t micro = 0, parts = 0, splits = 0;
	bool operator==(const Counts&) const = default;
};

class AnimationRun
{
public:
	AnimationRun(const SuiteDevice& suite, const Case& one, const BuiltScene& scene)
		: suite_(suite), case_(one), truth_(scene, suite.table, one.options.metric)
	{}

	Result<Measured> run(const Animation& forth)
	{
		for (const bool cull : { false, true })
		{
			RenderOptions options = case_.options;
			options.width_px = case_.width_px;
			options.height_px = case_.height_px;
			options.raster = suite_.paths.front();
			options.rate = forth.front().rate_px;
			if (!cull)
				options.cull = { false, false, false };
			TRY_ASSIGN((cull ? culled_ : uncut_),
					   FrameSource::create(suite_.device, truth_, truth_.built(), suite_.table, options, false, {}, suite_.seed));
		}
		TRY_ASSIGN(const std::vector<Counts> first, pass(forth));
		TRY_ASSIGN(std::vector<Counts> again, pass({ forth.rbegin(), forth.rend() }));
		std::reverse(again.begin(), again.end());
		for (size_t i = 0; i < first.size(); ++i)
		{
			check(first[i] == again[i],
				  [&] { return fmt::format("step {}: {} micro-triangles on the way there, {} on the way back", i, first[i].micro, again[i].micro); });
			if (i > 0)
				checkJump(i, forth[i].change, first[i - 1], first[i]);
		}
		return measured_;
	}

private:
	Result<std::vector<Counts>> pass(const Animation& animation)
	{
		std::vector<Counts> counts;
		for (size_t i = 0; i < animation.size(); ++i)
		{
			TRY_ASSIGN(const Capture uncut, uncut_->capture(animation[i].camera, animation[i].rate_px));
			TRY_ASSIGN(const Capture culled, culled_->capture(animation[i].camera, animation[i].rate_px));
			const FrameCountsRead& read = uncut.result.counts;
			counts.push_back({ read.micro_triangles, read.part_triangles, read.split_triangles });
			if (culled.result.rate_granted != uncut.result.rate_granted)
				continue;
			const CheckResult same = comparePictures(uncut.visible, culled.visible, "with culling");
			check(same.violations == 0, [&] { return fmt::format("step {}: {}", i, describe(same.place)); });
		}
		return counts;
	}

	// The number of micro-triangles goes with the square of the edges' lengths in segments.
	void checkJump(size_t step, double change, const Counts& before, const Counts& after)
	{
		const double jump = std::abs(std::log(double(after.micro) / double(before.micro)));
		const double beyond = std::max(0.0, jump - 2 * change);
		measured_.worst = std::max(measured_.worst, beyond);
		check(beyond <= case_.expected.bound, [&] { return fmt::format("step {}: from {} to {} micro-triangles", step, before.micro, after.micro); });
	}

	void check(bool holds, const std::function<std::string()>& what)
	{
		++measured_.checks;
		if (holds)
			return;
		++measured_.violations;
		if (measured_.what.empty())
			measured_.what = what();
	}

	const SuiteDevice& suite_;
	const Case& case_;
	reference::HostScene truth_;
	std::unique_ptr<FrameSource> uncut_, culled_;
	Measured measured_;
};

const dvec3 kEye = { 1.5, 1.2, 3 };

Camera from(dvec3 eye)
{
	return parts::lookingAt(eye, dvec3(0), 50, 1e-2);
}

Animation towards()
{
	double before = 0;
	return steps([&](double t) {
		const double distance = between(30, 1.3, t);
		// The nearest point of the ball, displaced or not, is a unit nearer than its middle.
		const double change = before > 0 ? std::log((before - 1) / (distance - 1)) : 0;
		before = distance;
		return Step{ from(glm::normalize(kEye) * distance), 4, change };
	});
}

Animation around()
{
	constexpr double kDistance = 3, kAngle = 6.283185307179586 / kSteps;
	return steps([&](double t) {
		const double angle = 6.283185307179586 * t;
		return Step{ from(kDistance * dvec3(std::cos(angle), 0.3, std::sin(angle))), 4, kDistance * kAngle / (kDistance - 1) };
	});
}

// Where it looks, and what is up, changes no edge's length over distance: counts stay the same exactly.
Animation turning()
{
	return steps([&](double t) {
		Camera camera = from(kEye);
		camera.target = dvec3(2 * t - 1, 0.5 * t, -t);
		camera.up = dvec3(std::sin(3 * t), std::cos(3 * t), 0);
		return Step{ camera, 4, 0 };
	});
}

Animation fields()
{
	double before = 0;
	return steps([&](double t) {
		Camera camera = from(kEye);
		camera.fov_y_rad = between(1, 170, t) * (3.14159265358979323846 / 180);
		const double focal = 1 / std::tan(camera.fov_y_rad / 2), change = before > 0 ? std::abs(std::log(focal / before)) : 0;
		before = focal;
		return Step{ camera, 8, change };
	});
}

Animation rates()
{
	return steps([&](double t) { return Step{ from(kEye), float(between(0.7, 300, t)), std::log(300 / 0.7) / kSteps }; });
}

Animation heightsOfViews()
{
	return steps([&](double t) {
		Camera camera = from(kEye);
		camera.orthographic = true;
		camera.height_world = between(0.5, 100, t);
		return Step{ camera, 8, std::log(200) / kSteps };
	});
}

Animation nearDistances()
{
	return steps([&](double t) {
		Camera camera = from(kEye);
		camera.near_world = between(1e-3, 1, t);
		return Step{ camera, 4, 0 };
	});
}

void add(std::vector<Case>& cases, std::string name, std::string what, Animation (*make)(), double bound)
{
	Case one = { "animation", std::move(name), std::move(what) };
	one.scene = [] {
		return parts::ball(6);
	};
	one.expected = within("change of counts beyond the parameter's, logarithm", bound);
	one.measure = [make](const SuiteDevice& suite, const Case& self, const BuiltScene& scene) {
		return AnimationRun(suite, self, scene).run(make());
	};
	cases.push_back(std::move(one));
}

// Displacement is no part of an edge's length: whatever its scale, counts stay the same, and so does the surface's every promise.
Result<Measured> measureScales(const SuiteDevice& suite, const Case& one, const BuiltScene& scene)
{
	Measured sum;
	uint64_t micro = 0;
	for (const float scale : { -3.0f, -1.0f, -0.1f, 0.0f, 0.1f, 1.0f, 3.0f })
	{
		Case scaled = one;
		scaled.options.displacement_scale = scale;
		reference::HostScene truth(scene, suite.table, one.options.metric);
		RenderOptions options = scaled.options;
		options.width_px = one.width_px;
		options.height_px = one.height_px;
		options.raster = suite.paths.front();
		TRY_ASSIGN(const auto source, FrameSource::create(suite.device, truth, scene, suite.table, options, false, {}, suite.seed));
		TRY_ASSIGN(const Capture frame, source->capture(from(kEye), 4));
		++sum.checks;
		if (micro > 0 && frame.result.counts.micro_triangles != micro)
		{
			++sum.violations;
			sum.what = fmt::format("{} micro-triangles at scale {}, {} before", frame.result.counts.micro_triangles, scale, micro);
		}
		micro = frame.result.counts.micro_triangles;
	}
	sum.worst = double(sum.violations);
	return sum;
}

}  // namespace

void addAnimationCases(std::vector<Case>& cases)
{
	constexpr double kRounding = 0.1;  // what rounding factors to whole numbers may add
	add(cases, "towards", "the eye from 30 radii to 0.3 above the surface", towards, kRounding);
	add(cases, "around", "the eye around the model", around, kRounding);
	add(cases, "turning", "what is looked at and what is up: counts stay the same", turning, 0);
	add(cases, "fields_of_view", "1 to 170 degrees", fields, kRounding);
	add(cases, "rates", "0.7 to 300 pixels", rates, kRounding);
	// In a parallel view all edges of one length change their factor at once.
	add(cases, "orthographic_heights", "views of 0.5 to 100 units", heightsOfViews, 2 * kRounding);
	add(cases, "near_distances", "0.001 to 1: nothing lies nearer, so counts stay the same", nearDistances, 0);

	Case scales = { "animation", "displacement_scales", "-3 to 3: counts stay the same" };
	scales.scene = [] {
		return parts::ball(3);
	};
	scales.expected = within("frames with other counts", 0);
	scales.options.cull = { false, false, false };
	scales.measure = measureScales;
	cases.push_back(scales);
}

}  // namespace tessera::verify
