# The viewer without its window.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(viewer_test ${here}/viewer_test.cpp)
target_link_libraries(viewer_test PRIVATE tessera_viewer GTest::gtest_main)
target_compile_definitions(viewer_test PRIVATE TESSERA_SOURCE_ROOT="${PROJECT_SOURCE_DIR}")
add_dependencies(viewer_test tessera_shaders)
gtest_discover_tests(viewer_test PROPERTIES LABELS cpu)
