# SPDX-License-Identifier: BSD-3-Clause
# How everything here is compiled, and one way to declare a part, a library and a module.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# The build tree is laid out like an installed prefix, so that programs find the label sets the same way.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
  endif()
  find_program(CCACHE_PROGRAM ccache)
  if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
    if(CSOM_PRECOMPILE_HEADERS)
      # What ccache wants for precompiled headers.
      set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
      add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
    endif()
  endif()
endif()

# The presets make errors of them (CMAKE_COMPILE_WARNING_AS_ERROR).
add_library(csom_warnings INTERFACE)
target_compile_options(csom_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)

# csom_precompile(csom-maps <Eigen/Geometry> …): large headers of others, for CSOM_PRECOMPILE_HEADERS.
# Sources include what they need all the same: a build without that switch says so.
function(csom_precompile target)
  if(CSOM_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# csom_part(EXPORTS NEEDS IO …): refuses a choice of CSOM_BUILD_… that cannot be.
function(csom_part name)
  cmake_parse_arguments(arg "" "" "NEEDS" ${ARGN})
  foreach(needed ${arg_NEEDS})
    if(CSOM_BUILD_${name} AND NOT CSOM_BUILD_${needed})
      message(FATAL_ERROR "CSOM_BUILD_${name} needs CSOM_BUILD_${needed}, which is OFF: "
        "switch that on, or CSOM_BUILD_${name} off")
    endif()
  endforeach()
endfunction()

# find_package(… REQUIRED) whose targets are seen everywhere: whoever links a library of ours, in
# whichever folder, links what that one needs. (CMake 3.24 has find_package(… GLOBAL).)
macro(csom_find_package)
  find_package(${ARGN} REQUIRED)
  get_property(csom_imported DIRECTORY PROPERTY IMPORTED_TARGETS)
  foreach(csom_target IN LISTS csom_imported)
    set_target_properties(${csom_target} PROPERTIES IMPORTED_GLOBAL TRUE)
  endforeach()
endmacro()

# csom_add_library(core LINK … [PRIVATE_LINK …] [SHARED] [SOURCES …] [PRECOMPILE …]): all of src/, and
# SOURCES that lie elsewhere. PRECOMPILE: headers for csom_precompile().
function(csom_add_library name)
  cmake_parse_arguments(arg "SHARED" "" "SOURCES;LINK;PRIVATE_LINK;PRECOMPILE" ${ARGN})
  set(kind STATIC)
  if(arg_SHARED)
    set(kind SHARED)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  add_library(csom-${name} ${kind} ${sources} ${arg_SOURCES})
  add_library(csom::${name} ALIAS csom-${name})
  set_target_properties(csom-${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(csom-${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(csom-${name} PUBLIC cxx_std_17)
  target_link_libraries(csom-${name} PUBLIC ${arg_LINK} PRIVATE ${arg_PRIVATE_LINK} $<BUILD_INTERFACE:csom_warnings>)
  set_property(GLOBAL APPEND PROPERTY CSOM_LIBRARIES csom-${name})
  if(arg_PRECOMPILE)
    csom_precompile(csom-${name} ${arg_PRECOMPILE})
  endif()
endfunction()

# csom_add_module(vdb OF exports SOURCES … LINK …): csom-vdb.so, which csom::exports loads when it is
# first needed (csom/io/Module.h).
function(csom_add_module name)
  cmake_parse_arguments(arg "" "OF" "SOURCES;LINK" ${ARGN})
  add_library(csom-${name} MODULE ${arg_SOURCES})
  set_target_properties(csom-${name} PROPERTIES PREFIX "")
  target_include_directories(csom-${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(csom-${name} PRIVATE ${arg_LINK} csom_warnings)
  add_dependencies(csom-${arg_OF} csom-${name})
  if(CSOM_INSTALL)
    install(TARGETS csom-${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endfunction()

# csom_copy_data(labels io): config/labels/*.yaml beside the build's programs, where an installed
# prefix has them too; built with the library.
function(csom_copy_data folder library)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/config/${folder}/*.yaml)
  set(destination ${PROJECT_BINARY_DIR}/share/mrpt_csom/${folder})
  set(stamp ${CMAKE_CURRENT_BINARY_DIR}/${folder}.stamp)
  add_custom_command(OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${destination}
    COMMAND ${CMAKE_COMMAND} -E copy ${files} ${destination}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${files})
  add_custom_target(csom-${folder} ALL DEPENDS ${stamp})
  add_dependencies(csom-${library} csom-${folder})
endfunction()
