// A pattern while it is being made: a triangulation of the triangle whose interior points move.
#pragma once
#include "tables/lattice.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tessera::generate
{

using Triangle = std::array<uint8_t, 3>;

// Every decision compares integers or sums, products and quotients of doubles, which IEEE arithmetic rounds alike everywhere:
// the same pattern comes out of every compiler and machine.
class PatternMesh
{
public:
	// Boundary points of pattern (a, b, c) in run-time order (3 corners, then the points of edges a, b, c), triangulated.
	PatternMesh(uint32_t a, uint32_t b, uint32_t c);

	// Pattern (n, n, n): the grid of n x n equal triangles.
	static PatternMesh uniformGrid(uint32_t n);

	const std::vector<LatticePoint>& points() const { return points_; }
	const std::vector<Triangle>& triangles() const { return triangles_; }
	uint32_t interiorCount() const { return uint32_t(points_.size()) - boundary_count_; }

	// Sum over the triangles of the eighth power of their thinness: nearly the worst triangle decides, the others break ties.
	double energy() const;
	// Thinness of the thinnest triangle.
	double worstThinness() const;
	// Index of the thinnest triangle.
	uint32_t worstTriangle() const;

	// Adds an interior point (inside the triangle, not on its rim, not an existing point) and restores the triangulation.
	void insert(LatticePoint point);
	// Moves interior points while that lowers the energy: steps of first_step, halved down to last_step lattice units,
	// at most `sweeps` rounds for each step.
	void relax(int32_t first_step, int32_t last_step, uint32_t sweeps);

private:
	PatternMesh() = default;
	double cost(const Triangle& triangle) const;
	void addEdgePoints(uint32_t a, uint32_t b, uint32_t c);
	std::vector<uint8_t> rimInOrder(uint32_t a, uint32_t b, uint32_t c) const;
	void clipEars(std::vector<uint8_t> rim);
	void setTriangle(uint32_t index, Triangle triangle);
	bool flipEdge(uint32_t triangle, uint32_t side);
	void flipAll();
	bool movePoint(uint8_t point, int32_t step);

	static constexpr uint32_t kMaxPoints = 128;
	std::vector<LatticePoint> points_;
	std::vector<Triangle> triangles_;
	std::vector<double> costs_;              // of each triangle
	std::vector<int16_t> triangle_left_of_;  // [from * kMaxPoints + to]: the triangle with that directed side, or -1
	uint32_t boundary_count_ = 0;
};

}  // namespace tessera::generate
