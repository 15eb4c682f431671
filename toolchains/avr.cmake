# SPDX-License-Identifier: MIT
# An ATmega1284P: 16-bit int, 128 KB of flash, 16 KB of RAM; avr-libc starts it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR avr)

set(CMAKE_CXX_COMPILER avr-g++)
set(CMAKE_CXX_FLAGS_INIT "-mmcu=atmega1284p -mcall-prologues -mstrict-X")  # 8 % less code

set(MICROTIN_RUNTIME ${CMAKE_CURRENT_LIST_DIR}/avr/machine.cpp)
set(MICROTIN_RUN ${CMAKE_CURRENT_LIST_DIR}/run.sh)
set(MICROTIN_MACHINES atmega1284p)
set(MICROTIN_CAPACITY_atmega1284p 300)  # vertices that fit beside the stack
set(MICROTIN_O2_DEFINITIONS MICROTIN_WITHOUT_SEGMENTS)  # for which the flash is too small, at -O2
