# SPDX-License-Identifier: MIT
set(MICROTIN_ARCHITECTURE rv32i)
include(${CMAKE_CURRENT_LIST_DIR}/riscv/toolchain.cmake)
