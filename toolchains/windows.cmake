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

# CLI11 and stb are headers of the host. A folder of their own keeps its other headers away.
set(MICROTIN_HOST_INCLUDE /usr/include CACHE PATH "The folder that has the headers of CLI11 and stb")
if(NOT CMAKE_SOURCE_DIR MATCHES "CMakeFiles")  # not where CMake tries a compiler
  set(headers ${CMAKE_BINARY_DIR}/headers)
  file(MAKE_DIRECTORY ${headers})
  foreach(name CLI stb)
    file(CREATE_LINK ${MICROTIN_HOST_INCLUDE}/${name} ${headers}/${name} SYMBOLIC)
  endforeach()
  file(WRITE ${headers}/CLI11Config.cmake "add_library(CLI11::CLI11 INTERFACE IMPORTED)
set_target_properties(CLI11::CLI11 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${headers})\n")
  set(CLI11_DIR ${headers} CACHE PATH "")
  set(STB_INCLUDE_DIR ${headers} CACHE PATH "")
endif()
