# SPDX-License-Identifier: MIT
set(MICROTIN_CORE cortex-m4)
set(MICROTIN_MACHINES mps2-an386)
set(MICROTIN_COUNTING_MACHINE mps2-an386)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)
