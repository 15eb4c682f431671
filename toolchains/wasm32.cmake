# SPDX-License-Identifier: MIT
# WebAssembly, run by Node.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)

set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET wasm32)
set(CMAKE_AR llvm-ar)
set(CMAKE_RANLIB llvm-ranlib)
set(CMAKE_NM llvm-nm)
set(CMAKE_OBJDUMP llvm-objdump)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # no start-up code to link a program with yet

set(MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/memory.cpp
                     ${CMAKE_CURRENT_LIST_DIR}/wasm32/machine.cpp)
set(MICROTIN_RUN ${CMAKE_CURRENT_LIST_DIR}/run.sh)
set(MICROTIN_HARDWARE_FLOAT ON)
set(MICROTIN_OBJ2YAML obj2yaml)
set(MICROTIN_MACHINES node)
set(MICROTIN_LINK_OPTIONS_node
  -nostdlib -fuse-ld=lld -Wl,--no-entry -Wl,--stack-first -Wl,-z,stack-size=8192)
