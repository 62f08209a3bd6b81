# The device's stages against the CPU reference, pictures against properties and stored ones. Run on the default Vulkan device.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_library(gpu_test_base STATIC ${here}/gpu_test.cpp ${here}/visibility.cpp ${here}/../cpu/build_test_scenes.cpp)
target_link_libraries(gpu_test_base PUBLIC tessera_pipeline tessera_reference tessera_output GTest::gtest_main)
target_include_directories(gpu_test_base PUBLIC ${here}/..)
target_compile_definitions(gpu_test_base PUBLIC TESSERA_SOURCE_ROOT="${PROJECT_SOURCE_DIR}")

foreach(name IN ITEMS clock_load_test force_test list_end_test metric_test occlusion_test out_of_memory_test picture_test pipeline_store_test raster_test rate_search_test renderer_test small_first_test tessellation_test view_mode_test)
  add_executable(gpu_${name} ${here}/${name}.cpp)
  target_link_libraries(gpu_${name} PRIVATE gpu_test_base)
  add_dependencies(gpu_${name} tessera_shaders)
  gtest_discover_tests(gpu_${name} PROPERTIES LABELS gpu)
endforeach()

# Rays against the compute rasteriser by the check of `tessera verify`, and light against closed forms.
foreach(name IN ITEMS primary_test light_test falloff_test hidden_test sharing_test)
  add_executable(gpu_ray_${name} ${here}/raytracing/${name}.cpp ${here}/raytracing/ray_frames.cpp)
  target_link_libraries(gpu_ray_${name} PRIVATE gpu_test_base tessera_verify)
  add_dependencies(gpu_ray_${name} tessera_shaders)
  gtest_discover_tests(gpu_ray_${name} PROPERTIES LABELS gpu)
endforeach()

# Rays through clusters, under the layer that emulates them.
if(TARGET tessera_cluster_layer)
  add_executable(gpu_ray_clusters_test ${here}/raytracing/clusters_test.cpp ${here}/raytracing/cluster_test.cpp)
  target_link_libraries(gpu_ray_clusters_test PRIVATE gpu_test_base tessera_verify nlohmann_json::nlohmann_json)
  target_compile_definitions(gpu_ray_clusters_test PRIVATE TESSERA_LAYERS="$<TARGET_FILE_DIR:tessera_cluster_layer>")
  add_dependencies(gpu_ray_clusters_test tessera_shaders tessera_cluster_layer)
  gtest_discover_tests(gpu_ray_clusters_test PROPERTIES LABELS gpu)
endif()

# Runs both the checks in this process and the program.
foreach(name IN ITEMS verify_test verify_slow_test)
  add_executable(gpu_${name} ${here}/${name}.cpp ${here}/../cpu/program_run.cpp)
  target_link_libraries(gpu_${name} PRIVATE gpu_test_base tessera_verify nlohmann_json::nlohmann_json)
  target_compile_definitions(gpu_${name} PRIVATE TESSERA_PROGRAM="$<TARGET_FILE:tessera>")
  add_dependencies(gpu_${name} tessera tessera_shaders)
endforeach()

# The viewer as a user drives it, on a display without a screen. Exit code 77: a tool is missing (thirdparty/setup.sh installs them).
# The system's Python, not another one that comes first in the path: its packages are the system's.
find_program(TESSERA_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(TESSERA_PYTHON NAMES python3 REQUIRED)
add_test(NAME viewer.doesWhatAScriptOfClicksAndKeysAsks
         COMMAND ${TESSERA_PYTHON} ${here}/../viewer/viewer_script.py $<TARGET_FILE:tessera> ${PROJECT_SOURCE_DIR})
set_tests_properties(viewer.doesWhatAScriptOfClicksAndKeysAsks PROPERTIES LABELS gpu TIMEOUT 900 SKIP_RETURN_CODE 77
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")

gtest_discover_tests(gpu_verify_test PROPERTIES LABELS gpu)
gtest_discover_tests(gpu_verify_slow_test PROPERTIES LABELS slow TIMEOUT 7200)

# The extreme suite: a test per family, so that they can run side by side; the whole of it, on every raster path, is slow.
foreach(family IN ITEMS scale geometry displacement views counts animation)
  add_test(NAME verifySuite.quick_${family} COMMAND tessera verify --suite extreme-quick:${family} --quiet)
  set_tests_properties(verifySuite.quick_${family} PROPERTIES LABELS gpu SKIP_RETURN_CODE 4 TIMEOUT 900)
  add_test(NAME verifySuite.extreme_${family} COMMAND tessera verify --suite extreme:${family} --quiet)
  set_tests_properties(verifySuite.extreme_${family} PROPERTIES LABELS slow SKIP_RETURN_CODE 4 TIMEOUT 7200)
endforeach()
# Slivers along a silhouette, which drivers may cull before they round corners.
add_test(NAME verifySuite.quick_hub_by_mesh_shaders COMMAND tessera verify --suite extreme-quick:hub_10000 --raster mesh --quiet)
set_tests_properties(verifySuite.quick_hub_by_mesh_shaders PROPERTIES LABELS gpu SKIP_RETURN_CODE 4 TIMEOUT 900)

# The page of a report in a browser. Exit code 77: it is missing (thirdparty/setup.sh --all installs it), or there is no device.
add_test(NAME report.opensInABrowser COMMAND ${here}/../report/report_page.sh $<TARGET_FILE:tessera>)
set_tests_properties(report.opensInABrowser PROPERTIES LABELS gpu TIMEOUT 600 SKIP_RETURN_CODE 77)
