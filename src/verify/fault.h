// Seeded faults: a scene that the device gets instead of the right one, so that every check can be seen to fail.
#pragma once
#include "base/result.h"
#include "scene/camera.h"
#include "verify/picture.h"

namespace tessera::verify
{

// In the order of the checks that must catch them: watertight, no_holes, conservative, finite_and_right, deterministic.
enum class Fault : uint8_t
{
	None,
	Crack,  // a vertex on a border between clusters lies 16 ulps away in one of them
	Drop,   // a cluster lacks its last triangle
	Cull,   // the bounds of a cluster that is seen say that it lies behind the eye
	Nan,    // a displacement direction (or a position) is not a number
	Tie,    // in frames that are drawn another way, a vertex lies 16 ulps away: as if something were decided by order
};
inline constexpr std::string_view kFaultNames[] = { "none", "crack", "drop", "cull", "nan", "tie" };

// Fault::None for any other name.
Fault faultNamed(std::string_view name);

struct FaultyScene
{
	BuiltScene scene;
	std::string what;  // where the fault is
};

// Crack, drop, nan and tie. Errors: BadInput when the scene has no place for it.
Result<FaultyScene> withFault(const BuiltScene& scene, Fault fault, uint64_t seed);

// Cull: of a cluster that `picture` shows from `camera`. Errors: BadInput when it shows nothing.
Result<FaultyScene> withCullFault(const BuiltScene& scene, const VisiblePicture& picture, const Camera& camera, uint64_t seed);

}  // namespace tessera::verify
