// CRC-16/CCITT-FALSE.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace palpate {

// Bit by bit: a frame is some twenty bytes, and a table would cost flash that small boards lack.
inline uint16_t crc16(const uint8_t* data, size_t size) {
  uint16_t sum = 0xFFFF;
  for (size_t i = 0; i < size; ++i) {
    sum = static_cast<uint16_t>(sum ^ (static_cast<uint16_t>(data[i]) << 8));
    for (uint8_t bit = 0; bit < 8; ++bit) {
      const bool carry = (sum & 0x8000U) != 0;
      sum = static_cast<uint16_t>(sum << 1);
      if (carry) sum = static_cast<uint16_t>(sum ^ 0x1021U);
    }
  }
  return sum;
}

}  // namespace palpate
