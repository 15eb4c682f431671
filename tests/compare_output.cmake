# SPDX-License-Identifier: MIT
# cmake -DCOMMAND=... -DEXPECTED=FILE [-DFAILURE=1] -P compare_output.cmake
# Runs a command; fails unless it succeeds (with FAILURE, unless it fails) and prints exactly what the file holds.
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE output RESULT_VARIABLE result)
if((FAILURE AND result EQUAL 0) OR (NOT FAILURE AND NOT result EQUAL 0))
  message(FATAL_ERROR "exit code ${result}\n${output}")
endif()
file(READ ${EXPECTED} expected)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "printed:\n${output}\nbut ${EXPECTED} holds:\n${expected}")
endif()
