# SPDX-License-Identifier: MIT
# The encoder and the command line for 64-bit Windows: mingw-w64 makes static programs, which wine runs.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)

set(prefix x86_64-w64-mingw32)
set(CMAKE_C_COMPILER ${prefix}-gcc-posix)
set(CMAKE_CXX_COMPILER ${prefix}-g++-posix)  # the other one has no std::thread
set(CMAKE_RC_COMPILER ${prefix}-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-static")
find_program(MICROTIN_WINE wine)
if(MICROTIN_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${MICROTIN_WINE})
endif()

# zlib is mingw's own.
set(CMAKE_FIND_ROOT_PATH /usr/${prefix})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)

set(MICROTIN_HOST_HEADERS CLI stb)
include(${CMAKE_CURRENT_LIST_DIR}/host_headers.cmake)
