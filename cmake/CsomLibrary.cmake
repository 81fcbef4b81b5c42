# SPDX-License-Identifier: BSD-3-Clause
# One way to declare a library, a program and a test, with the project's warnings.

add_library(csom_warnings INTERFACE)
# clang, which fuzzing needs, warns of other things.
target_compile_options(csom_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow
  $<$<CXX_COMPILER_ID:GNU>:-Werror>)

# csom_add_library(core SOURCES … LINK … [PRIVATE_LINK …] [SHARED])
function(csom_add_library name)
  cmake_parse_arguments(arg "SHARED" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  set(kind STATIC)
  if(arg_SHARED)
    set(kind SHARED)
  endif()
  add_library(csom-${name} ${kind} ${arg_SOURCES})
  add_library(csom::${name} ALIAS csom-${name})
  set_target_properties(csom-${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(csom-${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(csom-${name} PUBLIC cxx_std_17)
  target_link_libraries(csom-${name} PUBLIC ${arg_LINK} PRIVATE ${arg_PRIVATE_LINK} $<BUILD_INTERFACE:csom_warnings>)
  set_property(GLOBAL APPEND PROPERTY CSOM_LIBRARIES csom-${name})
endfunction()

# csom_add_module(vdb OF exports SOURCES … LINK …): csom-vdb.so, which csom::exports loads when it is
# first needed (csom/io/Module.h).
function(csom_add_module name)
  cmake_parse_arguments(arg "" "OF" "SOURCES;LINK" ${ARGN})
  add_library(csom-${name} MODULE ${arg_SOURCES})
  set_target_properties(csom-${name} PROPERTIES PREFIX "")
  target_link_libraries(csom-${name} PRIVATE ${arg_LINK} csom_warnings)
  add_dependencies(csom-${arg_OF} csom-${name})
  install(TARGETS csom-${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# csom_add_test(core/GridTest LINK csom::core …): test/core/GridTest.cpp becomes a program of its own,
# which the target tests-core builds.
#   SOURCES …   further source files
#   REAL_DATA   label `real-data`: needs the folder named by the environment variable CSOM_DATA
#   MRPT_APPS   label `mrpt-apps`: loads the plug-in into MRPT's own programs
#   RUN_SERIAL  runs alone: for tests that need the whole machine's memory or processors
function(csom_add_test path)
  cmake_parse_arguments(arg "REAL_DATA;MRPT_APPS;RUN_SERIAL" "" "SOURCES;LINK" ${ARGN})
  string(REPLACE "/" "_" target ${path})
  add_executable(${target} ${CMAKE_SOURCE_DIR}/test/${path}.cpp ${arg_SOURCES})
  get_filename_component(folder ${path} DIRECTORY)
  if(NOT TARGET tests-${folder})
    add_custom_target(tests-${folder})
  endif()
  add_dependencies(tests-${folder} ${target})
  target_link_libraries(${target} PRIVATE ${arg_LINK} csom_warnings GTest::gmock GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/test)
  target_compile_definitions(${target} PRIVATE
    CSOM_SOURCE_DIR="${CMAKE_SOURCE_DIR}" CSOM_BINARY_DIR="${CMAKE_BINARY_DIR}"
    CSOM_PROGRAM="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/csom"
    CSOM_PLUGIN="${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/libcsom-maps.so")
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
