# SPDX-License-Identifier: MIT
# cmake -DCOMMAND=... -DEXPECTED=FILE -P compare_output.cmake
# Runs a command; fails unless it succeeds and prints exactly what the file holds.
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE output RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "exit code ${result}\n${output}")
endif()
file(READ ${EXPECTED} expected)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "printed:\n${output}\nbut ${EXPECTED} holds:\n${expected}")
endif()
