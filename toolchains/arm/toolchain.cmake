# SPDX-License-Identifier: MIT
# What the Arm Cortex-M toolchain files share; each names its core and QEMU machines, then includes it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR ${MICROTIN_CORE})

set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "-mcpu=${MICROTIN_CORE} -mthumb")
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT}")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # no start-up code to link a program with yet

include(${CMAKE_CURRENT_LIST_DIR}/../image.cmake)
list(APPEND MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/machine.cpp)
set(MICROTIN_CARD ${CMAKE_CURRENT_LIST_DIR}/../card.cpp)
add_machine(mps2-an385 0x00000000 4M 0x20000000 4M)
add_machine(mps2-an386 0x00000000 4M 0x20000000 4M)
add_machine(mps2-an500 0x00000000 4M 0x20000000 4M)
add_machine(mps2-an505 0x10000000 4M 0x38000000 4M)
add_machine(microbit 0x00000000 256K 0x20000000 16K)
set(MICROTIN_CAPACITY_microbit 300)  # vertices that fit beside the stack

# Instructions are counted by counter.cpp on MPS2 boards, with these options for the emulator.
set(MICROTIN_COUNTER ${CMAKE_CURRENT_LIST_DIR}/counter.cpp)
set(MICROTIN_COUNTING_OPTIONS "-icount shift=6")
