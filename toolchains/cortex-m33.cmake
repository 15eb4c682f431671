# SPDX-License-Identifier: MIT
set(MICROTIN_CORE cortex-m33)
set(MICROTIN_MACHINES mps2-an505)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)

# A machine of two cores, of which the first lacks some instructions, and what starts the second one.
add_machine(mps2-an521 0x10000000 4M 0x38000000 4M)
set(MICROTIN_MACHINE_OF_TWO_CORES mps2-an521)
set(MICROTIN_SECOND_CORE ${CMAKE_CURRENT_LIST_DIR}/arm/second_core.cpp)
set(MICROTIN_TWO_CORE_OPTIONS -mcpu=cortex-m33+nodsp)
