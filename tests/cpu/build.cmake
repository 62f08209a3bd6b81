# From imported to built scene: welding, seams, height maps, clusters, bounds.
add_executable(scene_build_test ${CMAKE_CURRENT_LIST_DIR}/build_test_scenes.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_build_test.cpp)
target_link_libraries(scene_build_test PRIVATE tessera_scene GTest::gtest_main)
gtest_discover_tests(scene_build_test PROPERTIES LABELS cpu)
