# SPDX-License-Identifier: MIT
# The help pages keep their form; the manual page and completions have what the help pages have.
foreach(document pages manual bash zsh)
  add_test(NAME cli.${document}
    COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/cli/${document}.sh $<TARGET_FILE:microtin>)
  set_tests_properties(cli.${document} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()

# The page of the documents is what the program prints: microtin reference > encoder/docs/command-line.md
if(NOT MICROTIN_WITH_GDAL)  # which adds options
  add_test(NAME cli.reference COMMAND ${CMAKE_COMMAND} "-DCOMMAND=$<TARGET_FILE:microtin>;reference"
    -DEXPECTED=${PROJECT_SOURCE_DIR}/encoder/docs/command-line.md -P ${CMAKE_CURRENT_SOURCE_DIR}/compare_output.cmake)
endif()

# Its versions are those of the documents.
foreach(kind stream pack)
  file(STRINGS ${PROJECT_SOURCE_DIR}/shared/docs/format-${kind}.md title LIMIT_COUNT 1)
  string(REGEX MATCH "version ([0-9]+)$" title "${title}")
  set(${kind}_version ${CMAKE_MATCH_1})
endforeach()
add_test(NAME cli.version COMMAND microtin --version)
set_tests_properties(cli.version PROPERTIES
  PASS_REGULAR_EXPRESSION "^microtin ${PROJECT_VERSION}\nstream format ${stream_version}\npack format ${pack_version}\n$")
