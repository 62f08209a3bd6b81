#include "build_test_scenes.h"

#include "scene/build/height_map.h"

#include <cstring>
#include <numbers>
#include <random>

namespace tessera::test
{

namespace
{

constexpr double kPi = std::numbers::pi;

void storeTexel(Image& image, size_t texel, double value)
{
	const auto store = [&](auto number) {
		std::memcpy(image.texels.data() + texel * sizeof number, &number, sizeof number);
	};
	if (image.format == TexelFormat::U8)
		store(uint8_t(value));
	else if (image.format == TexelFormat::U16)
		store(uint16_t(value));
	else
		store(float(value));
}

Image emptyImage(uint32_t width, uint32_t height, TexelFormat format)
{
	Image image;
	image.name = "image";
	image.width = width;
	image.height = height;
	image.channels = 1;
	image.format = format;
	image.texels.resize(size_t(width) * height * (format == TexelFormat::U8 ? 1 : format == TexelFormat::U16 ? 2 : 4));
	return image;
}

// An n x n grid of quads over origin + s x + t y, texture coordinates from uv0 to uv1.
void addGrid(Primitive& primitive, vec3 origin, vec3 x, vec3 y, vec2 uv0, vec2 uv1, uint32_t n, bool turned = false)
{
	const auto first = uint32_t(primitive.positions.size());
	const vec3 normal = glm::normalize(glm::cross(x, y)) * (turned ? -1.0f : 1.0f);
	for (uint32_t j = 0; j <= n; ++j)
		for (uint32_t i = 0; i <= n; ++i)
		{
			const float s = float(i) / float(n), t = float(j) / float(n);
			const vec3 p = origin + x * s + y * t;
			addVertex(primitive, p, normal, vec2(uv0.x + (uv1.x - uv0.x) * s, uv0.y + (uv1.y - uv0.y) * t));
		}
	for (uint32_t j = 0; j < n; ++j)
		for (uint32_t i = 0; i < n; ++i)
		{
			const uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
			addTriangle(primitive, a, turned ? d : b, turned ? b : d);
			addTriangle(primitive, a, turned ? c : d, turned ? d : c);
		}
}

}  // namespace

Image noiseImage(uint32_t width, uint32_t height, TexelFormat format, uint32_t seed)
{
	Image image = emptyImage(width, height, format);
	std::mt19937 random(seed);
	for (size_t i = 0; i < size_t(width) * height; ++i)
	{
		const double fraction = double(random()) / 4294967296.0;
		storeTexel(image, i, format == TexelFormat::U8 ? fraction * 256 : format == TexelFormat::U16 ? fraction * 65536 : fraction * 3 - 1);
	}
	return image;
}

Image constantImage(uint32_t width, uint32_t height, TexelFormat format, double value)
{
	Image image = emptyImage(width, height, format);
	for (size_t i = 0; i < size_t(width) * height; ++i)
		storeTexel(image, i, value);
	return image;
}

uint32_t addDisplaced(ImportedScene& scene, Image image, float factor, float offset, Wrap wrap)
{
	Texture texture;
	texture.image = uint32_t(scene.images.size());
	texture.wrap_u = texture.wrap_v = wrap;
	Displacement displacement;
	displacement.height.texture = uint32_t(scene.textures.size());
	displacement.factor = factor;
	displacement.offset = offset;
	scene.images.push_back(std::move(image));
	scene.textures.push_back(texture);
	Material material;
	material.name = "displaced " + std::to_string(scene.materials.size());
	material.displacement = displacement;
	scene.materials.push_back(material);
	return uint32_t(scene.materials.size() - 1);
}

uint32_t addPlain(ImportedScene& scene, std::string name)
{
	Material material;
	material.name = std::move(name);
	scene.materials.push_back(material);
	return uint32_t(scene.materials.size() - 1);
}

void addPlacedMesh(ImportedScene& scene, std::vector<Primitive> primitives)
{
	Mesh mesh;
	mesh.name = "mesh";
	mesh.primitives = std::move(primitives);
	Instance instance;
	instance.mesh = uint32_t(scene.meshes.size());
	scene.meshes.push_back(std::move(mesh));
	scene.instances.push_back(instance);
	scene.path = "test.gltf";
}

void addVertex(Primitive& primitive, vec3 position, vec3 normal, vec2 uv)
{
	primitive.texcoords.resize(1);
	primitive.positions.push_back(position + vec3(0.0f));  // makes negative zeros positive, as the importer does
	primitive.normals.push_back(normal);
	primitive.texcoords[0].push_back(uv);
}

void addTriangle(Primitive& primitive, uint32_t a, uint32_t b, uint32_t c)
{
	primitive.indices.insert(primitive.indices.end(), { a, b, c });
}

ImportedScene cubeScene(uint32_t side_quads)
{
	ImportedScene scene;
	Primitive cube;
	cube.material = addDisplaced(scene, noiseImage(61, 47, TexelFormat::U16, 1), 0.2f, -0.05f);
	const vec3 axes[3] = { vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 2) };
	for (int axis = 0; axis < 3; ++axis)
	{
		const vec3 x = axes[(axis + 1) % 3], y = axes[(axis + 2) % 3];
		addGrid(cube, vec3(-1) + axes[axis], x, y, vec2(0.1f, 0.2f), vec2(1.3f, 0.9f), side_quads);
		addGrid(cube, vec3(-1), y, x, vec2(0), vec2(0.7f), side_quads);
	}
	addPlacedMesh(scene, { cube });
	return scene;
}

ImportedScene sphereScene(uint32_t rings, uint32_t sectors, TexelFormat format, Wrap wrap)
{
	ImportedScene scene;
	Primitive sphere;
	sphere.material = addDisplaced(scene, noiseImage(64, 33, format, 2), 0.15f, 0.02f, wrap);
	for (uint32_t j = 0; j <= rings; ++j)
		for (uint32_t i = 0; i <= sectors; ++i)
		{
			// The last column repeats the first to the bit; the poles are one point.
			const double longitude = 2 * kPi * (i % sectors) / sectors, latitude = kPi * j / rings;
			const double radius = j == 0 || j == rings ? 0 : std::sin(latitude);
			const vec3 p(float(radius * std::cos(longitude)), float(radius * std::sin(longitude)), float(std::cos(latitude)));
			addVertex(sphere, p, glm::normalize(p), vec2(float(i) / float(sectors), float(j) / float(rings)));
		}
	for (uint32_t j = 0; j < rings; ++j)
		for (uint32_t i = 0; i < sectors; ++i)
		{
			const uint32_t a = j * (sectors + 1) + i, b = a + 1, c = a + sectors + 1, d = c + 1;
			if (j > 0)
				addTriangle(sphere, a, c, b);
			if (j + 1 < rings)
				addTriangle(sphere, b, c, d);
		}
	addPlacedMesh(scene, { sphere });
	return scene;
}

ImportedScene twoMapsScene()
{
	ImportedScene scene;
	Primitive left, right;
	left.material = addDisplaced(scene, noiseImage(37, 64, TexelFormat::U8, 3), 0.3f, 0.1f, Wrap::ClampToEdge);
	right.material = addDisplaced(scene, noiseImage(16, 16, TexelFormat::F32, 4), -0.2f, 0, Wrap::MirroredRepeat);
	addGrid(left, vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0), vec2(1), 3);
	addGrid(right, vec3(0, 0, 0), vec3(1, 0, 0.3f), vec3(0, 1, 0), vec2(-1.5f), vec2(2), 3);
	addPlacedMesh(scene, { left, right });
	return scene;
}

ImportedScene halfDisplacedScene()
{
	ImportedScene scene;
	Primitive plain, displaced, plain_again;
	plain.material = plain_again.material = addPlain(scene, "plain");
	displaced.material = addDisplaced(scene, noiseImage(32, 32, TexelFormat::U8, 5), 0.3f, 0.5f);
	addGrid(plain, vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0), vec2(1), 2);
	addGrid(displaced, vec3(0, 0, 0), vec3(1, 0, 0.5f), vec3(0, 1, 0), vec2(0), vec2(1), 2);
	addGrid(plain_again, vec3(1, 0, 0.5f), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0), vec2(1), 2);
	addPlacedMesh(scene, { plain, displaced, plain_again });
	return scene;
}

ImportedScene nonManifoldScene()
{
	ImportedScene scene;
	Primitive sheets;
	sheets.material = addDisplaced(scene, noiseImage(32, 32, TexelFormat::U16, 6), 0.2f, 0);
	for (uint32_t i = 0; i < 5; ++i)
	{
		const float angle = float(i) * 1.1f;
		const vec3 out(std::cos(angle), std::sin(angle), 0);
		const vec2 uv(0.13f * float(i), 0.07f);
		if (i % 2)
			addGrid(sheets, vec3(0), out, vec3(0, 0, 1), uv, uv + vec2(0.4f, 0.6f), 2);
		else
			addGrid(sheets, vec3(0), vec3(0, 0, 1), out, uv, uv + vec2(0.4f, 0.6f), 2);
	}
	addPlacedMesh(scene, { sheets });
	return scene;
}

ImportedScene mirroredScene()
{
	ImportedScene scene;
	Primitive both;
	both.material = addDisplaced(scene, noiseImage(40, 24, TexelFormat::U8, 7), 0.2f, 0, Wrap::MirroredRepeat);
	addGrid(both, vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0.3f, 0), vec2(1, 1), 3);
	addGrid(both, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(1, 0), vec2(0.3f, 1), 3, true);
	addPlacedMesh(scene, { both });
	return scene;
}

ImportedScene degenerateScene()
{
	ImportedScene scene;
	Primitive p;
	p.material = addDisplaced(scene, noiseImage(32, 32, TexelFormat::U8, 8), 0.2f, 0.1f);
	const vec3 up(0, 0, 1);
	addVertex(p, vec3(0, 0, 0), up, vec2(0, 0));
	addVertex(p, vec3(1, 0, 0), up, vec2(1, 0));
	addVertex(p, vec3(0, 1, 0), up, vec2(0, 1));
	addVertex(p, vec3(1, 0, 0), vec3(1, 0, 0), vec2(0.4f, 0.3f));  // the second point again, other attributes
	addVertex(p, vec3(0.5f, 0.5f, 0), up, vec2(0.9f, 0.1f));       // on the edge from the second point to the third
	addVertex(p, vec3(1, 1, 0), up, vec2(1, 1));
	addTriangle(p, 1, 2, 0);
	addTriangle(p, 1, 3, 2);  // two corners at one point
	addTriangle(p, 2, 4, 3);  // three points on a line
	addTriangle(p, 3, 5, 2);
	addTriangle(p, 3, 5, 2);  // the same twice
	addPlacedMesh(scene, { p });
	return scene;
}

ImportedScene touchingConesScene()
{
	ImportedScene scene;
	Primitive cones;
	cones.material = addDisplaced(scene, noiseImage(32, 32, TexelFormat::U8, 9), 0.2f, 0);
	addVertex(cones, vec3(0), vec3(0, 0, 1), vec2(0.5f));
	addVertex(cones, vec3(0), vec3(0, 0, -1), vec2(0.5f));
	for (uint32_t side = 0; side < 2; ++side)
		for (uint32_t i = 0; i < 6; ++i)
		{
			const float angle = float(i) * float(kPi) / 3, z = side ? 1.0f : -1.0f;
			addVertex(cones, vec3(std::cos(angle), std::sin(angle), z), vec3(0, 0, -z), vec2(float(i) / 6, z));
		}
	for (uint32_t side = 0; side < 2; ++side)
		for (uint32_t i = 0; i < 6; ++i)
			addTriangle(cones, side, 2 + side * 6 + i, 2 + side * 6 + (i + 1) % 6);
	addPlacedMesh(scene, { cones });
	return scene;
}

ImportedScene transformedScene()
{
	ImportedScene scene;
	Primitive left, right;
	left.material = addDisplaced(scene, noiseImage(33, 21, TexelFormat::U16, 10), 0.3f, 0);
	right.material = addDisplaced(scene, noiseImage(1, 1, TexelFormat::U8, 11), 0.3f, 0);
	Displacement& turned = *scene.materials[right.material].displacement;
	turned.height.texture = 0;
	turned.height.row0 = dvec3(0.7, -0.4, 0.2);
	turned.height.row1 = dvec3(0.4, 0.7, -0.1);
	addGrid(left, vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0), vec2(1), 2);
	addGrid(right, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0), vec2(1), 2);
	addPlacedMesh(scene, { left, right });
	return scene;
}

ImportedScene coarseSphereScene()
{
	ImportedScene scene;
	Primitive p;
	p.material = addDisplaced(scene, constantImage(4, 4, TexelFormat::U8, 255), 1.5f, 0);
	for (int i = 0; i < 6; ++i)
	{
		vec3 point(0);
		point[i / 2] = i % 2 ? -1.0f : 1.0f;
		addVertex(p, point, point, vec2(0.3f * float(i), 0.2f));
	}
	for (uint32_t octant = 0; octant < 8; ++octant)
	{
		const uint32_t x = octant & 1, y = 2 + (octant >> 1 & 1), z = 4 + (octant >> 2 & 1);
		const bool odd = std::popcount(octant) % 2 != 0;
		addTriangle(p, x, odd ? z : y, odd ? y : z);
	}
	addPlacedMesh(scene, { p });
	return scene;
}

ImportedScene roundScene(uint32_t cuts)
{
	ImportedScene scene;
	Primitive p;
	p.material = addPlain(scene, "plain");
	const auto addPoint = [&](vec3 at) {
		const vec3 point = glm::normalize(at);
		addVertex(p, point, point, vec2(0));
	};
	for (uint32_t octant = 0; octant < 8; ++octant)
	{
		const vec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
		const bool odd = std::popcount(octant) % 2 != 0;
		const auto first = uint32_t(p.positions.size());
		for (uint32_t row = 0; row <= cuts; ++row)
			for (uint32_t column = 0; column + row <= cuts; ++column)
				addPoint(sign * vec3(float(cuts - row - column), float(column), float(row)));
		const auto vertex = [&](uint32_t row, uint32_t column) {
			return first + row * (cuts + 1) - row * (row - 1) / 2 + column;
		};
		const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
			addTriangle(p, a, odd ? c : b, odd ? b : c);
		};
		for (uint32_t row = 0; row < cuts; ++row)
			for (uint32_t column = 0; column + row < cuts; ++column)
			{
				add(vertex(row, column), vertex(row, column + 1), vertex(row + 1, column));
				if (column + row + 1 < cuts)
					add(vertex(row, column + 1), vertex(row + 1, column + 1), vertex(row + 1, column));
			}
	}
	addPlacedMesh(scene, { p });
	return scene;
}

ImportedScene needleScene(uint32_t number)
{
	const double thin = std::pow(10, -1 - (number % 11) / 2.0), tip = 1.4 * (number % 7) / 6.0 - 0.2;
	ImportedScene imported;
	Primitive primitive;
	primitive.material = addDisplaced(imported, noiseImage(64, 64, TexelFormat::U8, number), 0.02f, 0);
	for (const vec3 corner : { vec3(0), vec3(1, 0, 0), vec3(float(tip), float(thin), 0) })
		addVertex(primitive, corner, vec3(0, 0, 1), vec2(corner));
	addTriangle(primitive, 0, 1, 2);
	addPlacedMesh(imported, { primitive });
	return imported;
}

ImportedScene soupScene(uint32_t seed, uint32_t triangles)
{
	ImportedScene scene;
	std::mt19937 random(seed);
	const auto unit = [&] {
		return float(random() % 1000) / 1000;
	};
	std::vector<Primitive> primitives(4);
	for (Primitive& primitive : primitives)
		primitive.material = uint32_t(scene.materials.size()) == 2
								 ? addPlain(scene, "plain")
								 : addDisplaced(scene, noiseImage(17, 9, TexelFormat::U16, seed), 0.3f, unit() - 0.5f);
	for (uint32_t i = 0; i < 3 * triangles; ++i)
	{
		Primitive& primitive = primitives[i / 3 % primitives.size()];
		const vec3 point(float(random() % 3), float(random() % 2), float(random() % 2));
		// Few different normals and coordinates, so that some agree.
		const vec3 normal = random() % 5 == 0 ? vec3(0) : random() % 2 ? vec3(0, 0, 1) : glm::normalize(vec3(unit(), unit(), unit() + 0.01f));
		addVertex(primitive, point, normal, random() % 2 ? vec2(point) : vec2(unit(), unit()) * 3.0f);
		primitive.indices.push_back(uint32_t(primitive.indices.size()));
	}
	primitives[1].normals.clear();
	addPlacedMesh(scene, std::move(primitives));
	return scene;
}

std::vector<NamedScene> allScenes()
{
	return {
		{ "cube", cubeScene(2) },
		{ "sphere", sphereScene(12, 24, TexelFormat::U16, Wrap::Repeat) },
		{ "float sphere, mirrored wrap", sphereScene(7, 9, TexelFormat::F32, Wrap::MirroredRepeat) },
		{ "two maps", twoMapsScene() },
		{ "half displaced", halfDisplacedScene() },
		{ "non-manifold", nonManifoldScene() },
		{ "mirrored coordinates", mirroredScene() },
		{ "degenerate triangles", degenerateScene() },
		{ "touching cones", touchingConesScene() },
		{ "texture transforms", transformedScene() },
		{ "octahedron", coarseSphereScene() },
		{ "soup", soupScene(1, 40) },
		{ "thin soup", soupScene(2, 12) },
	};
}

HostSurface::HostSurface(const BuiltScene& scene)
{
	for (const HeightMapData& map : scene.height_maps)
		height_maps.push_back(hostRecord(map));
	no_seam_edges.assign(scene.triangles.size(), 0);
	no_seam_corners.assign(scene.positions.size(), NO_INDEX);
	const auto address = [](const auto& array) {
		return reinterpret_cast<uint64_t>(array.data());
	};
	surface.positions = address(scene.positions);
	surface.directions = address(scene.directions);
	surface.uvs = address(scene.uvs);
	surface.densities = address(scene.densities);
	surface.triangles = address(scene.triangles);
	surface.first_seam_edges = address(scene.first_seam_edges.empty() ? no_seam_edges : scene.first_seam_edges);
	surface.seam_edges = address(scene.seam_edges);
	surface.seam_corner_indices = address(scene.seam_corner_indices.empty() ? no_seam_corners : scene.seam_corner_indices);
	surface.seam_corners = address(scene.seam_corners);
	surface.material_height_maps = address(scene.material_height_maps);
	surface.height_maps = address(height_maps);
	surface.pn_directions = scene.traits.has_pn ? surface.directions : 0;
}

View viewFrom(vec3 eye, float sample_over_focal)
{
	View view = {};
	view.eye_high = eye;
	view.right = vec3(1, 0, 0);
	view.up = vec3(0, 1, 0);
	view.forward = vec3(0, 0, -1);
	view.unit = 1;
	view.inverse_unit_squared = 1;
	view.near = 1e-3f;
	view.distance_weight = 1;
	view.distance_floor_squared = view.near * view.near;
	view.sample_over_focal_squared = sample_over_focal * sample_over_focal;
	view.displacement_scale = 1;
	return view;
}

Placement placementFor(const View& view)
{
	InstanceRecord instance = {};
	instance.row0 = vec3(1, 0, 0);
	instance.row1 = vec3(0, 1, 0);
	instance.row2 = vec3(0, 0, 1);
	instance.inverse_scale_squared = 1;
	return placementOf(instance, view);
}

}  // namespace tessera::test
