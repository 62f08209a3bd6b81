# The viewer without its window.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(viewer_test ${here}/viewer_test.cpp)
target_link_libraries(viewer_test PRIVATE tessera_viewer GTest::gtest_main)
gtest_discover_tests(viewer_test PROPERTIES LABELS cpu)
