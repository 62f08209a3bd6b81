# The tessellation table's rules, quality and file format.
add_executable(tables_test ${CMAKE_CURRENT_LIST_DIR}/tables_test.cpp)
target_link_libraries(tables_test PRIVATE tessera_tables nlohmann_json::nlohmann_json GTest::gtest_main)
gtest_discover_tests(tables_test PROPERTIES LABELS cpu)
