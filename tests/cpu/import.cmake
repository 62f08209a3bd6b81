# glTF and image import: features, refusals, images, --displacement, and whole folders of sample files.
set(TESSERA_GLTF_SAMPLES "/usr/share/assimp/models/glTF2" CACHE PATH "folder of glTF files that the importer is tried on (Debian: assimp-testmodels)")
add_executable(import_test
  ${CMAKE_CURRENT_LIST_DIR}/displacement_option_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_file.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_import_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_refusal_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_scene_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/image_decode_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/import_samples_test.cpp)
target_link_libraries(import_test PRIVATE tessera_scene nlohmann_json::nlohmann_json GTest::gtest_main)
target_compile_definitions(import_test PRIVATE TESSERA_TEST_DATA="${CMAKE_CURRENT_LIST_DIR}/../data" TESSERA_GLTF_SAMPLES="${TESSERA_GLTF_SAMPLES}")
gtest_discover_tests(import_test PROPERTIES LABELS cpu)
