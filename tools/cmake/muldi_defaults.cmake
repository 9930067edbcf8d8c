# Compiler settings that hold for every target.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Modules opened on demand (Ipopt) hold code of the static libraries.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
find_program(CCACHE ccache)
if(CCACHE)
  # The sloppiness lets it serve what is compiled with precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# The same bits on every machine: no -march=native, no -ffast-math, no fusing of products and sums. errno is never read.
set(muldi_options -ffp-contract=off -fno-math-errno)
if(MULDI_NATIVE)
  list(APPEND muldi_options -march=native)
endif()
if(MULDI_SANITIZE)
  # Optimised a little, or the tests take minutes; assertions on. This replaces the flags of the build type.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  set(CMAKE_CXX_FLAGS_${build_type} "-O1 -g1")
  list(APPEND muldi_options -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=address,undefined)
endif()
if(MULDI_SANITIZE_THREADS)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  set(CMAKE_CXX_FLAGS_${build_type} "-O1 -g1")
  list(APPEND muldi_options -fsanitize=thread)
  add_link_options(-fsanitize=thread)
endif()
if(MULDI_COVERAGE)
  # Lines are counted as they are written: hardly optimised. This replaces the flags of the build type.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  set(CMAKE_CXX_FLAGS_${build_type} "-O1 -DNDEBUG")
  # Threads may lose counts to each other, though never all of a line; counting atomically takes ten times as long.
  list(APPEND muldi_options --coverage)
  add_link_options(--coverage)
endif()
if(MULDI_FUZZ)
  list(APPEND muldi_options -fsanitize=fuzzer-no-link)
endif()
add_compile_options(${muldi_options})

# Warnings are errors, in this one place.
add_library(muldi_warnings INTERFACE)
target_compile_options(muldi_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual
  -Wconversion -Wno-sign-conversion -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false positives inside Eigen and the standard library at -O3.
  target_compile_options(muldi_warnings INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict)
endif()
