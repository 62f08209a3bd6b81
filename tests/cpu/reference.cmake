# The tessellation stages on the CPU: the shared headers against hand-computed answers, double precision and integer identities.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(reference_test ${here}/build_test_scenes.cpp ${here}/reference_checks_test.cpp ${here}/reference_test.cpp ${here}/reference_test_scenes.cpp
  ${here}/edge_detail_test.cpp ${here}/pn_test.cpp ${here}/ray_falloff_test.cpp ${here}/hidden_falloff_test.cpp ${here}/ray_sharing_test.cpp)
target_link_libraries(reference_test PRIVATE tessera_reference GTest::gtest_main)
gtest_discover_tests(reference_test PROPERTIES LABELS cpu)
