#include "tables/generate/pattern_mesh.h"

#include "base/check.h"

namespace tessera::generate
{

static constexpr double kInfinity = std::numeric_limits<double>::infinity();
static constexpr std::array<LatticePoint, 6> kDirections = { { { 1, 0 }, { 0, 1 }, { -1, 1 }, { -1, 0 }, { 0, -1 }, { 1, -1 } } };

static double eighthPower(double x)
{
	const double x2 = x * x;
	const double x4 = x2 * x2;
	return x4 * x4;
}

PatternMesh::PatternMesh(uint32_t a, uint32_t b, uint32_t c) : triangle_left_of_(kMaxPoints * kMaxPoints, -1)
{
	addEdgePoints(a, b, c);
	clipEars(rimInOrder(a, b, c));
	flipAll();
}

void PatternMesh::addEdgePoints(uint32_t a, uint32_t b, uint32_t c)
{
	points_ = { { kBarycentricOne, 0 }, { 0, kBarycentricOne }, { 0, 0 } };
	for (uint32_t k = 1; k < a; k++)
		points_.push_back({ edgeCoordinate(a - k, a), kBarycentricOne - edgeCoordinate(a - k, a) });
	for (uint32_t k = 1; k < b; k++)
		points_.push_back({ 0, edgeCoordinate(b - k, b) });
	for (uint32_t k = 1; k < c; k++)
		points_.push_back({ edgeCoordinate(k, c), 0 });
	boundary_count_ = uint32_t(points_.size());
}

std::vector<uint8_t> PatternMesh::rimInOrder(uint32_t a, uint32_t b, uint32_t c) const
{
	std::vector<uint8_t> rim;
	uint8_t next = 3;
	const std::array<uint32_t, 3> segments = { a, b, c };
	for (uint8_t corner = 0; corner < 3; corner++)
	{
		rim.push_back(corner);
		for (uint32_t k = 1; k < segments[corner]; k++)
			rim.push_back(next++);
	}
	return rim;
}

// Cuts off the best ear again and again. The rest must keep an area, or it could not be cut into triangles.
void PatternMesh::clipEars(std::vector<uint8_t> rim)
{
	int64_t area_left = int64_t(kBarycentricOne) * kBarycentricOne;
	while (rim.size() >= 3)
	{
		size_t best = rim.size();
		double best_cost = kInfinity;
		for (size_t i = 0; i < rim.size(); i++)
		{
			const Triangle ear = { rim[(i + rim.size() - 1) % rim.size()], rim[i], rim[(i + 1) % rim.size()] };
			const bool rest_has_area = rim.size() == 3 || doubledArea(points_[ear[0]], points_[ear[1]], points_[ear[2]]) < area_left;
			if (rest_has_area && cost(ear) < best_cost)
			{
				best = i;
				best_cost = cost(ear);
			}
		}
		CHECK(best < rim.size(), "no ear among {} rim points", rim.size());
		const Triangle ear = { rim[(best + rim.size() - 1) % rim.size()], rim[best], rim[(best + 1) % rim.size()] };
		area_left -= doubledArea(points_[ear[0]], points_[ear[1]], points_[ear[2]]);
		setTriangle(uint32_t(triangles_.size()), ear);
		rim.erase(rim.begin() + std::ptrdiff_t(best));
	}
}

PatternMesh PatternMesh::uniformGrid(uint32_t n)
{
	PatternMesh mesh;
	mesh.triangle_left_of_.assign(kMaxPoints * kMaxPoints, -1);
	mesh.addEdgePoints(n, n, n);
	for (uint32_t i = 1; i + 1 < n; i++)
	{
		for (uint32_t j = 1; i + j < n; j++)
			mesh.points_.push_back({ edgeCoordinate(i, n), edgeCoordinate(j, n) });
	}
	// The point at (i, j) / n, whether it lies on the rim or inside.
	const auto at = [&](uint32_t i, uint32_t j) {
		const LatticePoint wanted = { edgeCoordinate(i, n), i + j == n ? kBarycentricOne - edgeCoordinate(i, n) : edgeCoordinate(j, n) };
		const auto found = std::find(mesh.points_.begin(), mesh.points_.end(), wanted);
		CHECK(found != mesh.points_.end(), "no grid point {}, {} of {}", i, j, n);
		return uint8_t(found - mesh.points_.begin());
	};
	for (uint32_t i = 0; i < n; i++)
	{
		for (uint32_t j = 0; i + j < n; j++)
		{
			mesh.setTriangle(uint32_t(mesh.triangles_.size()), { at(i, j), at(i + 1, j), at(i, j + 1) });
			if (i + j + 1 < n)
				mesh.setTriangle(uint32_t(mesh.triangles_.size()), { at(i + 1, j + 1), at(i, j + 1), at(i + 1, j) });
		}
	}
	return mesh;
}

double PatternMesh::cost(const Triangle& triangle) const
{
	return eighthPower(thinness(points_[triangle[0]], points_[triangle[1]], points_[triangle[2]]));
}

double PatternMesh::energy() const
{
	double sum = 0;
	for (const double one : costs_)
		sum += one;
	return sum;
}

uint32_t PatternMesh::worstTriangle() const
{
	return uint32_t(std::max_element(costs_.begin(), costs_.end()) - costs_.begin());
}

double PatternMesh::worstThinness() const
{
	const Triangle& worst = triangles_[worstTriangle()];
	return thinness(points_[worst[0]], points_[worst[1]], points_[worst[2]]);
}

void PatternMesh::setTriangle(uint32_t index, Triangle triangle)
{
	if (index == triangles_.size())
	{
		triangles_.emplace_back();
		costs_.emplace_back();
	}
	triangles_[index] = triangle;
	costs_[index] = cost(triangle);
	for (uint32_t side = 0; side < 3; side++)
		triangle_left_of_[triangle[side] * kMaxPoints + triangle[(side + 1) % 3]] = int16_t(index);
}

// Replaces the diagonal between two triangles when the other one has the lower cost.
bool PatternMesh::flipEdge(uint32_t triangle, uint32_t side)
{
	const uint8_t from = triangles_[triangle][side];
	const uint8_t to = triangles_[triangle][(side + 1) % 3];
	const uint8_t left = triangles_[triangle][(side + 2) % 3];
	const int16_t neighbour = triangle_left_of_[to * kMaxPoints + from];
	if (neighbour < 0)
		return false;
	const Triangle& other = triangles_[uint32_t(neighbour)];
	const auto is_opposite = [&](uint8_t point) {
		return point != from && point != to;
	};
	const uint8_t right = *std::find_if(other.begin(), other.end(), is_opposite);
	const Triangle first = { left, from, right };
	const Triangle second = { right, to, left };
	// A lower cost by less than rounding could flip back and forth.
	if (!(cost(first) + cost(second) < (costs_[triangle] + costs_[uint32_t(neighbour)]) * (1 - 1e-9)))
		return false;
	triangle_left_of_[from * kMaxPoints + to] = -1;
	triangle_left_of_[to * kMaxPoints + from] = -1;
	setTriangle(triangle, first);
	setTriangle(uint32_t(neighbour), second);
	return true;
}

void PatternMesh::flipAll()
{
	for (bool flipped = true; flipped;)
	{
		flipped = false;
		for (uint32_t triangle = 0; triangle < triangles_.size(); triangle++)
		{
			for (uint32_t side = 0; side < 3; side++)
				flipped |= flipEdge(triangle, side);
		}
	}
}

void PatternMesh::insert(LatticePoint point)
{
	CHECK(points_.size() < kMaxPoints, "a pattern has at most {} points", kMaxPoints);
	const auto holds_point = [&](const Triangle& t) {
		const LatticePoint p = points_[t[0]], q = points_[t[1]], r = points_[t[2]];
		return doubledArea(p, q, point) >= 0 && doubledArea(q, r, point) >= 0 && doubledArea(r, p, point) >= 0;
	};
	const auto found = std::find_if(triangles_.begin(), triangles_.end(), holds_point);
	CHECK(found != triangles_.end(), "point {}, {} is outside", point.u, point.v);
	const Triangle whole = *found;
	const uint32_t index = uint32_t(found - triangles_.begin());
	const uint8_t added = uint8_t(points_.size());
	points_.push_back(point);
	// A point on a side makes one triangle without area, which the flips remove.
	setTriangle(index, { whole[0], whole[1], added });
	setTriangle(uint32_t(triangles_.size()), { whole[1], whole[2], added });
	setTriangle(uint32_t(triangles_.size()), { whole[2], whole[0], added });
	flipAll();
}

bool PatternMesh::movePoint(uint8_t point, int32_t step)
{
	std::array<uint32_t, kMaxPoints> around;
	uint32_t around_count = 0;
	double best_cost = 0;
	for (uint32_t i = 0; i < triangles_.size(); i++)
	{
		const Triangle& triangle = triangles_[i];
		if (triangle[0] == point || triangle[1] == point || triangle[2] == point)
		{
			around[around_count++] = i;
			best_cost += costs_[i];
		}
	}
	best_cost *= 1 - 1e-9;
	const LatticePoint start = points_[point];
	LatticePoint best = start;
	for (const LatticePoint direction : kDirections)
	{
		points_[point] = { start.u + direction.u * step, start.v + direction.v * step };
		double sum = 0;
		for (uint32_t i = 0; i < around_count && sum < best_cost; i++)
			sum += cost(triangles_[around[i]]);
		if (sum < best_cost)
		{
			best_cost = sum;
			best = points_[point];
		}
	}
	points_[point] = best;
	if (best == start)
		return false;
	for (uint32_t i = 0; i < around_count; i++)
		costs_[around[i]] = cost(triangles_[around[i]]);
	return true;
}

void PatternMesh::relax(int32_t first_step, int32_t last_step, uint32_t sweeps)
{
	for (int32_t step = first_step; step >= last_step; step /= 2)
	{
		bool moved = true;
		for (uint32_t sweep = 0; sweep < sweeps && moved; sweep++)
		{
			moved = false;
			for (uint32_t point = boundary_count_; point < points_.size(); point++)
				moved |= movePoint(uint8_t(point), step);
			if (moved)
				flipAll();
		}
	}
}

}  // namespace tessera::generate
