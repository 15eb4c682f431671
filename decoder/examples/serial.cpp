// SPDX-License-Identifier: MIT
// A terrain that arrives over a serial port: the interrupt puts bytes into a ring, the main loop
// decodes from there, never for longer than a few steps.
#include "microtin/microtin.hpp"
#include "print.h"

namespace {

// A CMSDK UART of the MPS2 boards, the second.
class Uart {
 public:
  static constexpr uint32_t kInterrupt = 2;

  static void open() {
    at(kBaudDivider) = 16;
    at(kControl) = kReceive | kInterrupts;
  }
  static bool has_byte() { return (at(kState) & kFull) != 0; }
  static uint8_t take() { return static_cast<uint8_t>(at(kData)); }
  static void acknowledge() { at(kInterruptStatus) = kReceived; }

  // Until listen() a byte stays where it is and the sender waits, as for a line RTS.
  static void pause() { at(kControl) = kReceive; }
  static void listen() {
    at(kControl) = kReceive | kInterrupts;
    if (has_byte()) pend_interrupt();  // it came during the pause and raised none
  }

 private:
  static void pend_interrupt() {
    *reinterpret_cast<volatile uint32_t*>(0xE000E200) = 1u << kInterrupt;
  }

  enum Register { kData, kState, kControl, kInterruptStatus, kBaudDivider };
  static constexpr uint32_t kFull = 2, kReceive = 2, kInterrupts = 8, kReceived = 2;

  static volatile uint32_t& at(Register r) {
    return reinterpret_cast<volatile uint32_t*>(0x40005000)[r];
  }
};

// One writer, the interrupt; one reader, the main loop.
class Ring {
 public:
  bool full() const { return static_cast<uint8_t>(head_ - tail_) == kSize; }
  void put(uint8_t byte) {
    bytes_[head_ % kSize] = byte;
    head_ = static_cast<uint8_t>(head_ + 1);
  }

  // The oldest bytes, as many as lie in a row.
  const uint8_t* oldest() const { return bytes_ + tail_ % kSize; }
  size_t in_a_row() const {
    const uint8_t held = static_cast<uint8_t>(head_ - tail_);
    const uint8_t to_end = static_cast<uint8_t>(kSize - tail_ % kSize);
    return held < to_end ? held : to_end;
  }
  void drop(size_t count) { tail_ = static_cast<uint8_t>(tail_ + count); }

 private:
  static constexpr uint8_t kSize = 64;
  uint8_t bytes_[kSize];
  volatile uint8_t head_, tail_;  // 0 at the start, as all static memory
};

Ring ring;

void on_received() {
  Uart::acknowledge();
  while (Uart::has_byte() && !ring.full()) ring.put(Uart::take());
  if (ring.full()) Uart::pause();
}

// Sends interrupts of the port to on_received.
void catch_interrupts() {
  using Handler = void (*)();
  static Handler vectors[32] __attribute__((aligned(128)));
  vectors[16 + Uart::kInterrupt] = on_received;
  *reinterpret_cast<volatile uint32_t*>(0xE000ED08) = reinterpret_cast<uint32_t>(vectors);
  *reinterpret_cast<volatile uint32_t*>(0xE000E100) = 1u << Uart::kInterrupt;
}

}  // namespace

int firmware_main() {
  static microtin::Terrain<1000> terrain;
  static microtin::Decoder<1000> decoder(terrain);
  catch_interrupts();
  Uart::open();
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
    const size_t size = ring.in_a_row();
    size_t used = 0;
    status = decoder.feed(ring.oldest(), size, &used, 20);
    ring.drop(used);
    Uart::listen();
    // A control loop has its turn here.
  }
  print("status ");
  print_number(status);
  print("\n");
  print_number(static_cast<int32_t>(terrain.vertices()));
  print(" vertices from ");
  print_number(static_cast<int32_t>(decoder.bytes_used()));
  print(" bytes\n");
  return status == MICROTIN_STATUS_OK ? 0 : 1;
}
