// Largest, root mean square and 99th percentile of weighted values, and how far two such sets are apart.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace tessera::report
{

// Three digits, and none lost before the point: "0.0123", "4.57", "1751".
std::string threeDigits(double value);

struct Figures
{
	double max = 0, rms = 0, p99 = 0;

	bool operator==(const Figures&) const = default;
};

struct Weighted
{
	double value;   // >= 0
	double weight;  // >= 0
};

// All 0 when nothing has weight. p99: the least value that 99 % of the weight does not exceed. Reorders `values`.
Figures figuresOf(std::span<Weighted> values);

// Per figure the larger.
Figures largerOf(const Figures& a, const Figures& b);
Figures scaled(const Figures& figures, double factor);

// The largest relative difference of any figure, of the larger of the two (or of `least`, below which differences hardly count): 0..1.
double relativeChange(const Figures& a, const Figures& b, double least = 0);

}  // namespace tessera::report
