# SPDX-License-Identifier: MIT
set(MICROTIN_PROCESSOR s390x)
set(MICROTIN_PREFIX s390x-linux-gnu)
include(${CMAKE_CURRENT_LIST_DIR}/linux/toolchain.cmake)
