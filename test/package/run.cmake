# SPDX-License-Identifier: BSD-3-Clause
# Installs the build tree, moves the prefix, builds the consumer against it and runs everything.
foreach(variable BINARY_DIR CONSUMER_DIR WORK_DIR GENERATOR CXX_COMPILER BUILD_TYPE BINDIR DATADIR)
  if(NOT ${variable})
    message(FATAL_ERROR "${variable} is not set")
  endif()
endforeach()

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nfailed (${result}):\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
set(ENV{DESTDIR} "")
run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/moved)

run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build
  -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
  -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)

# The examples, as their README says.
set(root ${CONSUMER_DIR}/../../..)
file(GLOB examples ${root}/examples/*/CMakeLists.txt)
list(LENGTH examples count)
if(NOT count EQUAL 4)
  message(FATAL_ERROR "${count} examples instead of 4")
endif()
foreach(list_file ${examples})
  get_filename_component(folder ${list_file} DIRECTORY)
  get_filename_component(name ${folder} NAME)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${folder} -B ${WORK_DIR}/examples/${name}
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/examples/${name})
  run(${CMAKE_COMMAND} -E chdir ${WORK_DIR}/examples/${name} ./example)
endforeach()

foreach(component core vision io exports mrpt_exports eval maps rawlog protocols report)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER_DIR}/one_component
    -B ${WORK_DIR}/one_component/${component} -DCOMPONENT=${component}
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved -DCMAKE_CXX_COMPILER=${CXX_COMPILER})
endforeach()
run(${CMAKE_COMMAND} --build ${WORK_DIR}/one_component/core)
run(${WORK_DIR}/one_component/core/one_component)

# Sources inside another project. Not optimised: Eigen takes long.
foreach(fetch OFF ON)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER_DIR}/subproject -B ${WORK_DIR}/subproject/${fetch}
    -DCSOM_SOURCES=${root} -DFETCH=${fetch} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_CXX_COMPILER_LAUNCHER=${COMPILER_LAUNCHER})
endforeach()
run(${CMAKE_COMMAND} --build ${WORK_DIR}/subproject/ON)
run(${WORK_DIR}/subproject/ON/one_component)

run(${WORK_DIR}/moved/${BINDIR}/csom --version)
# Its modules have moved along.
run(${WORK_DIR}/moved/${BINDIR}/csom map ${root}/rawlogs/room.rawlog -c ${root}/config/room.ini
  -o ${WORK_DIR}/room --poses icp --no-html)
foreach(file labels/semantickitti.yaml campus.ini)
  if(NOT EXISTS ${WORK_DIR}/moved/${DATADIR}/mrpt_csom/${file})
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()
# The prefix holds debug information and libraries of tens of megabytes.
file(REMOVE_RECURSE ${WORK_DIR})
