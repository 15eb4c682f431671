// Start-up code for Arm Cortex-M under emulation: vectors, memory set-up, semihosting, and the four
// functions that compilers call even in freestanding code.
#include <stddef.h>
#include <stdint.h>

#include "toolchains/firmware.hpp"

extern "C" {
extern uint32_t data_start[], data_end[], bss_start[], bss_end[], stack_top[];
extern const uint32_t data_image[];

void* memcpy(void* to, const void* from, size_t size) {
  for (size_t i = 0; i < size; ++i) {
    static_cast<uint8_t*>(to)[i] = static_cast<const uint8_t*>(from)[i];
  }
  return to;
}

void* memmove(void* to, const void* from, size_t size) {
  if (to <= from) return memcpy(to, from, size);
  for (size_t i = size; i != 0; --i) {
    static_cast<uint8_t*>(to)[i - 1] = static_cast<const uint8_t*>(from)[i - 1];
  }
  return to;
}

void* memset(void* to, int value, size_t size) {
  for (size_t i = 0; i < size; ++i) static_cast<uint8_t*>(to)[i] = static_cast<uint8_t>(value);
  return to;
}

int memcmp(const void* a, const void* b, size_t size) {
  for (size_t i = 0; i < size; ++i) {
    const int difference = static_cast<const uint8_t*>(a)[i] - static_cast<const uint8_t*>(b)[i];
    if (difference != 0) return difference;
  }
  return 0;
}
}

namespace {

// Arm semihosting: an operation and one argument, served by the emulator.
constexpr uint32_t kWriteCharacter = 0x03;
constexpr uint32_t kExitExtended = 0x20;
constexpr uint32_t kApplicationExit = 0x20026;

void semihost(uint32_t operation, const void* argument) {
  register uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

[[noreturn]] void exit_emulator(int code) {
  const uint32_t block[2] = {kApplicationExit, static_cast<uint32_t>(code)};
  semihost(kExitExtended, block);
  for (;;) {
  }
}

void fault() {
  exit_emulator(125);
}

}  // namespace

void put_char(char c) {
  semihost(kWriteCharacter, &c);
}

extern "C" [[noreturn]] void reset() {
  const uint32_t* from = data_image;
  for (uint32_t* to = data_start; to != data_end; ++to) *to = *from++;
  for (uint32_t* to = bss_start; to != bss_end; ++to) *to = 0;
  exit_emulator(firmware_main());
}

namespace {

using Handler = void (*)();

// The first entries of the vector table: stack, reset, then NMI and the faults.
struct Vectors {
  uint32_t* stack;
  Handler handlers[6];
};

__attribute__((section(".vectors"), used))
const Vectors kVectors = {stack_top, {reset, fault, fault, fault, fault, fault}};

}  // namespace
