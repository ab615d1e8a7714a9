// Consistent overhead byte stuffing, for runs of less than 254 bytes: all that this link needs.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace palpate {

// `coded` takes size + 1 bytes, none of them zero. Returns how many were written; none when `plain`
// is too long for the short form.
inline size_t cobs_encode(const uint8_t* plain, size_t size, uint8_t* coded) {
  if (size > 253) return 0;
  size_t code_at = 0;
  for (size_t i = 0; i < size; ++i) {
    if (plain[i] == 0) {
      coded[code_at] = static_cast<uint8_t>(i + 1 - code_at);
      code_at = i + 1;
    } else {
      coded[i + 1] = plain[i];
    }
  }
  coded[code_at] = static_cast<uint8_t>(size + 1 - code_at);
  return size + 1;
}

// False when a code is zero or points past the end. `plain` may be `coded` itself: what is written
// never overtakes what is read.
inline bool cobs_decode(const uint8_t* coded, size_t size, uint8_t* plain, size_t& plain_size) {
  size_t read = 0;
  size_t written = 0;
  while (read < size) {
    const size_t code = coded[read];
    if (code == 0 || code > size - read) return false;
    if (read > 0) plain[written++] = 0;
    for (size_t i = 1; i < code; ++i) plain[written++] = coded[read + i];
    read += code;
  }
  plain_size = written;
  return true;
}

}  // namespace palpate
