# The built shaders as binaries: layouts and exact float code. No device.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(spirv_test ${here}/spirv_module.cpp ${here}/spirv_test.cpp)
target_link_libraries(spirv_test PRIVATE tessera_scene GTest::gtest_main)
target_compile_definitions(spirv_test PRIVATE TESSERA_SHADER_SOURCES="${PROJECT_SOURCE_DIR}/shaders")
add_dependencies(spirv_test tessera_shaders)
gtest_discover_tests(spirv_test PROPERTIES LABELS cpu)
