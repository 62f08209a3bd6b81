// --displacement image[:factor[:offset[:material]]]
#pragma once
#include "base/result.h"
#include "scene/imported_scene.h"

#include <string_view>

namespace tessera
{

// Reads the image and attaches it, through TEXCOORD_0 and with repeat, to the named materials (default: all), replacing what
// they had. factor (default 1) and offset (default 0) are in mesh units; empty means default. material is a name (all
// materials of that name) or, if there is none of that name, an index of the file. The image's own name may contain colons: the
// longest head of the option that is an existing file is the image.
// A primitive without TEXCOORD_0 stays undisplaced, with a warning in scene.warnings.
// Errors: Usage (malformed numbers), BadInput (missing or broken image, unknown material). The scene is unchanged then.
Status attachDisplacement(ImportedScene& scene, std::string_view option);

}  // namespace tessera
