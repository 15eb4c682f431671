set(MICROTIN_ARCHITECTURE rv32imc)
include(${CMAKE_CURRENT_LIST_DIR}/riscv/toolchain.cmake)
