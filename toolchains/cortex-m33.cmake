# SPDX-License-Identifier: MIT
set(MICROTIN_CORE cortex-m33)
set(MICROTIN_MACHINES mps2-an505)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)
