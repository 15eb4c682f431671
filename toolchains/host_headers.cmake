# SPDX-License-Identifier: MIT
# Headers of this host that a cross build of the tool takes, MICROTIN_HOST_HEADERS: those of CLI11 and stb, which are
# the same for any system. A folder of their own keeps the host's other headers away. Toolchain files include this one.
set(MICROTIN_HOST_INCLUDE /usr/include CACHE PATH "The folder that has the headers of CLI11 and stb")
if(NOT CMAKE_SOURCE_DIR MATCHES "CMakeFiles")  # not where CMake tries a compiler
  set(headers ${CMAKE_BINARY_DIR}/headers)
  file(MAKE_DIRECTORY ${headers})
  foreach(name IN LISTS MICROTIN_HOST_HEADERS)
    file(CREATE_LINK ${MICROTIN_HOST_INCLUDE}/${name} ${headers}/${name} SYMBOLIC)
  endforeach()
  file(WRITE ${headers}/CLI11Config.cmake "add_library(CLI11::CLI11 INTERFACE IMPORTED)
set_target_properties(CLI11::CLI11 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${headers})\n")
  set(CLI11_DIR ${headers} CACHE PATH "")
  set(STB_INCLUDE_DIR ${headers} CACHE PATH "")
endif()
