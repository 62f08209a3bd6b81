# tessera_flags: what every target of this project is compiled with.
add_library(tessera_flags INTERFACE)
target_include_directories(tessera_flags INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders ${PROJECT_SOURCE_DIR})
# No contraction into fma anywhere: shared float maths must round as the GPU does (DESIGN.md, section 5).
target_compile_options(tessera_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers)
# GCC 12 sees overlapping copies in its own string concatenation (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(tessera_flags INTERFACE -Wno-restrict)
endif()
# Clang measures the indentation of shared headers behind `precise`, which is nothing in C++.
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(tessera_flags INTERFACE -Wno-misleading-indentation)
endif()
if(TESSERA_WERROR)
  target_compile_options(tessera_flags INTERFACE -Werror)
endif()
if(TESSERA_SANITIZE)
  # With sanitizers GCC 12 sees uninitialised values inside std::regex.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(tessera_flags INTERFACE -Wno-maybe-uninitialized)
  endif()
  target_compile_options(tessera_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(tessera_flags INTERFACE -fsanitize=address,undefined)
endif()
