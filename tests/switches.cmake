# SPDX-License-Identifier: MIT
# Every combination of the switches of config.h that leave out a part of decoding.
set(SWITCH_COMBINATIONS no_voids only_balanced only_balanced.no_voids only_quick only_quick.no_voids)

# The switches of a combination, the digits of the codings that are left, and whether voids are (1 or 0).
macro(read_combination combination)
  string(TOUPPER ${combination} switches)
  string(REPLACE "." ";" switches ${switches})
  set(codings 123)
  if("ONLY_BALANCED" IN_LIST switches)
    set(codings 2)
  elseif("ONLY_QUICK" IN_LIST switches)
    set(codings 1)
  endif()
  set(voids 1)
  if("NO_VOIDS" IN_LIST switches)
    set(voids 0)
  endif()
endmacro()

# The decoder in one source with the switches of a combination, which read_combination has read.
function(add_small_decoder target)
  get_target_property(sources amalgamation SOURCES)
  get_target_property(options amalgamation COMPILE_OPTIONS)
  add_library(${target} STATIC ${sources})
  add_dependencies(${target} amalgamation)  # which makes the sources, in another folder
  target_include_directories(${target} PUBLIC $<TARGET_PROPERTY:amalgamation,INTERFACE_INCLUDE_DIRECTORIES>)
  list(TRANSFORM switches PREPEND MICROTIN_ OUTPUT_VARIABLE definitions)
  target_compile_definitions(${target} PUBLIC MICROTIN_INDEX_BITS=${MICROTIN_INDEX_BITS} PRIVATE ${definitions})
  target_compile_options(${target} PRIVATE ${options})
  set_target_properties(${target} PROPERTIES CXX_STANDARD 14 CXX_STANDARD_REQUIRED ON CXX_CLANG_TIDY "")
endfunction()
