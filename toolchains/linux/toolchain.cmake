# SPDX-License-Identifier: MIT
# What the toolchain files for Linux on other processors share; each names its processor and its compiler's
# prefix, then includes it. Programs are static, so that they need no system of that kind to run.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${MICROTIN_PROCESSOR})

set(CMAKE_CXX_COMPILER ${MICROTIN_PREFIX}-g++)
set(CMAKE_CXX_FLAGS_INIT "-fno-pie")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-no-pie")

set(MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/machine.cpp)
set(MICROTIN_RUN ${CMAKE_CURRENT_LIST_DIR}/../run.sh)
set(MICROTIN_HARDWARE_FLOAT ON)
set(MICROTIN_MACHINES ${MICROTIN_PROCESSOR})
