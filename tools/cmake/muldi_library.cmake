# muldi_library(<folder> SOURCES <files> LINKS <targets>)
#   the static library muldi_<folder> of lib/<folder>; LINKS repeats the include table of the folder and nothing else.
function(muldi_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  if(arg_SOURCES)
    add_library(muldi_${folder} STATIC ${arg_SOURCES})
    target_include_directories(muldi_${folder} PUBLIC ${PROJECT_SOURCE_DIR}/lib)
    target_link_libraries(muldi_${folder} PUBLIC ${arg_LINKS} PRIVATE muldi_warnings)
    # These run once a scene; optimising them costs minutes of building and gains nothing.
    if(folder MATCHES "^(scene|build|pipeline)$")
      target_compile_options(muldi_${folder} PRIVATE -O1)
      muldi_reuse_headers(muldi_${folder} muldi_setup_headers)
      muldi_batches(muldi_${folder} 8)
    else()
      if(NOT folder STREQUAL "base")
        muldi_reuse_headers(muldi_${folder} muldi_numerics_headers)
      endif()
      if(NOT folder MATCHES "^(math|fem)$")  # their time goes into optimising what only they have
        muldi_batches(muldi_${folder} 4)
      endif()
    endif()
  else()
    add_library(muldi_${folder} INTERFACE)
    target_include_directories(muldi_${folder} INTERFACE ${PROJECT_SOURCE_DIR}/lib)
    target_link_libraries(muldi_${folder} INTERFACE ${arg_LINKS})
  endif()
endfunction()

# muldi_inject(<source> <faults>)
#   compiles a source of the folder with the fault MULDI_MUTATION, if it is one of these; tools/mutation sets it.
function(muldi_inject source)
  if(MULDI_MUTATION IN_LIST ARGN)
    set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS MULDI_MUTATION=${MULDI_MUTATION})
  endif()
endfunction()

# muldi_headers(<target> LIBRARY|EXECUTABLE LINKS <targets> OPTIONS <options> HEADERS <headers>)
#   headers parsed once for all the targets of one kind that are compiled with the same options. Sources still include what they use:
#   tools/lint --tidy compiles them without.
function(muldi_headers target kind)
  cmake_parse_arguments(arg "" "" "LINKS;OPTIONS;HEADERS" ${ARGN})
  set(source ${PROJECT_BINARY_DIR}/${target}.cpp)
  if(kind STREQUAL "LIBRARY")
    file(CONFIGURE OUTPUT ${source} CONTENT "// Carries precompiled headers.\n" @ONLY)
    add_library(${target} STATIC ${source})
  else()
    file(CONFIGURE OUTPUT ${source} CONTENT "// Carries precompiled headers.\nint main() { return 0; }\n" @ONLY)
    add_executable(${target} ${source})
  endif()
  target_link_libraries(${target} PRIVATE ${arg_LINKS} muldi_warnings)
  target_compile_options(${target} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${target} PRIVATE ${arg_HEADERS})
  muldi_options_for_ccache(${target})
endfunction()

# ccache asks for this where headers are precompiled.
function(muldi_options_for_ccache target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()

function(muldi_reuse_headers target headers)
  target_precompile_headers(${target} REUSE_FROM ${headers})
  muldi_options_for_ccache(${target})
  # Code for one instruction set must not see functions that others share.
  file(GLOB_RECURSE kernels ${CMAKE_CURRENT_SOURCE_DIR}/*kernels_v[0-9].cpp)
  if(kernels)
    set_source_files_properties(${kernels} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

set(standard_headers <algorithm> <array> <cmath> <functional> <limits> <map> <memory> <optional> <span> <string> <string_view> <utility>
                     <variant> <vector>)
# What the folders of numerics include, and what reads scenes and builds models.
muldi_headers(muldi_numerics_headers LIBRARY LINKS Eigen3::Eigen fmt::fmt spdlog::spdlog HEADERS <Eigen/Core> <Eigen/Geometry>
              ${standard_headers})
muldi_headers(muldi_setup_headers LIBRARY LINKS Eigen3::Eigen fmt::fmt spdlog::spdlog OPTIONS -O1 HEADERS <Eigen/Core> <Eigen/Geometry>
              ${standard_headers})
# What nearly every test includes. A program, since it is compiled with the options of programs.
if(MULDI_TESTS)
  muldi_headers(muldi_test_headers EXECUTABLE LINKS Eigen3::Eigen fmt::fmt spdlog::spdlog GTest::gtest_main GTest::gmock OPTIONS -O1
                HEADERS <gmock/gmock.h> <gtest/gtest.h> <Eigen/Dense> <filesystem> <fstream> <random> ${standard_headers})
endif()

# muldi_test(<label> <name> [LONG] SOURCES <files> LINKS <targets>)
#   the GoogleTest program <label>_<name>; every test in it carries the ctest label <label>, and `long` if it takes over 10 s.
function(muldi_test label name)
  cmake_parse_arguments(arg "LONG" "" "SOURCES;LINKS" ${ARGN})
  set(target ${label}_${name})
  add_executable(${target} ${arg_SOURCES})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${target} PRIVATE MULDI_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MULDI_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(${target} PRIVATE ${arg_LINKS} GTest::gtest_main GTest::gmock muldi_warnings)
  # Only the stress tests run long enough to repay an optimised build of the tests themselves; the libraries are always optimised.
  if(NOT label STREQUAL "stress")
    target_compile_options(${target} PRIVATE -O1)
    muldi_reuse_headers(${target} muldi_test_headers)
    muldi_batches(${target} 8)
  else()
    muldi_batches(${target} 4)
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${label}." PROPERTIES LABELS ${label} DISCOVERY_TIMEOUT 60)
  if(arg_LONG)
    # gtest_discover_tests cannot pass a list of labels.
    set(second_label ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake)
    file(WRITE ${second_label} "set_tests_properties(\${${target}_TESTS} PROPERTIES LABELS \"${label};long\")\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${second_label})
  endif()
endfunction()

# muldi_script_test(<label> <name> [LONG] <program> <arguments>)
#   one ctest test <label>.<name> that is a program (a Python file is run by Debian's Python); exit code 0 passes.
function(muldi_script_test label name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "LONG" "" "")
  set(command ${arg_UNPARSED_ARGUMENTS})
  list(GET command 0 program)
  if(program MATCHES "\\.py$")
    list(PREPEND command ${MULDI_PYTHON})
  endif()
  set(labels ${label})
  if(arg_LONG)
    list(APPEND labels long)
  endif()
  add_test(NAME ${label}.${name} COMMAND ${command})
  set_tests_properties(${label}.${name} PROPERTIES LABELS "${labels}" ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
endfunction()

# muldi_benchmark(<name> SOURCES <files> LINKS <targets>)
#   the program bench_<name>, which prints the JSON of tests/bench/bench_report.hpp; tools/bench builds and runs it, and
#   tools/test --all builds it.
function(muldi_benchmark name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  set(target bench_${name})
  add_executable(${target} EXCLUDE_FROM_ALL ${arg_SOURCES})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bench)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${target} PRIVATE MULDI_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MULDI_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(${target} PRIVATE ${arg_LINKS} muldi_build_info muldi_warnings)
  add_dependencies(benchmarks ${target})
endfunction()
