# SPDX-License-Identifier: MIT
set(MICROTIN_PROCESSOR i386)
set(MICROTIN_PREFIX i686-linux-gnu)
include(${CMAKE_CURRENT_LIST_DIR}/linux/toolchain.cmake)
