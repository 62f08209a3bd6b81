# Layers that tests put between the program and the driver, with their manifests beside them.
set(layers ${CMAKE_CURRENT_LIST_DIR})
add_library(tessera_lost_device MODULE ${layers}/lost_device.cpp)
target_link_libraries(tessera_lost_device PRIVATE tessera_vulkan)
set_target_properties(tessera_lost_device PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test_layers)
file(READ ${layers}/lost_device.json manifest)
string(REPLACE "LIBRARY" "./$<TARGET_FILE_NAME:tessera_lost_device>" manifest "${manifest}")
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/test_layers/lost_device.json CONTENT "${manifest}")
