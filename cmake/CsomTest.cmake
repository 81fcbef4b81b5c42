# SPDX-License-Identifier: BSD-3-Clause
# One way to declare a test.

# csom_add_test(core/GridTest LINK csom::core …): test/core/GridTest.cpp becomes a program of its own,
# which the target tests-core builds.
#   SOURCES …   further source files
#   INTERNALS … libraries whose src/ it includes, for tests of what is no public header
#   RUNS_CSOM   runs the program csom, and MRPT's with the plug-in
#   REAL_DATA   label `real-data`: needs the folder named by the environment variable CSOM_DATA
#   MRPT_APPS   label `mrpt-apps`: loads the plug-in into MRPT's own programs
#   RUN_SERIAL  runs alone: for tests that need the whole machine's memory or processors
function(csom_add_test path)
  cmake_parse_arguments(arg "RUNS_CSOM;REAL_DATA;MRPT_APPS;RUN_SERIAL" "" "SOURCES;LINK;INTERNALS"
    ${ARGN})
  string(REPLACE "/" "_" target ${path})
  add_executable(${target} ${PROJECT_SOURCE_DIR}/test/${path}.cpp ${arg_SOURCES})
  get_filename_component(folder ${path} DIRECTORY)
  if(NOT TARGET tests-${folder})
    add_custom_target(tests-${folder})
  endif()
  add_dependencies(tests-${folder} ${target})
  target_link_libraries(${target} PRIVATE ${arg_LINK} csom_warnings GTest::gmock GTest::gtest_main)
  # Tests of what takes long compute as much themselves; to compile the others takes longer than to run.
  if(NOT folder MATCHES "^(core|eval)$")
    csom_optimise_less(${target})
    csom_precompile_test(${target} "${arg_LINK}")
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  foreach(library ${arg_INTERNALS})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/libs/${library}/src)
  endforeach()
  target_compile_definitions(${target} PRIVATE
    CSOM_SOURCE_DIR="${PROJECT_SOURCE_DIR}" CSOM_BINARY_DIR="${PROJECT_BINARY_DIR}"
    CSOM_PROGRAM="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/csom"
    CSOM_PLUGIN="${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/libcsom-maps.so")
  if(arg_RUNS_CSOM)
    add_dependencies(${target} csom csom-maps)
  endif()
  # One label, as gtest_discover_tests() takes no lists; ctest matches labels by regular expression.
  set(label)
  if(arg_REAL_DATA)
    string(APPEND label "real-data ")
  endif()
  if(arg_MRPT_APPS)
    string(APPEND label "mrpt-apps ")
  endif()
  string(STRIP "${label}" label)
  set(properties TIMEOUT 600)
  if(label)
    list(APPEND properties LABELS "${label}")
  endif()
  if(arg_RUN_SERIAL)
    list(APPEND properties RUN_SERIAL TRUE)
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${path}." DISCOVERY_TIMEOUT 60
    PROPERTIES ${properties})
endfunction()

function(csom_optimise_less target)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# Headers of others that nearly all tests include, read once for those with MRPT and once for the others.
function(csom_precompile_test target libraries)
  # Code that is watched for races is compiled with other switches.
  if(NOT CSOM_PRECOMPILE_HEADERS OR libraries MATCHES "-tsan")
    return()
  endif()
  set(headers <gmock/gmock.h> <gtest/gtest.h> <Eigen/Geometry> <map> <string> <vector>)
  set(link GTest::gmock GTest::gtest_main Eigen3::Eigen)
  set(of csom_test_headers)
  if(libraries MATCHES "csom::(maps|rawlog|protocols)")
    set(of csom_mrpt_test_headers)
    list(APPEND headers <mrpt/maps/CMetricMap.h> <mrpt/obs/CObservation.h> <mrpt/poses/CPose3D.h>)
    list(APPEND link mrpt::maps mrpt::obs)
  endif()
  if(NOT TARGET ${of})
    # A program, as tests are: code of libraries is compiled with other switches.
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test/${of}.cpp CONTENT "int main() { return 0; }\n")
    add_executable(${of} EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/test/${of}.cpp)
    target_link_libraries(${of} PRIVATE ${link} csom_warnings)
    csom_optimise_less(${of})
    csom_precompile(${of} ${headers})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${of})
endfunction()

# csom_add_other_tests(core [WITHOUT …Test …] LINK … …): every test/core/…Test.cpp that has not been
# added yet, each as by csom_add_test() with these arguments.
function(csom_add_other_tests folder)
  cmake_parse_arguments(arg "" "" "WITHOUT;LINK;INTERNALS" ${ARGN})
  file(GLOB tests RELATIVE ${PROJECT_SOURCE_DIR}/test CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/test/${folder}/*Test.cpp)
  foreach(test ${tests})
    string(REGEX REPLACE "\\.cpp$" "" path ${test})
    string(REPLACE "/" "_" target ${path})
    get_filename_component(name ${path} NAME)
    if(NOT TARGET ${target} AND NOT name IN_LIST arg_WITHOUT)
      csom_add_test(${path} LINK ${arg_LINK} INTERNALS ${arg_INTERNALS} ${arg_UNPARSED_ARGUMENTS})
    endif()
  endforeach()
endfunction()
