# cmake -DNM=... -DOBJDUMP=... -DLIBRARY=... -P symbols.cmake
# Rejects a library that needs anything from outside but the four mem functions and the compiler's
# arithmetic helpers, or that holds writable data, static constructors or unwind tables.

set(mem "mem(cpy|move|set|cmp)")
set(arm "__aeabi_(mem(cpy|move|set|clr)[48]?|u?idiv(mod)?|u?ldivmod|lmul|llsl|llsr|lasr|u?lcmp)")
set(thumb1 "__gnu_thumb1_case_[us]?(q|h|s)i")
set(allowed_symbol "^(${mem}|${arm}|${thumb1}|__[a-z]+[sd]i[0-9])$")
set(forbidden_section "^\\.([td]?(data|bss)|init_array|ctors|eh_frame|gcc_except_table|ARM\\.ex)")

# "name type ..." for each symbol; U and w are wanted from elsewhere, maybe from another object here.
execute_process(COMMAND ${NM} -P -g ${LIBRARY} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
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

# "index name size ..." for each section of each object.
execute_process(COMMAND ${OBJDUMP} -h ${LIBRARY} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n +[0-9]+ [^ ]+ +[0-9a-f]+" sections "${lines}")
foreach(section IN LISTS sections)
  string(REGEX REPLACE ".* ([^ ]+) +([0-9a-f]+)$" "\\1;\\2" section "${section}")
  list(POP_FRONT section name size)
  if(name MATCHES "${forbidden_section}" AND NOT size MATCHES "^0+$")
    list(APPEND held ${name})
  endif()
endforeach()

if(NOT provided)
  message(FATAL_ERROR "rejected: no symbols in ${LIBRARY}")
endif()
if(wanted OR held)
  message(FATAL_ERROR "rejected: ${wanted} ${held}")
endif()
