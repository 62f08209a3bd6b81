# tessera_shader(SOURCE... [UNVALIDATED] [VARIANT name DEFINES A=1 B ...])
#
# Compiles each SOURCE (a path below shaders/, its suffix names the stage) to SPIR-V for Vulkan 1.3 and validates it:
#   tessellation/x.comp               -> ${PROJECT_BINARY_DIR}/shaders/tessellation/x.comp.spv
#   tessellation/x.comp, VARIANT name -> ${PROJECT_BINARY_DIR}/shaders/tessellation/x.comp.name.spv, compiled with DEFINES
# UNVALIDATED: for what the validator does not know.
# The target tessera_shaders builds all of them. Touching a header rebuilds only the shaders that include it.
foreach(tool IN ITEMS glslangValidator spirv-val)
  string(MAKE_C_IDENTIFIER "TESSERA_${tool}" variable)
  find_program(${variable} ${tool} HINTS $ENV{VULKAN_SDK}/bin)
  if(NOT ${variable})
    message(FATAL_ERROR "${tool} is not installed: run thirdparty/setup.sh")
  endif()
endforeach()

add_custom_target(tessera_shaders ALL)

function(tessera_shader)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "UNVALIDATED" "VARIANT" "DEFINES")
  list(TRANSFORM ARG_DEFINES PREPEND -D)
  set(validate COMMAND ${TESSERA_spirv_val} --target-env vulkan1.3 --scalar-block-layout)
  if(ARG_UNVALIDATED)
    set(validate COMMAND ${CMAKE_COMMAND} -E true)
  endif()
  foreach(source IN LISTS ARG_UNPARSED_ARGUMENTS)
    set(name ${source})
    if(ARG_VARIANT)
      string(APPEND name .${ARG_VARIANT})
    endif()
    set(spv ${PROJECT_BINARY_DIR}/shaders/${name}.spv)
    get_filename_component(folder ${spv} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(
      OUTPUT ${spv}
      COMMAND ${TESSERA_glslangValidator} --quiet -V --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR}/shaders ${ARG_DEFINES}
              ${PROJECT_SOURCE_DIR}/shaders/${source} -o ${spv} --depfile ${spv}.d
      ${validate} ${spv}
      DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${source}
      DEPFILE ${spv}.d
      COMMENT "Compiling shader ${name}"
      VERBATIM)
    string(MAKE_C_IDENTIFIER "shader_${name}" target)
    add_custom_target(${target} DEPENDS ${spv})
    add_dependencies(tessera_shaders ${target})
  endforeach()
endfunction()
