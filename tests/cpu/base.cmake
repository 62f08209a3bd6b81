# Files and threads when things go wrong: killed programs, no memory.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(base_test ${here}/file_test.cpp ${here}/memory_test.cpp ${here}/gltf_file.cpp)
target_link_libraries(base_test PRIVATE tessera_scene nlohmann_json::nlohmann_json GTest::gtest_main)
target_compile_definitions(base_test PRIVATE TESSERA_TEST_DATA="${here}/../data")
gtest_discover_tests(base_test PROPERTIES LABELS cpu)
