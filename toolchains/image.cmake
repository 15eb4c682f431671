# SPDX-License-Identifier: MIT
# Firmware images without an operating system: our start-up code instead of a C library.
set(MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/memory.cpp ${CMAKE_CURRENT_LIST_DIR}/start.cpp)
set(MICROTIN_LIBRARIES gcc)
set(MICROTIN_RUN ${CMAKE_CURRENT_LIST_DIR}/run.sh)
set(MICROTIN_LINKER_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/image.ld)

# A machine that images can be linked for: where its memories begin, and their bytes.
macro(add_machine name code_origin code_length ram_origin ram_length)
  set(MICROTIN_LINK_OPTIONS_${name}
    -nostdlib
    -Wl,--defsym=code_origin=${code_origin},--defsym=code_length=${code_length}
    -Wl,--defsym=ram_origin=${ram_origin},--defsym=ram_length=${ram_length}
    -T ${MICROTIN_LINKER_SCRIPT})
endmacro()
