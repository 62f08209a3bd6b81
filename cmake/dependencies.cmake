# Every library the project stands on; thirdparty/README.md says which, why and under which licence.
# Targets: those of the packages, and tessera_vulkan (Vulkan loader and the newest headers there are, VMA included).

# Compiles through ccache when it is there.
find_program(TESSERA_CCACHE ccache)
if(TESSERA_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${TESSERA_CCACHE})
endif()

# Finds a package or stops with one line that says what to do.
macro(tessera_require package)
  find_package(${package} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "${package} is not installed: run thirdparty/setup.sh")
  endif()
endmacro()

foreach(package IN ITEMS Threads fmt spdlog glm nlohmann_json tl-expected meshoptimizer CLI11 ZLIB GTest Vulkan)
  tessera_require(${package})
endforeach()

# Headers of a newer Vulkan than the system's, put in place by thirdparty/setup.sh; -isystem puts them before /usr/include.
set(TESSERA_HEADERS ${PROJECT_SOURCE_DIR}/build/thirdparty/headers/include CACHE PATH
    "newer Vulkan and VMA headers; the system's are used when it does not exist")
add_library(tessera_vulkan INTERFACE)
if(EXISTS ${TESSERA_HEADERS}/vulkan/vulkan.h)
  target_include_directories(tessera_vulkan SYSTEM INTERFACE ${TESSERA_HEADERS})
endif()
target_link_libraries(tessera_vulkan INTERFACE Vulkan::Vulkan)

find_file(TESSERA_VMA_HEADER vk_mem_alloc.h PATHS ${TESSERA_HEADERS} ${Vulkan_INCLUDE_DIRS} PATH_SUFFIXES vma NO_CACHE)
if(NOT TESSERA_VMA_HEADER)
  message(FATAL_ERROR "vk_mem_alloc.h (Vulkan Memory Allocator) is not installed: run thirdparty/setup.sh")
endif()

# Nearest points for the error metrics. Version 3 (Debian 12) and 4 (Debian 13) have packages of different names.
tessera_require(embree)
add_library(tessera_embree INTERFACE)
target_include_directories(tessera_embree SYSTEM INTERFACE ${EMBREE_INCLUDE_DIRS})
target_link_libraries(tessera_embree INTERFACE ${EMBREE_LIBRARY})
target_compile_definitions(tessera_embree INTERFACE TESSERA_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR})

# The window of the viewer, and its panels: Debian's library has the GLFW and Vulkan back ends in it.
tessera_require(glfw3)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(IMGUI QUIET imgui)
endif()
if(NOT IMGUI_FOUND)
  message(FATAL_ERROR "Dear ImGui is not installed: run thirdparty/setup.sh")
endif()
add_library(tessera_imgui INTERFACE)
target_include_directories(tessera_imgui SYSTEM INTERFACE ${IMGUI_INCLUDE_DIRS})
target_link_libraries(tessera_imgui INTERFACE ${IMGUI_LINK_LIBRARIES} glfw tessera_vulkan)

# The shader compiler as a library, for reloading shaders. glslang's package needs SPIRV-Tools found before it.
find_package(SPIRV-Tools-opt QUIET)
find_package(glslang QUIET)
if(NOT glslang_FOUND)
  message(FATAL_ERROR "glslang's library is not installed: run thirdparty/setup.sh")
endif()
add_library(tessera_glslang INTERFACE)
target_link_libraries(tessera_glslang INTERFACE glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits)
