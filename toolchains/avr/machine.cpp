// SPDX-License-Identifier: MIT
// An ATmega under simavr: the serial port, and the end of the emulation.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "toolchains/firmware.h"

void put_char(char c) {
  while ((UCSR0A & _BV(UDRE0)) == 0) {
  }
  UDR0 = static_cast<uint8_t>(c);
}

// simavr ends when the processor sleeps with interrupts off; it passes on no exit code.
int main() {
  UCSR0B = _BV(TXEN0);
  const int code = firmware_main();
  if (code != 0) {
    for (const char* text = "failed\n"; *text != '\0'; ++text) put_char(*text);
  }
  cli();
  sleep_cpu();
  return code;
}
