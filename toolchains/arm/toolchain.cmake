# What the Arm Cortex-M toolchain files share; each names its core and QEMU machine, then includes it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR ${MICROTIN_CORE})

set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=${MICROTIN_CORE} -mthumb")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # no start-up code to link a program with yet

# Firmware images: our start-up code instead of a C library.
set(MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/runtime.cpp)
set(MICROTIN_LINKER_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/${MICROTIN_MACHINE}.ld)
set(CMAKE_CROSSCOMPILING_EMULATOR sh ${CMAKE_CURRENT_LIST_DIR}/run.sh ${MICROTIN_MACHINE})
