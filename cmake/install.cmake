# cmake --install build/release --prefix FOLDER makes a folder that can be moved to another machine:
#   bin/tessera                    looks for its libraries in ../lib and for its shaders in ../share/tessera/shaders
#   lib/                           the shared libraries it needs, without those that belong to the machine it runs on
#   share/tessera/shaders/**.spv   compiled shaders
#   share/tessera/shader_sources/  what they are compiled from, for reloading in the viewer
# Belong to the machine: the C library, the Vulkan loader and drivers (the loader has to find that machine's drivers), and the
# C++ run-time library: drivers load it too and may need a newer one than the build machine's (seen: no device found).
# TESSERA_INSTALL_CXX_RUNTIME brings it along all the same, for a machine that has none or an older one.
option(TESSERA_INSTALL_CXX_RUNTIME "install libstdc++ and libgcc_s beside the program's other libraries" OFF)

if(TARGET tessera)
  set_target_properties(tessera PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")
  install(TARGETS tessera RUNTIME DESTINATION bin)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/shaders/ DESTINATION share/tessera/shaders FILES_MATCHING PATTERN "*.spv"
          PATTERN CMakeFiles EXCLUDE)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders/ DESTINATION share/tessera/shader_sources
          FILES_MATCHING PATTERN "*.comp" PATTERN "*.mesh" PATTERN "*.frag" PATTERN "*.vert" PATTERN "*.glsl" PATTERN "*.h")
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/tessera)

  set(of_the_machine "^ld-linux" "^lib(c|m|pthread|dl|rt|resolv|util)[.]so" "^libvulkan[.]so")
  if(NOT TESSERA_INSTALL_CXX_RUNTIME)
    list(APPEND of_the_machine "^lib(stdc[+][+]|gcc_s)[.]so")
  endif()
  string(CONFIGURE [=[
    set(of_the_machine "@of_the_machine@")
    set(folder "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib")
    file(GET_RUNTIME_DEPENDENCIES
         EXECUTABLES "$<TARGET_FILE:tessera>"
         RESOLVED_DEPENDENCIES_VAR libraries
         UNRESOLVED_DEPENDENCIES_VAR missing
         PRE_EXCLUDE_REGEXES ${of_the_machine})
    if(missing)
      message(FATAL_ERROR "libraries that tessera needs were not found: ${missing}")
    endif()
    find_program(PATCHELF patchelf)
    if(NOT PATCHELF)
      message(FATAL_ERROR "patchelf is not installed: run thirdparty/setup.sh")
    endif()
    foreach(library IN LISTS libraries)
      file(INSTALL "${library}" DESTINATION "${folder}" TYPE SHARED_LIBRARY FOLLOW_SYMLINK_CHAIN)
      # The libraries need each other, and a program's search path does not count for them: each looks in its own folder.
      file(REAL_PATH "${library}" real)
      get_filename_component(name "${real}" NAME)
      execute_process(COMMAND "${PATCHELF}" --set-rpath $ORIGIN "${folder}/${name}" COMMAND_ERROR_IS_FATAL ANY)
    endforeach()
  ]=] install_libraries @ONLY)
  install(CODE "${install_libraries}")
endif()
