# SPDX-License-Identifier: MIT
# The encoder and the command line for 64-bit Arm with Linux, as static programs, which qemu-user runs anywhere.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)

set(prefix aarch64-linux-gnu)
set(CMAKE_C_COMPILER ${prefix}-gcc)
set(CMAKE_CXX_COMPILER ${prefix}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${prefix})
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
find_program(MICROTIN_QEMU qemu-aarch64)
if(MICROTIN_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${MICROTIN_QEMU})
endif()

# zlib is Debian's for arm64, whose headers are those of every architecture.
set(MICROTIN_HOST_HEADERS CLI stb zlib.h zconf.h)
include(${CMAKE_CURRENT_LIST_DIR}/host_headers.cmake)
set(ZLIB_INCLUDE_DIR ${CMAKE_BINARY_DIR}/headers CACHE PATH "")
set(ZLIB_LIBRARY /usr/lib/${prefix}/libz.a CACHE FILEPATH "")
