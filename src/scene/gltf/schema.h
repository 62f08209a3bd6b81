// The shape of a glTF document: which fields may be there, of which type, pointing where.
#pragma once
#include "base/result.h"
#include "scene/gltf/document.h"

namespace tessera
{

// Checks type, range and index of every field that the importer (or the parser behind it) reads.
// After it, every index is inside its array and every array of numbers has its length. Fields it does not know are free.
// Errors: BadInput naming the field. Time linear in the document.
Status checkGltfSchema(const GltfDocument& document);

// Refuses required extensions that are not supported, and warns about the others that the file uses, each by name.
Status checkGltfExtensions(GltfDocument& document);

}  // namespace tessera
