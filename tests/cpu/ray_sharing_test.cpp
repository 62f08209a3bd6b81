// Which instances may be traced through a structure that they share: the bound on what moving a ray into the mesh's space rounds, measured against
// the way devices are assumed to do it, and what follows from it for near, far, skewed and tessellated instances.
#include "reference_test_scenes.h"

#include "scene/ray_sharing.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <random>

namespace tessera::test
{

namespace
{

// --- a device's way of moving rays, in float ------------------------------------------------------------------------------------------

struct FloatMatrix
{
	vec3 columns[3];
	float at(int row, int column) const { return columns[column][row]; }
};

vec3 times(const FloatMatrix& m, vec3 v)
{
	vec3 result;
	for (int row = 0; row < 3; ++row)
		result[row] = (m.at(row, 0) * v.x + m.at(row, 1) * v.y) + m.at(row, 2) * v.z;
	return result;
}

float determinant(vec3 a, vec3 b, vec3 c)
{
	vec3 difference;
	for (int i = 0; i < 3; ++i)
	{
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		const float first = a[i] * (b[j] * c[k]), second = a[i] * (b[k] * c[j]);
		difference[i] = first - second;
	}
	return difference.x + (difference.y + difference.z);
}

float minorOf(const FloatMatrix& m, int row, int column)
{
	const int r0 = row == 0 ? 1 : 0, r1 = row == 2 ? 1 : 2, c0 = column == 0 ? 1 : 0, c1 = column == 2 ? 1 : 2;
	const float first = m.at(r0, c0) * m.at(r1, c1), second = m.at(r0, c1) * m.at(r1, c0);
	return first - second;
}

// The inverse of an instance's matrix, by cofactors; its last column from those of the whole matrix, or from the inverse of the other three.
struct Inverse
{
	FloatMatrix linear;
	vec3 translation;
};
Inverse inverseOf(const FloatMatrix& m, vec3 t, bool by_cofactors)
{
	const float scale = 1 / determinant(m.columns[0], m.columns[1], m.columns[2]);
	Inverse inverse;
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column)
			inverse.linear.columns[column][row] = ((row + column) % 2 == 0 ? 1.0f : -1.0f) * minorOf(m, column, row) * scale;
	if (by_cofactors)
		inverse.translation = vec3(-determinant(t, m.columns[1], m.columns[2]) * scale, -determinant(m.columns[0], t, m.columns[2]) * scale,
								   -determinant(m.columns[0], m.columns[1], t) * scale);
	else
		inverse.translation = -times(inverse.linear, t);
	return inverse;
}

dmat3 exact(const FloatMatrix& m)
{
	return dmat3(dvec3(m.columns[0]), dvec3(m.columns[1]), dvec3(m.columns[2]));
}

dvec3 across(dvec3 v, dvec3 direction)
{
	return v - direction * glm::dot(v, direction);
}

// How far apart a ray from the eye meets a vertex of the frame's structure and the same one of a shared structure, in any direction, over
// 2^-24 (distance + reach from the mesh's origin).
double measuredRounding(const FloatMatrix& m, vec3 t, vec3 p, bool by_cofactors)
{
	Placement placement = {};
	placement.row0 = vec3(m.at(0, 0), m.at(0, 1), m.at(0, 2));
	placement.row1 = vec3(m.at(1, 0), m.at(1, 1), m.at(1, 2));
	placement.row2 = vec3(m.at(2, 0), m.at(2, 1), m.at(2, 2));
	placement.translation = t;
	const dvec3 in_frame = dvec3(placed(placement, p)), turned = exact(m) * dvec3(p), vertex = turned + dvec3(t);
	const vec3 direction = vec3(glm::normalize(vertex));

	const Inverse inverse = inverseOf(m, t, by_cofactors);
	const vec3 moved_direction = times(inverse.linear, direction), from_origin = p - inverse.translation;
	const dvec3 seen = exact(m) * dvec3(from_origin), ray = exact(m) * dvec3(moved_direction);
	const double along = glm::dot(seen, ray) / glm::dot(ray, ray);
	const dvec3 unit = glm::normalize(dvec3(direction));
	const double sideways = glm::length((seen - ray * along) - across(in_frame, unit));
	const double lengthways = along * glm::length(dvec3(direction)) - glm::dot(in_frame, unit);
	return std::hypot(sideways, lengthways) / (0x1p-24 * (glm::length(vertex) + glm::length(turned)));
}

dvec3 randomDirection(std::mt19937_64& random)
{
	std::normal_distribution<double> normal;
	return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
}

dmat3 randomTurn(std::mt19937_64& random)
{
	const dvec3 x = randomDirection(random), y = glm::normalize(glm::cross(randomDirection(random), x));
	return dmat3(x, y, glm::cross(x, y));
}

Placement placementOfMatrix(const FloatMatrix& m)
{
	Placement placement = {};
	placement.row0 = vec3(m.at(0, 0), m.at(0, 1), m.at(0, 2));
	placement.row1 = vec3(m.at(1, 0), m.at(1, 1), m.at(1, 2));
	placement.row2 = vec3(m.at(2, 0), m.at(2, 1), m.at(2, 2));
	return placement;
}

// --- scenes -----------------------------------------------------------------------------------------------------------------------------

// A ball of radius 1 in its own space, placed by `world`.
ReferenceScene ballAt(const dmat4& world)
{
	ImportedScene scene = roundScene(3);
	scene.instances[0].world = world;
	return ReferenceScene(scene);
}

bool sharesFrom(const ReferenceScene& scene, const Camera& camera, const ViewRequest& asked, bool tessellates = false)
{
	const View view = viewOf(scene, camera, asked);
	return sharingMeshes(scene.built, view, raySharing(view, tessellates), { 1 })[0] == 1;
}

Camera lookingAtOrigin(double distance)
{
	return cameraAt(dvec3(0, 0, distance), dvec3(0));
}

}  // namespace

TEST(raySharing, movingARayIntoTheMeshRoundsLessThanTheBoundSays)
{
	std::mt19937_64 random(1);
	std::uniform_real_distribution<double> unit(0, 1);
	double most = 0, squares = 0;
	size_t tried = 0;
	for (int i = 0; i < 400'000; ++i)
	{
		// Turned, scaled along the mesh's axes, sometimes sheared; mirrored half of the time.
		dmat3 axes = randomTurn(random);
		for (int axis = 0; axis < 3; ++axis)
			axes[axis] *= std::exp2(4 * unit(random) - 2) * (unit(random) < 0.5 ? -1 : 1);
		if (i % 4 == 0)
			axes[0] += axes[1] * (0.6 * unit(random) - 0.3);
		FloatMatrix m;
		for (int axis = 0; axis < 3; ++axis)
			m.columns[axis] = vec3(axes[axis]);
		if (!isNearlyOrthogonal(placementOfMatrix(m)))
			continue;
		++tried;
		const double reach = std::exp2(12 * unit(random) - 10);
		const vec3 p = vec3(glm::inverse(axes) * (randomDirection(random) * reach)), t = vec3(randomDirection(random));
		if (glm::length(axes * dvec3(p) + dvec3(t)) < 1e-2)
			continue;
		const double by_cofactors = measuredRounding(m, t, p, true);
		most = std::max({ most, by_cofactors, measuredRounding(m, t, p, false) });
		squares += by_cofactors * by_cofactors;
	}
	EXPECT_GT(tried, 300'000u);
	EXPECT_LE(most, double(SHARING_ROUNDING) * 0x1p24);
	EXPECT_GE(most, double(SHARING_ROUNDING) * 0x1p24 / 2) << "the bound is looser than it need be";
	EXPECT_LE(std::sqrt(squares / double(tried)), most / 3) << "roundings are not independent";
	std::printf("largest %.2f, root of the mean square %.2f\n", most, std::sqrt(squares / double(tried)));
}

// Reach over distance at which pixels are 2^-9 of the rounding: worked out by hand for a picture of 1080 lines at 90 degrees.
TEST(raySharing, endsWhereTheRoundingReachesAPartOfAPixel)
{
	const ReferenceScene ball = ballAt(dmat4(1));
	ViewRequest asked = request(540, 0);
	asked.width_px = asked.height_px = 1080;
	// Corners of the picture: 1 + 1 + 1. 6 x 2^-24 x 540 x 3 (1 + reach / distance) <= 1 / 512: reach / distance <= 2.371.
	// The box's corner lies at sqrt(3), and its face 1 before the middle.
	const double distance = std::sqrt(3.0) / 2.371 + 1;
	EXPECT_TRUE(sharesFrom(ball, lookingAtOrigin(distance * 1.01), asked));
	EXPECT_FALSE(sharesFrom(ball, lookingAtOrigin(distance * 0.99), asked));
	// Four times the pixels: no distance is enough.
	asked.width_px = asked.height_px = 4320;
	EXPECT_FALSE(sharesFrom(ball, lookingAtOrigin(1e4), asked));
	// Few pixels: what light's rays start off the surface is the limit.
	asked.width_px = asked.height_px = 32;
	const double near = std::sqrt(3.0) / double(SHARING_MOST_REACH) + 1;
	EXPECT_TRUE(sharesFrom(ball, lookingAtOrigin(near * 1.01), asked));
	EXPECT_FALSE(sharesFrom(ball, lookingAtOrigin(near * 0.99), asked));
	EXPECT_FALSE(sharesFrom(ball, cameraAt(dvec3(0, 0, 0.2), dvec3(0, 0, 1)), asked)) << "from within";
}

TEST(raySharing, parallelViewsAskHowFarAllOfItIs)
{
	const ReferenceScene ball = ballAt(dmat4(1));
	Camera camera = lookingAtOrigin(20);
	camera.orthographic = true;
	camera.height_world = 3;
	ViewRequest asked = request(540, 0);
	asked.width_px = asked.height_px = 96;
	EXPECT_TRUE(sharesFrom(ball, camera, asked));
	camera.height_world = 0.003;
	EXPECT_FALSE(sharesFrom(ball, camera, asked)) << "pixels are a thousandth as large";
	camera = lookingAtOrigin(0.5);
	camera.orthographic = true;
	EXPECT_FALSE(sharesFrom(ball, camera, asked)) << "from within";
}

TEST(raySharing, skewedFlatAndFarOffMeshesDoNot)
{
	ViewRequest asked = request(540, 0);
	asked.width_px = asked.height_px = 96;
	const Camera camera = lookingAtOrigin(8);
	dmat4 skewed(1), flat(1);
	skewed[1] = dvec4(0.8, 1, 0, 0);
	flat[2] = dvec4(0);
	EXPECT_TRUE(sharesFrom(ballAt(glm::scale(dmat4(1), dvec3(-1, 2, 0.3))), camera, asked)) << "mirrored and scaled along its axes";
	EXPECT_FALSE(sharesFrom(ballAt(skewed), camera, asked));
	EXPECT_FALSE(sharesFrom(ballAt(flat), camera, asked));
	// Moved away from the mesh's origin in its own space, and back by the instance: the same place, larger numbers.
	ImportedScene far_off = roundScene(3);
	for (vec3& position : far_off.meshes[0].primitives[0].positions)
		position.x += 1000;
	far_off.instances[0].world = glm::translate(dmat4(1), dvec3(-1000, 0, 0));
	EXPECT_FALSE(sharesFrom(ReferenceScene(far_off), camera, asked));
}

// Whatever shares while something is tessellated has no factor above 1, of any of its clusters.
TEST(raySharing, whatSharesIsNotTessellated)
{
	const auto scene = builtinScene("instances:60");
	size_t sharing = 0, others = 0;
	for (const double rate : { 0.7, 2.0, 8.0 })
		for (uint32_t i = 0; i < 6; ++i)
		{
			Camera camera = framingCamera(scene->built);
			camera.eye = camera.target + (camera.eye - camera.target) * (0.3 + 0.4 * i);
			const View view = viewOf(*scene, camera, request(100, rate));
			const RaySharing rule = raySharing(view, true);
			std::vector<uint8_t> is_cut(scene->built.instances.size(), 0);
			for (const reference::ReferencePiece& part : classifyAll(*scene, view).parts)
				is_cut[part.cluster.instance] = 1;
			for (size_t instance = 0; instance < is_cut.size(); ++instance)
			{
				const Instance& placed_mesh = scene->built.instances[instance];
				const bool shares = mayShare(scene->built.mesh_bounds[placed_mesh.mesh], placementOf(placementRecord(placed_mesh), view), rule, view);
				EXPECT_FALSE(shares && is_cut[instance]) << "rate " << rate << ", camera " << i << ", instance " << instance;
				(shares ? sharing : others) += 1;
			}
		}
	EXPECT_GT(sharing, 100u);
	EXPECT_GT(others, 100u);
}

TEST(raySharing, meshesThatNoMaterialMovesAreKnown)
{
	const BuiltScene half = ReferenceScene(halfDisplacedScene()).built, plain = ReferenceScene(roundScene(2)).built;
	EXPECT_EQ(undisplacedMeshes(half), std::vector<uint8_t>{ 0 });
	EXPECT_EQ(undisplacedMeshes(plain), std::vector<uint8_t>{ 1 });
}

}  // namespace tessera::test
