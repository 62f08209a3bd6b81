// Factors, domain points and pattern order: what the shared headers decide, against answers computed by hand and by other means.
#include "reference_test_scenes.h"

#include "reference/double_surface.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera::test
{

namespace
{

using reference::Classified;

struct Random
{
	std::mt19937 bits{ 1 };

	uint32_t below(uint32_t n) { return static_cast<uint32_t>(std::uniform_int_distribution<uint64_t>(0, n - 1)(bits)); }
	float real(float low, float high) { return std::uniform_real_distribution<float>(low, high)(bits); }
	vec3 point(float size) { return vec3(real(-size, size), real(-size, size), real(-size, size)); }
	DomainPoint domain()
	{
		const uint32_t u = below(DOMAIN_SIZE + 1);
		return { u, below(DOMAIN_SIZE - u + 1) };
	}
};

bool same(DomainPoint a, DomainPoint b)
{
	return a.u == b.u && a.v == b.v;
}

// Corners of an equilateral triangle of side 1, or of a unit square, `height` below the eye at the origin's axis.
std::vector<vec3> equilateral()
{
	const float h = std::sqrt(3.0f) / 2;
	return { vec3(-0.5f, -h / 3, 0), vec3(0.5f, -h / 3, 0), vec3(0, 2 * h / 3, 0) };
}

std::vector<vec3> unitSquare()
{
	const vec3 a(-0.5f, -0.5f, 0), b(0.5f, -0.5f, 0), c(0.5f, 0.5f, 0), d(-0.5f, 0.5f, 0);
	return { a, b, c, a, c, d };
}

// On the axis, `distance` away from a point `radius` off it.
dvec3 eyeAt(double distance, double radius)
{
	return dvec3(0, 0, std::sqrt(distance * distance - radius * radius));
}

EdgeView edgeOf(float length_squared, float unit_squared, uint32_t limit)
{
	return { length_squared, unit_squared, limit };
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

// --- factors ---------------------------------------------------------------------------------------------------------------------

TEST(edgeFactor, sideOneFiveAwayAtFocal100AndRate4GetsFiveSegments)
{
	const ReferenceScene scene(triangleScene(equilateral()));
	const View view = viewOf(scene, cameraAt(eyeAt(5, 1 / std::sqrt(3.0)), dvec3(0)), request(100, 4));
	const Classified result = classifyAll(scene, view);

	ASSERT_EQ(result.parts.size(), 1u);
	const DomainPiece& piece = result.parts[0].piece;
	EXPECT_EQ((std::array{ piece.a, piece.b, piece.c }), (std::array{ 5u, 5u, 5u }));
	EXPECT_EQ(result.part_micro_triangles, 25u);
	EXPECT_EQ(result.levels(), 0u);
	EXPECT_TRUE(result.full_clusters.empty());
}

TEST(edgeFactor, unitSquareFiveAwayGetsFiveOnItsSidesAndSevenOnItsDiagonal)
{
	const ReferenceScene scene(triangleScene(unitSquare()));
	const View view = viewOf(scene, cameraAt(eyeAt(5, std::sqrt(0.5)), dvec3(0)), request(100, 4));
	const Classified result = classifyAll(scene, view);

	ASSERT_EQ(result.parts.size(), 2u);
	for (const reference::ReferencePiece& part : result.parts)
		EXPECT_EQ((std::array{ part.piece.a, part.piece.b, part.piece.c }), (std::array{ 7u, 5u, 5u }));
}

TEST(edgeFactor, scalingTheWorldChangesNothing)
{
	for (const double scale : { 1e-6, 1e-3, 7.0, 1e4, 1e8 })
	{
		const ReferenceScene scene(triangleScene(unitSquare(), dmat4(dmat3(scale))));
		Camera camera = cameraAt(eyeAt(5, std::sqrt(0.5)) * scale, dvec3(0));
		camera.near_world *= scale;
		const Classified result = classifyAll(scene, viewOf(scene, camera, request(100, 4)));
		ASSERT_EQ(result.parts.size(), 2u) << scale;
		EXPECT_EQ(result.parts[0].piece.a, 7u) << scale;
		EXPECT_EQ(result.parts[0].piece.c, 5u) << scale;
	}
}

TEST(edgeFactor, orthographicViewsCountPixelsOfTheFace)
{
	const ReferenceScene scene(triangleScene(unitSquare()));
	Camera camera = cameraAt(dvec3(0, 0, 50), dvec3(0));
	camera.orthographic = true;
	camera.height_world = 2;
	// 200 px show 2 units: a side has 100 px, 5 segments of 20 px; the diagonal 141 px.
	const Classified result = classifyAll(scene, viewOf(scene, camera, request(100, 20)));
	ASSERT_EQ(result.parts.size(), 2u);
	EXPECT_EQ(result.parts[0].piece.a, 7u);
	EXPECT_EQ(result.parts[0].piece.c, 5u);
}

TEST(edgeFactor, rateZeroAndTheCoarsestFrameLeaveEveryClusterFull)
{
	const auto scene = builtinScene("cube");
	ViewRequest none = request(500, 0), coarsest = request(500, 1);
	coarsest.every_factor_one = true;
	for (const ViewRequest& asked : { none, coarsest })
	{
		const Classified result = classifyAll(*scene, viewOf(*scene, framingCamera(scene->built), asked));
		EXPECT_TRUE(result.parts.empty());
		EXPECT_EQ(result.full_clusters.size(), scene->built.clusters.size());
		EXPECT_EQ(result.full_cluster_triangles, scene->built.triangles.size());
	}
}

TEST(edgeFactor, infiniteSegmentsGiveOneAndZeroSegmentsTheLimit)
{
	const FactorRule rule = { 11, 8 };
	EXPECT_EQ(edgeFactor(edgeOf(1, kInfinity, 1000), rule), 1u);
	EXPECT_EQ(edgePieces(edgeOf(1, kInfinity, 1000), rule), 1u);
	EXPECT_EQ(edgeFactor(edgeOf(0, 0, 7), rule), 7u);
	EXPECT_EQ(edgeFactor(edgeOf(1, 0, 11), rule), 11u);
	EXPECT_EQ(edgeFactor(edgeOf(1, 0, 12), rule), 0u);
	EXPECT_EQ(edgePieces(edgeOf(1, 0, 12), rule), 2u);
	EXPECT_EQ(edgePieces(edgeOf(1, 0, 1u << 20), rule), 8u);
}

TEST(edgeFactor, edgesShorterThanSixteenDomainUnitsGetOneSegmentWhateverTheRate)
{
	for (uint32_t length = 0; length <= 4096; ++length)
	{
		const EdgeView edge = viewEdge(vec3(0), vec3(1), length, 0, View{});
		ASSERT_EQ(edge.limit, length / 8);
		for (uint32_t c = 2; c <= 600; ++c)
			ASSERT_EQ(edgeHasAtLeast(c, edgeOf(1, 0, edge.limit)), c <= length / 8);
	}
}

TEST(edgeFactor, roundsAtTheHalfAndPiecesAreTheCeilingOfFactorOverTable)
{
	for (uint32_t table_size = 2; table_size <= 15; ++table_size)
		for (uint32_t max_split = 2; max_split <= table_size; ++max_split)
			for (uint32_t f = 1; f <= 200; ++f)
				for (const float fraction : { -0.5f, -0.25f, 0.0f, 0.25f, 0.4375f })
				{
					const float length = float(f) + fraction;
					const EdgeView edge = edgeOf(length * length, 1, 1000);
					const FactorRule rule = { table_size, max_split };
					ASSERT_EQ(edgeFactor(edge, rule), f <= table_size ? f : 0u) << f << " " << fraction;
					ASSERT_EQ(edgePieces(edge, rule), std::min((f + table_size - 1) / table_size, max_split));
				}
}

TEST(edgeFactor, isSymmetricInTheEndsBitForBit)
{
	Random random;
	View view = viewFrom(vec3(0), 0);
	view.rate_over_focal_squared = 1e-5f;
	for (int i = 0; i < 100000; ++i)
	{
		const vec3 p = random.point(2), q = random.point(2);
		const DomainPoint a = random.domain(), b = random.domain();
		ASSERT_EQ(domainLength(a, b), domainLength(b, a));
		const EdgeView forth = viewEdge(p, q, domainLength(a, b), 0, view), back = viewEdge(q, p, domainLength(b, a), 0, view);
		ASSERT_EQ(floatBitsToUint(forth.length_squared), floatBitsToUint(back.length_squared));
		ASSERT_EQ(floatBitsToUint(forth.unit_squared), floatBitsToUint(back.unit_squared));
	}
}

TEST(edgeFactor, agreesWithDoublePrecisionAwayFromTheHalves)
{
	uint64_t compared = 0, near_a_half = 0;
	for (const std::string_view name : { "cube", "materials", "instances:20" })
	{
		const auto scene = builtinScene(name);
		const View view = viewOf(*scene, framingCamera(scene->built), request(1000, 3));
		const reference::DoubleSurface exact(scene->host, view);
		const Classified result = classifyAll(*scene, view);
		const auto compare = [&](const reference::ReferencePiece& part, DomainPoint p, DomainPoint q, uint32_t factor) {
			const double real = exact.realFactor(part.cluster, part.piece.triangle, p, q);
			++compared;
			if (std::abs(real - std::floor(real) - 0.5) < 1e-5 * real)
				++near_a_half;
			else
				ASSERT_EQ(factor, std::max(1.0, std::floor(real + 0.5))) << name << ": " << describe(part);
		};
		for (const reference::ReferencePiece& part : result.parts)
		{
			compare(part, part.piece.c0, part.piece.c1, part.piece.a);
			compare(part, part.piece.c1, part.piece.c2, part.piece.b);
			compare(part, part.piece.c2, part.piece.c0, part.piece.c);
		}
	}
	EXPECT_GT(compared, 10000u);
	EXPECT_LT(near_a_half * 1000, compared);
}

// --- domain points ---------------------------------------------------------------------------------------------------------------

TEST(domain, pointsBetweenTwoInnerPointsAreTheSameFromBothEnds)
{
	Random random;
	for (int i = 0; i < 20000; ++i)
	{
		const DomainPoint p = random.domain(), q = random.domain();
		const uint32_t flags = random.below(8);
		for (uint32_t n = 1; n <= 11; ++n)
			for (uint32_t k = 0; k <= n; ++k)
			{
				const DomainPoint forth = edgePoint(p, q, k, n, flags);
				ASSERT_TRUE(same(forth, edgePoint(q, p, n - k, n, flags)));
				ASSERT_LE(uint64_t(forth.u) + forth.v, DOMAIN_SIZE);
				if (k == 0 || k == n)
				{
					ASSERT_TRUE(same(forth, k == 0 ? p : q));
				}
			}
	}
}

// The point of edge e at distance t from its lower-weld end, when that is its first corner or its second.
static DomainPoint onEdge(uint32_t edge, uint32_t t, bool from_first)
{
	const uint32_t second = from_first ? t : DOMAIN_SIZE - t, first = DOMAIN_SIZE - second;
	uint32_t weights[3] = { 0, 0, 0 };
	weights[edge] = first;
	weights[(edge + 1) % 3] = second;
	return { weights[0], weights[1] };
}

TEST(domain, pointsOfABaseEdgeAreTheSameInEveryRoleOfTheEdge)
{
	Random random;
	for (int i = 0; i < 5000; ++i)
	{
		const uint32_t a = random.below(DOMAIN_SIZE + 1), b = random.below(DOMAIN_SIZE + 1);
		for (uint32_t n = 1; n <= 11; ++n)
		{
			const uint32_t k = random.below(n + 1);
			const DomainPoint expected = edgePoint(onEdge(0, a, true), onEdge(0, b, true), k, n, 1);
			const uint32_t t = expected.v;
			for (uint32_t edge = 0; edge < 3; ++edge)
				for (const bool from_first : { false, true })
				{
					// Flags of the other two edges must not matter.
					const uint32_t others = random.below(8) & ~(1u << edge);
					const uint32_t flags = others | (from_first ? 1u << edge : 0u);
					const DomainPoint p = onEdge(edge, a, from_first), q = onEdge(edge, b, from_first);
					ASSERT_TRUE(same(edgePoint(p, q, k, n, flags), onEdge(edge, t, from_first))) << edge << from_first << " " << n << " " << k;
					ASSERT_TRUE(same(edgePoint(q, p, n - k, n, flags), onEdge(edge, t, from_first)));
				}
		}
	}
}

TEST(domain, recordsKeepEveryField)
{
	Random random;
	for (int i = 0; i < 100000; ++i)
	{
		const DomainPiece piece = { random.domain(),      random.domain(),      random.domain(),      random.below(1u << 24), random.below(128),
									1 + random.below(15), 1 + random.below(15), 1 + random.below(15), random.below(2) };
		const DomainPiece back = unpackTriangle(packTriangle(piece));
		ASSERT_TRUE(same(piece.c0, back.c0) && same(piece.c1, back.c1) && same(piece.c2, back.c2));
		ASSERT_EQ((std::array{ piece.visible_cluster, piece.triangle, piece.a, piece.b, piece.c, piece.mirror }),
				  (std::array{ back.visible_cluster, back.triangle, back.a, back.b, back.c, back.mirror }));
	}
}

// --- pattern order ---------------------------------------------------------------------------------------------------------------

TEST(patternOrder, sortsEveryTripleAndEachEdgeKeepsItsFactor)
{
	const DomainPoint corners[3] = { domainCorner(0), domainCorner(1), domainCorner(2) };
	for (uint32_t a = 1; a <= 11; ++a)
		for (uint32_t b = 1; b <= 11; ++b)
			for (uint32_t c = 1; c <= 11; ++c)
			{
				const DomainPiece turned = inPatternOrder({ corners[0], corners[1], corners[2], 5, 6, a, b, c, 0 });
				ASSERT_GE(turned.a, turned.b);
				ASSERT_GE(turned.b, turned.c);
				ASSERT_EQ(turned.visible_cluster, 5u);
				ASSERT_EQ(turned.triangle, 6u);
				const auto factorBetween = [&](DomainPoint p, DomainPoint q) {
					const auto is = [&](uint32_t i, uint32_t j) {
						return (same(p, corners[i]) && same(q, corners[j])) || (same(p, corners[j]) && same(q, corners[i]));
					};
					return is(0, 1) ? a : is(1, 2) ? b : is(2, 0) ? c : 0u;
				};
				ASSERT_EQ(factorBetween(turned.c0, turned.c1), turned.a);
				ASSERT_EQ(factorBetween(turned.c1, turned.c2), turned.b);
				ASSERT_EQ(factorBetween(turned.c2, turned.c0), turned.c);
				const auto cross = int64_t(turned.c1.u - int64_t(turned.c0.u)) * (turned.c2.v - int64_t(turned.c0.v)) -
								   int64_t(turned.c2.u - int64_t(turned.c0.u)) * (turned.c1.v - int64_t(turned.c0.v));
				ASSERT_EQ(cross < 0, turned.mirror == 1) << a << " " << b << " " << c;
			}
}

TEST(patternOrder, indexFollowsTheTable)
{
	const auto factors = configFactors(11);
	for (uint32_t i = 0; i < factors.size(); ++i)
		EXPECT_EQ(patternIndex(factors[i][0], factors[i][1], factors[i][2]), i);
}

}  // namespace tessera::test
