# SPDX-License-Identifier: MIT
set(MICROTIN_CORE cortex-m7)
set(MICROTIN_MACHINES mps2-an500)
set(MICROTIN_COUNTING_MACHINE mps2-an500)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)
