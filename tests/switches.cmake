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
