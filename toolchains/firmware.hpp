// What a firmware program gets from its start-up code, whatever the target.
#ifndef MICROTIN_TOOLCHAINS_FIRMWARE_HPP
#define MICROTIN_TOOLCHAINS_FIRMWARE_HPP

// Written by the program. Its result becomes the emulator's exit code.
int firmware_main();

// Prints one character on the emulator's console.
void put_char(char c);

#endif
