# SPDX-License-Identifier: Apache-2.0
# One helper for the layers, one for the tests; flags live here and nowhere else.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Off by default: a newer compiler than the tested ones must not stop a user's build.
option(EARTHSHINE_WERROR "Treat warnings as errors" OFF)
option(EARTHSHINE_UNITY "Compile several files at a time where that is quicker" ON)
set(EARTHSHINE_ARCH "x86-64-v3" CACHE STRING "Value of -march; empty for the compiler's default")

add_library(earthshine_flags INTERFACE)
# -ffp-contract=off: a fused multiply-add rounds once, so results would differ between machines.
# Nobody reads errno or traps after a square root; without the two, loops with one run side by side.
target_compile_options(earthshine_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off -fno-math-errno -fno-trapping-math
  # GCC 12 reports overlaps and overflows inside std::string that are not there (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overread>
  $<$<BOOL:${EARTHSHINE_WERROR}>:-Werror>)
if(EARTHSHINE_ARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(earthshine_flags INTERFACE -march=${EARTHSHINE_ARCH})
endif()

# What nearly every file includes is compiled once. The headers of the standard library and fmt take half
# of a file's seconds; those of the project are left out, or each change would compile everything anew.
set(earthshine_common_headers
  <algorithm> <array> <bit> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <numeric>
  <optional> <span> <string> <string_view> <utility> <vector> <fmt/format.h> <fmt/ranges.h> <glm/glm.hpp>)
# Programs and the Python module are linked from the same objects. Their symbols are hidden, so that
# calls and data are reached as directly as in a program.
function(serve_module target)
  set_target_properties(${target} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
add_library(earthshine_common OBJECT ${CMAKE_CURRENT_LIST_DIR}/common.cpp)
serve_module(earthshine_common)
target_link_libraries(earthshine_common PRIVATE earthshine_flags fmt::fmt glm::glm)
target_precompile_headers(earthshine_common PRIVATE ${earthshine_common_headers})

# Files of a folder are compiled together, so that they read headers and instantiate templates once: 0.6 of the
# seconds. Their local names differ.
function(compile_by_folder target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    string(REPLACE "/" "_" folder "files_${folder}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${EARTHSHINE_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# add_layer(NAME USES <layers> LIBRARIES <public> PRIVATE_LIBRARIES <owned here> SOURCES <files>)
function(add_layer name)
  cmake_parse_arguments(LAYER "" "" "USES;LIBRARIES;PRIVATE_LIBRARIES;SOURCES" ${ARGN})
  add_library(earthshine_${name} STATIC ${LAYER_SOURCES})
  add_library(earthshine::${name} ALIAS earthshine_${name})
  serve_module(earthshine_${name})
  target_include_directories(earthshine_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/earthshine>)
  set_target_properties(earthshine_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY EARTHSHINE_LIBRARIES earthshine_${name})
  list(TRANSFORM LAYER_USES PREPEND earthshine_)
  target_link_libraries(earthshine_${name}
    PUBLIC ${LAYER_USES} ${LAYER_LIBRARIES}
    PRIVATE earthshine_flags fmt::fmt ${LAYER_PRIVATE_LIBRARIES})
  target_precompile_headers(earthshine_${name} REUSE_FROM earthshine_common)
  compile_by_folder(earthshine_${name})
endfunction()

# What tests of layers share: their headers, compiled once. A local name may be that of another file's constant:
# four files are compiled at a time, in six tenths of the seconds; the names of their helpers differ.
add_library(earthshine_test_flags INTERFACE)
target_compile_options(earthshine_test_flags INTERFACE
  -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local> $<$<CONFIG:Release>:-O1>)
target_compile_definitions(earthshine_test_flags INTERFACE
  EARTHSHINE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" EARTHSHINE_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")

# add_layer_test(LAYER FILE...): one executable per layer, every TEST a CTest entry of its own.
function(add_layer_test layer)
  if(NOT TARGET earthshine_test_common)
    add_library(earthshine_test_common OBJECT ${PROJECT_SOURCE_DIR}/cmake/common.cpp)
    target_link_libraries(earthshine_test_common PRIVATE
      earthshine_flags earthshine_test_flags fmt::fmt glm::glm GTest::gtest_main)
    target_precompile_headers(earthshine_test_common PRIVATE <gtest/gtest.h> ${earthshine_common_headers})
  endif()
  add_executable(${layer}_tests ${ARGN})
  target_link_libraries(${layer}_tests PRIVATE earthshine_${layer} earthshine_flags earthshine_test_flags
    fmt::fmt GTest::gtest_main)
  target_precompile_headers(${layer}_tests REUSE_FROM earthshine_test_common)
  set_target_properties(${layer}_tests PROPERTIES UNITY_BUILD ${EARTHSHINE_UNITY} UNITY_BUILD_BATCH_SIZE 4)
  gtest_discover_tests(${layer}_tests TEST_PREFIX ${layer}/ DISCOVERY_TIMEOUT 60)
endfunction()
