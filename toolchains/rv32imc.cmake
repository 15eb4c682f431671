# SPDX-License-Identifier: MIT
set(MICROTIN_ARCHITECTURE rv32imc)
set(MICROTIN_COUNTING_MACHINE virt)
include(${CMAKE_CURRENT_LIST_DIR}/riscv/toolchain.cmake)
