# The bench's tables, options and data files; nothing is timed here.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(bench_test ${here}/bench_test.cpp)
target_link_libraries(bench_test PRIVATE tessera_bench_core GTest::gtest_main)
target_compile_definitions(bench_test PRIVATE TESSERA_BENCH_DATA="${PROJECT_SOURCE_DIR}/bench")
gtest_discover_tests(bench_test PROPERTIES LABELS cpu)
