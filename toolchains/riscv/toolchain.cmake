# SPDX-License-Identifier: MIT
# What the RISC-V toolchain files share; each names its architecture, then includes it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR ${MICROTIN_ARCHITECTURE})

set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_C_FLAGS_INIT "-march=${MICROTIN_ARCHITECTURE} -mabi=ilp32")
set(CMAKE_CXX_COMPILER riscv64-unknown-elf-g++)
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT}")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # no start-up code to link a program with yet

include(${CMAKE_CURRENT_LIST_DIR}/../image.cmake)
list(APPEND MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/machine.cpp)
set(MICROTIN_CARD ${CMAKE_CURRENT_LIST_DIR}/../card.cpp)
set(MICROTIN_CARD_OPTIONS -semihosting-config enable=on,target=native)
set(MICROTIN_MACHINES virt)
add_machine(virt 0x80000000 4M 0x80400000 4M)

# Instructions are counted by counter.cpp, with these options for the emulator.
set(MICROTIN_COUNTER ${CMAKE_CURRENT_LIST_DIR}/counter.cpp)
set(MICROTIN_COUNTING_OPTIONS "-icount shift=0")
