// Frames: COBS(payload + CRC) and a zero.
#pragma once

#include "cobs.h"
#include "crc16.h"

namespace palpate {

constexpr size_t max_frame = 62;  // On the wire, the closing zero counted.
constexpr size_t max_payload = max_frame - 4;

// Writes the frame of a payload; returns its length, or 0 when the payload is empty or too long.
inline size_t write_frame(const uint8_t* payload, size_t size, uint8_t (&frame)[max_frame]) {
  if (size == 0 || size > max_payload) return 0;
  uint8_t body[max_payload + 2];
  for (size_t i = 0; i < size; ++i) body[i] = payload[i];
  const uint16_t sum = crc16(payload, size);
  body[size] = static_cast<uint8_t>(sum & 0xFFU);
  body[size + 1] = static_cast<uint8_t>(sum >> 8);
  const size_t coded = cobs_encode(body, size + 2, frame);
  frame[coded] = 0;
  return coded + 1;
}

// Cuts a stream of bytes into payloads. After any damage it finds its way at the next zero.
class Receiver {
 public:
  // What was thrown away, in frames.
  uint32_t crc_errors = 0;
  uint32_t malformed = 0;

  // True when `byte` ends a sound frame: then payload() and size() hold until the next call.
  bool take(uint8_t byte) {
    if (byte != 0) {
      if (filled_ < sizeof buffer_) {
        buffer_[filled_++] = byte;
      } else {
        too_long_ = true;
      }
      return false;
    }
    const size_t filled = filled_;
    const bool too_long = too_long_;
    forget();
    if (filled == 0) return false;  // Zeros between frames are padding.
    // In place: the run is not needed any more once it is decoded.
    if (too_long || !cobs_decode(buffer_, filled, buffer_, size_) || size_ < 3) {
      ++malformed;
      return false;
    }
    size_ -= 2;
    const uint16_t sum = static_cast<uint16_t>(buffer_[size_] | (buffer_[size_ + 1] << 8));
    if (sum != crc16(buffer_, size_)) {
      ++crc_errors;
      return false;
    }
    return true;
  }

  // Drops a frame that was begun; the counts stay.
  void forget() {
    filled_ = 0;
    too_long_ = false;
  }

  const uint8_t* payload() const { return buffer_; }
  size_t size() const { return size_; }

 private:
  uint8_t buffer_[max_frame - 1] = {};
  size_t filled_ = 0;
  size_t size_ = 0;
  bool too_long_ = false;
};

}  // namespace palpate
