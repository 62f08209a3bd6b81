#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::report
{

std::string threeDigits(double value)
{
	return std::abs(value) >= 999.5 && std::abs(value) < 1e9 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

Figures figuresOf(std::span<Weighted> values)
{
	double weight = 0, squares = 0;
	Figures figures;
	for (const Weighted& v : values)
	{
		weight += v.weight;
		squares += v.weight * v.value * v.value;
		figures.max = v.weight > 0 ? std::max(figures.max, v.value) : figures.max;
	}
	if (!(weight > 0))
		return {};
	figures.rms = std::sqrt(squares / weight);
	std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
	double below = 0;
	for (const Weighted& v : values)
	{
		below += v.weight;
		figures.p99 = v.value;
		if (below >= 0.99 * weight)
			break;
	}
	return figures;
}

Figures largerOf(const Figures& a, const Figures& b)
{
	return { std::max(a.max, b.max), std::max(a.rms, b.rms), std::max(a.p99, b.p99) };
}

Figures scaled(const Figures& figures, double factor)
{
	return { figures.max * factor, figures.rms * factor, figures.p99 * factor };
}

namespace
{

double changeOf(double a, double b, double least)
{
	const double larger = std::max({ std::abs(a), std::abs(b), least });
	return larger > 0 ? std::abs(a - b) / larger : 0;
}

}  // namespace

double relativeChange(const Figures& a, const Figures& b, double least)
{
	return std::max({ changeOf(a.max, b.max, least), changeOf(a.rms, b.rms, least), changeOf(a.p99, b.p99, least) });
}

}  // namespace tessera::report
