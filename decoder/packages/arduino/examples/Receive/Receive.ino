// SPDX-License-Identifier: MIT
// A terrain that arrives on the serial port, decoded as it comes: `cat area.mtin >/dev/ttyACM0`.
#include <microtin.h>

static const uint32_t kMost = 100;  // vertices; about 6 KB of RAM
static microtin::Terrain<kMost> terrain(microtin::defer_init);
static microtin::Decoder<kMost> decoder(microtin::defer_init);
static microtin_status status = MICROTIN_STATUS_NEED_INPUT;

void setup() {
  Serial.begin(115200);
  terrain.begin();
  decoder.begin(terrain);
}

void loop() {
  if (status != MICROTIN_STATUS_NEED_INPUT || Serial.available() == 0) return;
  const uint8_t byte = static_cast<uint8_t>(Serial.read());
  size_t used = 0;
  status = decoder.feed(&byte, 1, &used);
  if (status == MICROTIN_STATUS_NEED_INPUT) return;
  Serial.print(terrain.vertices());
  Serial.print(" vertices, status ");
  Serial.println(static_cast<int>(status));
}
