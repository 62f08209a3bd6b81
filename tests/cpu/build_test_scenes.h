// Small scenes with every kind of seam, made in code, and the means to evaluate a built scene on the CPU.
#pragma once
#include "scene/build.h"
#include "shared/surface.h"

#include <string>
#include <vector>

namespace tessera::test
{

// --- parts -----------------------------------------------------------------------------------------------------------------------

// An image of one channel of seeded noise: neighbouring texels are unrelated, so that wrong coordinates show.
Image noiseImage(uint32_t width, uint32_t height, TexelFormat format, uint32_t seed);

// An image of one channel, every texel `value` (in the format's own numbers).
Image constantImage(uint32_t width, uint32_t height, TexelFormat format, double value);

// A texture of `image`, a material displaced by it; returns the material's index.
uint32_t addDisplaced(ImportedScene& scene, Image image, float factor, float offset, Wrap wrap = Wrap::Repeat);
uint32_t addPlain(ImportedScene& scene, std::string name);

// A mesh of these primitives and one instance of it.
void addPlacedMesh(ImportedScene& scene, std::vector<Primitive> primitives);

void addVertex(Primitive& primitive, vec3 position, vec3 normal, vec2 uv);
void addTriangle(Primitive& primitive, uint32_t a, uint32_t b, uint32_t c);

// --- scenes ----------------------------------------------------------------------------------------------------------------------

ImportedScene cubeScene(uint32_t side_quads);                                                // per-face texture coordinates, hard normals
ImportedScene sphereScene(uint32_t rings, uint32_t sectors, TexelFormat format, Wrap wrap);  // texture seam, fans at the poles
ImportedScene twoMapsScene();                                                                // two materials with different maps meet along a line
ImportedScene halfDisplacedScene();                                                          // a displaced and an undisplaced material meet
ImportedScene nonManifoldScene();                                                            // five sheets on one edge, each with its own coordinates
ImportedScene mirroredScene();       // coordinates reflected at the middle; triangles of opposite winding
ImportedScene degenerateScene();     // triangles without area, and one twice
ImportedScene touchingConesScene();  // two cones that share their tip and nothing else
ImportedScene transformedScene();    // one map through two texture transforms
ImportedScene coarseSphereScene();   // an octahedron: directions turn by a right angle in a triangle

// The unit sphere around the origin as an octahedron whose edges are cut in `cuts`: smooth normals, not displaced, 8 cuts^2 triangles.
ImportedScene roundScene(uint32_t cuts);

ImportedScene needleScene(uint32_t number);  // a triangle on the x axis, as thin as 1e-6, its tip now beside the base; noise displaces it
ImportedScene soupScene(uint32_t seed, uint32_t triangles);  // random triangles over few points, three materials, everything at odds

struct NamedScene
{
	std::string name;
	ImportedScene scene;
};
std::vector<NamedScene> allScenes();

// --- evaluation ------------------------------------------------------------------------------------------------------------------

// A built scene's arrays as the shared code reads them. The scene must outlive it.
struct HostSurface
{
	explicit HostSurface(const BuiltScene& scene);

	std::vector<HeightMap> height_maps;
	std::vector<uint32_t> no_seam_edges, no_seam_corners;  // stand in for arrays that the scene does not have
	Surface surface;
};

// A camera at `eye` that asks for mips by `sample_over_focal`, and the placement of a mesh that stands at the origin.
View viewFrom(vec3 eye, float sample_over_focal);
Placement placementFor(const View& view);

}  // namespace tessera::test
