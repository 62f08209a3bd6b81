#include "report/image_error.h"

#include "base/check.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::report
{

namespace
{

struct Plane
{
	size_t width = 0, height = 0;
	std::vector<double> values;

	double at(size_t x, size_t y) const { return values[y * width + x]; }
};

Plane lumaOf(const Picture& picture)
{
	Plane plane = { picture.width, picture.height, {} };
	plane.values.resize(plane.width * plane.height);
	for (size_t i = 0; i < plane.values.size(); ++i)
		plane.values[i] = 0.299 * picture.rgba[4 * i] + 0.587 * picture.rgba[4 * i + 1] + 0.114 * picture.rgba[4 * i + 2];
	return plane;
}

// Normalised samples of a Gaussian of deviation 1.5; shorter where the picture is.
std::vector<double> window(size_t side)
{
	std::vector<double> weights(std::min<size_t>(side, 11));
	double sum = 0;
	for (size_t i = 0; i < weights.size(); ++i)
	{
		const double x = double(i) - double(weights.size() - 1) / 2;
		sum += weights[i] = std::exp(-x * x / (2 * 1.5 * 1.5));
	}
	for (double& weight : weights)
		weight /= sum;
	return weights;
}

// Weighted means where the window fits.
template <typename Value>
Plane filtered(size_t width, size_t height, const Value& value)
{
	const std::vector<double> across = window(width), down = window(height);
	Plane rows = { width - across.size() + 1, height, {} };
	rows.values.resize(rows.width * rows.height);
	parallelFor(height, [&](size_t y) {
		for (size_t x = 0; x < rows.width; ++x)
			for (size_t k = 0; k < across.size(); ++k)
				rows.values[y * rows.width + x] += across[k] * value(x + k, y);
	});
	Plane result = { rows.width, height - down.size() + 1, {} };
	result.values.resize(result.width * result.height);
	parallelFor(result.height, [&](size_t y) {
		for (size_t x = 0; x < result.width; ++x)
			for (size_t k = 0; k < down.size(); ++k)
				result.values[y * result.width + x] += down[k] * rows.at(x, y + k);
	});
	return result;
}

// Means over the picture of luminance times structure, and of contrast and structure alone.
struct Similarity
{
	double whole = 1, structure = 1;
};

Similarity similarity(const Plane& a, const Plane& b)
{
	constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
	const auto mean = [&](const auto& value) {
		return filtered(a.width, a.height, value);
	};
	const Plane mean_a = mean([&](size_t x, size_t y) { return a.at(x, y); });
	const Plane mean_b = mean([&](size_t x, size_t y) { return b.at(x, y); });
	const Plane mean_aa = mean([&](size_t x, size_t y) { return a.at(x, y) * a.at(x, y); });
	const Plane mean_bb = mean([&](size_t x, size_t y) { return b.at(x, y) * b.at(x, y); });
	const Plane mean_ab = mean([&](size_t x, size_t y) { return a.at(x, y) * b.at(x, y); });
	Similarity sum = { 0, 0 };
	for (size_t i = 0; i < mean_a.values.size(); ++i)
	{
		const double ma = mean_a.values[i], mb = mean_b.values[i];
		const double variance_a = mean_aa.values[i] - ma * ma, variance_b = mean_bb.values[i] - mb * mb;
		const double structure = (2 * (mean_ab.values[i] - ma * mb) + kC2) / (variance_a + variance_b + kC2);
		sum.structure += structure;
		sum.whole += structure * (2 * ma * mb + kC1) / (ma * ma + mb * mb + kC1);
	}
	const double count = double(mean_a.values.size());
	return { sum.whole / count, sum.structure / count };
}

// Means of 2 x 2 pixels; an odd last row or column is left out.
Plane halved(const Plane& plane)
{
	Plane half = { plane.width / 2, plane.height / 2, {} };
	half.values.resize(half.width * half.height);
	for (size_t y = 0; y < half.height; ++y)
		for (size_t x = 0; x < half.width; ++x)
			half.values[y * half.width + x] =
				(plane.at(2 * x, 2 * y) + plane.at(2 * x + 1, 2 * y) + plane.at(2 * x, 2 * y + 1) + plane.at(2 * x + 1, 2 * y + 1)) / 4;
	return half;
}

double multiScale(Plane a, Plane b, const Similarity& finest)
{
	constexpr std::array kWeights = { 0.0448, 0.2856, 0.3001, 0.2363, 0.1333 };
	double product = 1;
	Similarity here = finest;
	for (size_t scale = 0; scale < kWeights.size(); ++scale)
	{
		const bool last = scale + 1 == kWeights.size();
		// Structures that contradict each other have no real power: they count as unlike altogether.
		product *= std::pow(std::max(last ? here.whole : here.structure, 0.0), kWeights[scale]);
		if (last)
			break;
		a = halved(a);
		b = halved(b);
		here = similarity(a, b);
	}
	return product;
}

}  // namespace

ImageError compareImages(const Picture& picture, const Picture& reference)
{
	CHECK(picture.width == reference.width && picture.height == reference.height && picture.rgba.size() == reference.rgba.size() &&
			  picture.rgba.size() == size_t(picture.width) * picture.height * 4 && !picture.rgba.empty(),
		  "{}x{} against {}x{}", picture.width, picture.height, reference.width, reference.height);
	ImageError error;
	double squares = 0;
	const size_t pixels = picture.rgba.size() / 4;
	for (size_t i = 0; i < pixels; ++i)
	{
		double own = 0;
		for (size_t channel = 0; channel < 3; ++channel)
		{
			const double difference = double(picture.rgba[4 * i + channel]) - double(reference.rgba[4 * i + channel]);
			own += difference * difference;
		}
		squares += own;
		error.differing_pixels += own > 0 ? 1 : 0;
	}
	if (squares > 0)
		error.psnr_db = 10 * std::log10(255.0 * 255.0 * 3 * double(pixels) / squares);
	if (picture.covered.size() == pixels && reference.covered.size() == pixels)
		for (size_t i = 0; i < pixels; ++i)
		{
			error.silhouette_pixels += picture.covered[i] != reference.covered[i] ? 1 : 0;
			error.covered_pixels += reference.covered[i] ? 1 : 0;
		}
	const Plane a = lumaOf(picture), b = lumaOf(reference);
	const Similarity finest = similarity(a, b);
	error.ssim = finest.whole;
	if (std::min(picture.width, picture.height) >= 176)
		error.ms_ssim = multiScale(a, b, finest);
	return error;
}

}  // namespace tessera::report
