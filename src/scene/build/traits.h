// Facts of a built scene that decide what it needs (C5).
#pragma once
#include "scene/scene.h"

namespace tessera
{

// Fills in what can be read off the finished arrays of `scene`; the counts of welding and seams are there already. Adds warnings for
// what the user may not expect.
void findTraits(BuiltScene& scene);

}  // namespace tessera
