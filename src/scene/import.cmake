# glTF and image files. tinygltf and stb are used through their headers; only Draco is linked.
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
find_package(draco CONFIG REQUIRED)
target_sources(tessera_scene PRIVATE
  displacement_option.cpp
  gltf_accessor.cpp
  gltf_document.cpp
  gltf_draco.cpp
  gltf_extensions.cpp
  gltf_import.cpp
  gltf_material.cpp
  gltf_model.cpp
  gltf_nodes.cpp
  gltf_primitive.cpp
  gltf_schema.cpp
  gltf_texture.cpp
  gltf_topology.cpp
  gltf_uri.cpp
  gltf_warnings.cpp
  image_decode.cpp
  image_exr.cpp
  image_stb.cpp
  material_variants.cpp)
target_include_directories(tessera_scene SYSTEM PRIVATE ${TINYGLTF_INCLUDE_DIR} ${STB_INCLUDE_DIR})
target_link_libraries(tessera_scene PRIVATE nlohmann_json::nlohmann_json draco::draco)
# tinygltf only parses descriptions here: no files, no images.
target_compile_definitions(tessera_scene PRIVATE TINYGLTF_NO_FS TINYGLTF_NO_EXTERNAL_IMAGE TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE)
