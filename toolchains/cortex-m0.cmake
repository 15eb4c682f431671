set(MICROTIN_CORE cortex-m0)
set(MICROTIN_MACHINES mps2-an385 microbit)
include(${CMAKE_CURRENT_LIST_DIR}/arm/toolchain.cmake)
