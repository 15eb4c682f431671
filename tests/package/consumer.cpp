// SPDX-License-Identifier: MIT
// The same in C++.
#include <microtin/microtin.hpp>
#include <microtin/pack.hpp>

int main() {
  static microtin::Terrain<10> terrain;
  static microtin::Decoder<10> decoder(terrain);
  static microtin::Pack<1, 10> pack;
  size_t used = 0;
  const uint8_t bytes[7] = {'n', 'o', 't', ' ', 'o', 'n', 'e'};
  return decoder.feed(bytes, sizeof bytes, &used) == MICROTIN_STATUS_BAD_MAGIC &&
                 pack.status() == MICROTIN_STATUS_OK
             ? 0
             : 1;
}
