# SPDX-License-Identifier: MIT
# What man and shells know of the program, printed by itself and installed with it.
include(GNUInstallDirs)

if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
  message(NOTICE "Left out: manual page and completions, which the program prints. It cannot run here; "
    "set CMAKE_CROSSCOMPILING_EMULATOR to a program that runs it.")
  return()
endif()

function(add_document name folder)
  set(file ${CMAKE_CURRENT_BINARY_DIR}/documents/${name})
  cmake_path(GET file PARENT_PATH parent)
  file(MAKE_DIRECTORY ${parent})
  add_custom_command(TARGET microtin POST_BUILD COMMAND microtin ${ARGN} > ${file} VERBATIM)
  install(FILES ${file} DESTINATION ${folder} COMPONENT tool)
endfunction()

add_document(microtin.1 ${CMAKE_INSTALL_MANDIR}/man1 manual)
add_document(bash/microtin ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
add_document(_microtin ${CMAKE_INSTALL_DATADIR}/zsh/site-functions completion zsh)
