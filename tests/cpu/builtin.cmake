# Built-in scenes and the files that are written.
add_executable(builtin_test ${CMAKE_CURRENT_LIST_DIR}/builtin_test.cpp)
target_link_libraries(builtin_test PRIVATE tessera_scene GTest::gtest_main)
gtest_discover_tests(builtin_test PROPERTIES LABELS cpu)

find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
add_executable(output_test ${CMAKE_CURRENT_LIST_DIR}/output_test.cpp)
target_include_directories(output_test SYSTEM PRIVATE ${STB_INCLUDE_DIR})
target_link_libraries(output_test PRIVATE tessera_output tessera_scene nlohmann_json::nlohmann_json GTest::gtest_main)
gtest_discover_tests(output_test PROPERTIES LABELS cpu)
