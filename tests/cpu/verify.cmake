# The checks of verify on data of the CPU reference, sound and broken by hand.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(verify_checks_test ${here}/build_test_scenes.cpp ${here}/reference_test_scenes.cpp ${here}/verify_checks_test.cpp)
target_link_libraries(verify_checks_test PRIVATE tessera_verify GTest::gtest_main)
gtest_discover_tests(verify_checks_test PROPERTIES LABELS cpu)
