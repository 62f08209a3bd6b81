#include "tables/generate/pattern_search.h"

#include "base/check.h"

#include <cmath>

namespace tessera::generate
{

// Sixteen times the squared area of the triangle with sides a, b, c (Heron); negative when there is no such triangle.
static int64_t sixteenSquaredAreas(int64_t a, int64_t b, int64_t c)
{
	return (a + b + c) * (a + b - c) * (a - b + c) * (-a + b + c);
}

InteriorRange interiorRange(uint32_t a, uint32_t b, uint32_t c)
{
	const uint32_t rim_triangles = a + b + c - 2;  // every interior point adds two
	if (a == b && b == c)
		return { (a - 1) * (a - 2) / 2, (a - 1) * (a - 2) / 2 };

	// Least: unit triangles in the flat triangle whose sides are a, b, c long: every edge is cut at the same length there. Up to eight
	// points are rounded up, since a missing one empties the middle; more are rounded down, which pays for stretched patterns.
	const int64_t squared = std::max<int64_t>(0, sixteenSquaredAreas(a, b, c));
	const double even = std::sqrt(double(squared) / 3);  // area over the area of the unit triangle, sqrt(3) / 4
	const double least = std::max(0.0, (even - rim_triangles) / 2);
	// Most: the mean density over the three corners, each with the density of its two edges.
	const double mean = double(a * b + b * c + c * a) / 3;
	const double most = std::max(0.0, (mean - rim_triangles) / 2 + 0.5);

	InteriorRange range;
	range.least = uint32_t(least <= 8 ? std::ceil(least) : std::floor(least));
	range.most = std::max(range.least, uint32_t(most));
	return range;
}

// Segment length wanted at a point: that of the edges, the nearer the more. In lattice units.
static double wantedLength(LatticePoint p, const std::array<uint32_t, 3>& factors)
{
	const std::array<double, 3> distances = { double(p.w()), double(p.u), double(p.v) };  // to edges a, b, c
	double weighted = 0;
	double weights = 0;
	for (uint32_t edge = 0; edge < 3; edge++)
	{
		weighted += kBarycentricOne / (factors[edge] * distances[edge]);
		weights += 1 / distances[edge];
	}
	return weighted / weights;
}

// The point farthest from all others, measured in the segment length wanted there.
static LatticePoint emptiestPlace(const PatternMesh& mesh, const std::array<uint32_t, 3>& factors)
{
	constexpr int32_t kCells = 40;
	constexpr int32_t kCell = kBarycentricOne / kCells;
	LatticePoint best;
	double best_distance = -1;
	for (int32_t i = 1; i < kCells; i++)
	{
		for (int32_t j = 1; i + j < kCells; j++)
		{
			const LatticePoint p = { i * kCell, j * kCell };
			const int64_t to_edges = std::min({ p.u, p.v, p.w() });
			int64_t nearest = to_edges * to_edges;
			for (const LatticePoint other : mesh.points())
				nearest = std::min(nearest, squaredDistance(p, other));
			const double wanted = wantedLength(p, factors);
			const double distance = double(nearest) / (wanted * wanted);
			if (distance > best_distance)
			{
				best_distance = distance;
				best = p;
			}
		}
	}
	return best;
}

static LatticePoint between(LatticePoint p, LatticePoint q, LatticePoint r)
{
	return { (p.u + q.u + r.u) / 3, (p.v + q.v + r.v) / 3 };
}

static bool isInside(LatticePoint p)
{
	return p.u > 0 && p.v > 0 && p.w() > 0;
}

// Places worth trying for one more point: where it is emptiest, and in and around the thinnest triangle.
static std::vector<LatticePoint> placesToTry(const PatternMesh& mesh, const std::array<uint32_t, 3>& factors)
{
	std::vector<LatticePoint> places = { emptiestPlace(mesh, factors) };
	const Triangle& worst = mesh.triangles()[mesh.worstTriangle()];
	const std::array<LatticePoint, 3> p = { mesh.points()[worst[0]], mesh.points()[worst[1]], mesh.points()[worst[2]] };
	places.push_back(between(p[0], p[1], p[2]));
	for (uint32_t side = 0; side < 3; side++)
		places.push_back({ (p[side].u + p[(side + 1) % 3].u) / 2, (p[side].v + p[(side + 1) % 3].v) / 2 });
	const auto unusable = [&](LatticePoint place) {
		return !isInside(place) || std::find(mesh.points().begin(), mesh.points().end(), place) != mesh.points().end();
	};
	std::erase_if(places, unusable);
	return places;
}

static PatternMesh withOneMorePoint(const PatternMesh& mesh, const std::array<uint32_t, 3>& factors)
{
	PatternMesh best = mesh;
	double best_energy = std::numeric_limits<double>::infinity();
	for (const LatticePoint place : placesToTry(mesh, factors))
	{
		PatternMesh candidate = mesh;
		candidate.insert(place);
		candidate.relax(1024, 128, 2);
		if (candidate.energy() < best_energy)
		{
			best_energy = candidate.energy();
			best = candidate;
		}
	}
	best.relax(512, 8, 4);
	return best;
}

std::vector<PatternMesh> searchPatterns(uint32_t a, uint32_t b, uint32_t c, InteriorRange range)
{
	if (a == b && b == c)
		return { PatternMesh::uniformGrid(a) };
	std::vector<PatternMesh> found;
	PatternMesh mesh(a, b, c);
	for (uint32_t interior = 0;; interior++)
	{
		if (interior >= range.least)
			found.push_back(mesh);
		if (interior == range.most)
			return found;
		mesh = withOneMorePoint(mesh, { a, b, c });
	}
}

// Sine of the smallest angle, from the square root alone, which every machine rounds alike.
static double smallestSine(const PatternMesh& mesh)
{
	const double cotangent = mesh.worstThinness() / std::sqrt(3.0);
	return 1 / std::sqrt(1 + cotangent * cotangent);
}

std::vector<uint32_t> spendTriangles(std::span<const std::vector<PatternMesh>> patterns, uint32_t triangle_budget)
{
	std::vector<std::vector<double>> sines(patterns.size());
	std::vector<uint32_t> chosen(patterns.size(), 0);
	size_t spent = 0;
	for (size_t i = 0; i < patterns.size(); i++)
	{
		for (const PatternMesh& mesh : patterns[i])
			sines[i].push_back(smallestSine(mesh));
		spent += patterns[i].front().triangles().size();
	}
	CHECK(spent <= triangle_budget, "{} triangles at least, {} allowed", spent, triangle_budget);

	// Take the step that gains most per interior point, steps of several points included, while the budget lasts.
	for (;;)
	{
		size_t best = patterns.size();
		uint32_t best_choice = 0;
		double best_gain = 0;
		for (size_t i = 0; i < patterns.size(); i++)
		{
			for (uint32_t choice = chosen[i] + 1; choice < sines[i].size() && spent + 2 * (choice - chosen[i]) <= triangle_budget; choice++)
			{
				const double gain = (sines[i][choice] - sines[i][chosen[i]]) / (choice - chosen[i]);
				if (gain > best_gain)
				{
					best = i;
					best_choice = choice;
					best_gain = gain;
				}
			}
		}
		if (best == patterns.size())
			return chosen;
		spent += 2 * (best_choice - chosen[best]);
		chosen[best] = best_choice;
	}
}

}  // namespace tessera::generate
