# SPDX-License-Identifier: MIT
# cmake -DNM=... -DOBJDUMP=... [-DOBJ2YAML=...] "-DOBJECTS=..." -P symbols.cmake
# Rejects a library's objects if they need anything from outside but the four mem functions and the compiler's
# arithmetic and prologue helpers, or hold writable data, static constructors or unwind tables.

set(mem "mem(cpy|move|set|cmp)")
set(arm "__aeabi_(mem(cpy|move|set|clr)[48]?|u?idiv(mod)?|u?ldivmod|lmul|llsl|llsr|lasr|u?lcmp)")
set(arithmetic "__[a-z]+[qhsd]i[0-9](_s8)?")
set(registers "__(prologue_save|epilogue_restore)s__")
set(switch "__gnu_thumb1_case_[us]?[qhs]i|__tablejump2__")
set(allowed_symbol "^(${mem}|${arm}|${arithmetic}|${switch}|${registers}|__stack_pointer)$")
set(forbidden_section
  "^\\.([st]?(data|bss)|init_array|ctors|eh_frame|gcc_except_table|ARM\\.ex)|^InitFunctions")

# "name type ..." for each symbol; U and w are wanted from elsewhere, maybe from another object here.
execute_process(COMMAND ${NM} -P -g ${OBJECTS} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+ [A-Za-z]( [^\n]*)?\n" symbols "${lines}")
foreach(symbol IN LISTS symbols)
  string(REGEX REPLACE "^([^ ]+) ([A-Za-z]).*" "\\1;\\2" symbol "${symbol}")
  list(POP_FRONT symbol name type)
  if(type MATCHES "[Uw]")
    list(APPEND wanted ${name})
  else()
    list(APPEND provided ${name})
  endif()
endforeach()
list(REMOVE_DUPLICATES wanted)
list(REMOVE_ITEM wanted ${provided})
list(FILTER wanted EXCLUDE REGEX ${allowed_symbol})

# The names of what is not empty: sections of each object, or segments and the like of WebAssembly.
foreach(object IN LISTS OBJECTS)
  if(OBJ2YAML)
    execute_process(COMMAND ${OBJ2YAML} ${object} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL "(\\.[a-z][^\n]*|InitFunctions:)\n" names "${lines}")
    list(APPEND sections ${names})
  else()
    # "index name size ..."
    execute_process(COMMAND ${OBJDUMP} -h ${object} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL "\n *[0-9]+ [^ ]+ +0*[1-9a-f]" names "${lines}")
    list(TRANSFORM names REPLACE "\n *[0-9]+ ([^ ]+) .*" "\\1")
    list(APPEND sections ${names})
    if(lines MATCHES "elf32-avr")
      string(APPEND forbidden_section "|^\\.rodata")  # lies in RAM there
    endif()
  endif()
endforeach()
list(FILTER sections INCLUDE REGEX ${forbidden_section})

if(NOT provided)
  message(FATAL_ERROR "rejected: no symbols in ${OBJECTS}")
endif()
if(wanted OR sections)
  message(FATAL_ERROR "rejected: ${wanted} ${sections}")
endif()
