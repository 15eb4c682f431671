# SPDX-License-Identifier: MIT
# cmake -DCOMMAND=... -DEXPECTED=FILE -P compare_tiles.cmake
# Runs a command that prints the tiles of a pack; fails unless it prints, vertices and reasons aside, what the file holds.
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE output ERROR_VARIABLE refusal)
if(output STREQUAL "")
  set(output "${refusal}")
endif()
string(REGEX REPLACE "[-0-9]+ [-0-9]+ [-0-9]+\n" "" output "${output}")
string(REGEX REPLACE ": [^\n]*" "" output "${output}")
file(READ ${EXPECTED} expected)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "printed:\n${output}\nbut ${EXPECTED} holds:\n${expected}")
endif()
