# SPDX-License-Identifier: MIT
set(MICROTIN_CORE cortex-m0)
set(MICROTIN_MACHINES mps2-an385 microbit)
set(MICROTIN_COUNTING_MACHINE mps2-an385)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)
