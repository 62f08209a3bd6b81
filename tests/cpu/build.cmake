# From imported to built scene: welding, seams, height maps, clusters, bounds.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(scene_build_test ${here}/build_test_scenes.cpp ${here}/height_map_test.cpp ${here}/scene_bounds_test.cpp ${here}/scene_build_test.cpp
               ${here}/weld_test.cpp)
target_link_libraries(scene_build_test PRIVATE tessera_scene GTest::gtest_main)
gtest_discover_tests(scene_build_test PROPERTIES LABELS cpu)
