# Layers that tests put between the program and the driver, with their manifests beside them.
set(layers ${CMAKE_CURRENT_LIST_DIR})
add_library(tessera_lost_device MODULE ${layers}/lost_device.cpp)
target_link_libraries(tessera_lost_device PRIVATE tessera_vulkan)
set_target_properties(tessera_lost_device PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test_layers)
file(READ ${layers}/lost_device.json manifest)
string(REPLACE "LIBRARY" "./$<TARGET_FILE_NAME:tessera_lost_device>" manifest "${manifest}")
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/test_layers/lost_device.json CONTENT "${manifest}")

# The layer that emulates clusters, by a small program of raw Vulkan.
if(TARGET tessera_cluster_layer)
  set(layer_shaders ${CMAKE_BINARY_DIR}/test_layers/shaders)
  file(MAKE_DIRECTORY ${layer_shaders})
  # Not by tessera_shader: spirv-val 2023.1 does not know the capability.
  foreach(shader IN ITEMS trace.rgen trace.rmiss plain.rchit cluster.rchit query.comp)
    add_custom_command(OUTPUT ${layer_shaders}/${shader}.spv
      COMMAND ${TESSERA_glslangValidator} --quiet -V --target-env vulkan1.3 -I${layers}/shaders ${layers}/shaders/${shader} -o ${layer_shaders}/${shader}.spv
      DEPENDS ${layers}/shaders/${shader} ${layers}/shaders/hit.glsl
      VERBATIM)
    list(APPEND layer_spirv ${layer_shaders}/${shader}.spv)
  endforeach()
  add_custom_target(tessera_layer_test_shaders DEPENDS ${layer_spirv})
  add_executable(cluster_layer_test ${layers}/cluster_harness.cpp ${layers}/cluster_tracer.cpp ${layers}/cluster_scene.cpp ${layers}/layer_report.cpp ${layers}/cluster_trace_test.cpp ${layers}/cluster_behaviour_test.cpp ${layers}/cluster_use_test.cpp
    ${layers}/cluster_mistakes.cpp ${layers}/cluster_mistakes_commands_test.cpp
    ${layers}/cluster_mistakes_destinations_test.cpp ${layers}/cluster_mistakes_clusters_test.cpp ${layers}/cluster_mistakes_structures_test.cpp)
  target_link_libraries(cluster_layer_test PRIVATE tessera_flags tessera_vulkan nlohmann_json::nlohmann_json GTest::gtest_main)
  target_include_directories(cluster_layer_test PRIVATE ${layers}/..)
  target_compile_definitions(cluster_layer_test PRIVATE TESSERA_LAYERS="$<TARGET_FILE_DIR:tessera_cluster_layer>" TESSERA_LAYER_SHADERS="${layer_shaders}")
  add_dependencies(cluster_layer_test tessera_cluster_layer tessera_layer_test_shaders)
  gtest_discover_tests(cluster_layer_test PROPERTIES LABELS gpu)
endif()
