# SPDX-License-Identifier: BSD-3-Clause
# Counts the instructions of one insertion with callgrind and compares them with a committed number.
foreach(variable VALGRIND PROGRAM ARGUMENTS EXPECTED OUTPUT)
  if(NOT ${variable})
    message(FATAL_ERROR "${variable} is not set")
  endif()
endforeach()

# Symbols that are looked up at the first call would be counted as well.
set(ENV{LD_BIND_NOW} 1)
execute_process(
  COMMAND ${VALGRIND} --tool=callgrind --callgrind-out-file=${OUTPUT}
          --toggle-collect=csom::SemanticMap::insert* ${PROGRAM} ${ARGUMENTS}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0 OR NOT output MATCHES "Collected : ([0-9]+)")
  message(FATAL_ERROR "valgrind ${PROGRAM} ${ARGUMENTS}\nfailed (${result}):\n${output}")
endif()
set(counted ${CMAKE_MATCH_1})
message("${counted} instructions; ${EXPECTED} are committed")

math(EXPR most "2 * ${EXPECTED}")
math(EXPR least "${EXPECTED} / 2")
set(commit "write ${counted} in place of ${EXPECTED} in test/core/CMakeLists.txt")
if(counted GREATER most)
  message(FATAL_ERROR "An insertion (${ARGUMENTS}) takes more than twice the instructions that it took.\n"
    "Where they are: callgrind_annotate ${OUTPUT}\n"
    "If what they buy is worth it, ${commit} and say so in the commit message.")
elseif(counted LESS least)
  message(FATAL_ERROR "An insertion (${ARGUMENTS}) takes less than half the instructions that it took.\n"
    "If the work is still done, keep the gain guarded: ${commit}.")
endif()
