# The library muldi_build_info (lib/base/build_info.*): facts of the configuration, and the commit, looked up at each build.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(JOIN " " muldi_flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} -std=c++${CMAKE_CXX_STANDARD} ${muldi_options})
string(REPLACE "\"" "'" muldi_flags "${muldi_flags}")
file(STRINGS ${SUITESPARSE_INCLUDE_DIR}/SuiteSparse_config.h suitesparse_lines REGEX "define SUITESPARSE_(MAIN|SUB|SUBSUB)_VERSION")
string(REGEX MATCHALL "[0-9]+" suitesparse_VERSION "${suitesparse_lines}")
string(JOIN "." suitesparse_VERSION ${suitesparse_VERSION})

set(generated ${PROJECT_BINARY_DIR}/generated)
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_facts.hpp.in ${generated}/base/build_facts.hpp @ONLY)

# The header is rewritten only when the commit has changed, so that one small file is compiled again, and only then.
find_package(Git QUIET)
add_custom_target(muldi_build_commit
  COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE=${PROJECT_SOURCE_DIR} -DHEADER=${generated}/base/build_commit.hpp
          -P ${CMAKE_CURRENT_LIST_DIR}/build_commit.cmake
  BYPRODUCTS ${generated}/base/build_commit.hpp
  COMMENT "Looking up the commit of this build"
  VERBATIM)

add_library(muldi_build_info STATIC ${PROJECT_SOURCE_DIR}/lib/base/build_info.cpp)
target_include_directories(muldi_build_info PUBLIC ${PROJECT_SOURCE_DIR}/lib PRIVATE ${generated})
target_link_libraries(muldi_build_info PRIVATE muldi_warnings)
add_dependencies(muldi_build_info muldi_build_commit)
