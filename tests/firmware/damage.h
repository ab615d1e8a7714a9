// Streams of sound and damaged frames, the same from the same seed in C++ and in Rust
// (native/tests/device/damage.rs): one draws what the other draws, in the same order.
#pragma once

#include <palpate_link.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace damage {

using Payload = std::vector<uint8_t>;

// xorshift64* (Vigna 2016).
class Dice {
 public:
  explicit Dice(uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15U + 1) {}

  uint32_t below(uint32_t limit) {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<uint32_t>((state_ * 0x2545F4914F6CDD1DU) >> 33) % limit;
  }
  uint8_t byte() { return static_cast<uint8_t>(below(256)); }
  uint8_t not_zero() { return static_cast<uint8_t>(1 + below(255)); }
  // A byte that is often zero.
  uint8_t content() { return below(3) == 0 ? uint8_t{0} : byte(); }

 private:
  uint64_t state_;
};

// A piece of a stream, and what may rightly be read where it ends.
struct Chunk {
  std::vector<uint8_t> bytes;
  bool sound = false;  // A whole frame that nothing has touched.
  std::vector<Payload> payloads;
};

inline Payload payload(Dice& dice) {
  const auto with_content = [&dice](std::initializer_list<uint8_t> begin, int count) {
    Payload payload(begin);
    for (int i = 0; i < count; ++i) payload.push_back(dice.content());
    return payload;
  };
  switch (dice.below(9)) {
    case 0:
      return {1, static_cast<uint8_t>(dice.below(3))};
    case 1:
      return with_content({1, 1}, 35);
    case 2: {
      Payload fault{4};
      for (int i = 0; i < 3; ++i) fault.push_back(dice.byte());
      return fault;
    }
    case 3: {
      Payload force = with_content({3}, 8);
      force.push_back(static_cast<uint8_t>(dice.below(4)));
      return force;
    }
    case 4:
    case 5: {
      Payload state = with_content({2}, 19);
      state.push_back(static_cast<uint8_t>(dice.below(4)));
      return state;
    }
    case 6: {
      // Half a turn about an axis, or none; one in three with something beside it.
      Payload orientation = with_content({5}, 2);
      orientation.resize(11);
      const size_t largest = 3 + 2 * dice.below(4);
      orientation[largest] = 0xFF;
      orientation[largest + 1] = 0x7F;
      if (dice.below(3) == 0) {
        const size_t place = 3 + dice.below(8);
        orientation[place] = dice.byte();
      }
      return orientation;
    }
    default: {
      const int length = static_cast<int>(1 + dice.below(palpate::max_payload));
      return with_content({}, length);
    }
  }
}

inline std::vector<uint8_t> frame(const Payload& payload) {
  uint8_t frame[palpate::max_frame];
  const size_t size = palpate::write_frame(payload.data(), payload.size(), frame);
  return {frame, frame + size};
}

inline void hit(Dice& dice, Chunk& chunk) {
  std::vector<uint8_t>& bytes = chunk.bytes;
  const uint32_t length = static_cast<uint32_t>(bytes.size());
  const uint32_t at = dice.below(length);
  const auto flip = [&](uint32_t place) {
    bytes[place] = static_cast<uint8_t>(bytes[place] ^ (1U << dice.below(8)));
  };
  const auto insert = [&](uint8_t byte) { bytes.insert(bytes.begin() + at, byte); };
  switch (dice.below(11)) {
    case 0:
      return flip(at);
    case 1:
      for (uint32_t left = 2 + dice.below(16); left > 0; --left) flip(dice.below(length));
      return;
    case 2:
      bytes[at] = dice.byte();
      return;
    case 3:
      for (uint32_t left = 1 + dice.below(8); left > 0; --left) insert(dice.byte());
      return;
    case 4: {
      const uint32_t end = std::min(length, at + 1 + dice.below(8));
      bytes.erase(bytes.begin() + at, bytes.begin() + end);
      return;
    }
    case 5:
      bytes.resize(at);
      return;
    case 6: {
      const std::vector<uint8_t> copy = bytes;
      bytes.insert(bytes.end(), copy.begin(), copy.end());
      return;
    }
    case 7: {
      const Payload other = payload(dice);
      const std::vector<uint8_t> tail = frame(other);
      const uint32_t cut = dice.below(static_cast<uint32_t>(tail.size()));
      bytes.resize(at);
      bytes.insert(bytes.end(), tail.begin() + cut, tail.end());
      chunk.payloads.push_back(other);
      return;
    }
    case 8:
      for (uint32_t left = 1 + dice.below(20); left > 0; --left) insert(0);
      return;
    case 9:
      for (uint32_t left = 62 + dice.below(200); left > 0; --left) insert(dice.not_zero());
      return;
    default:
      bytes[length - 1] = dice.not_zero();
  }
}

inline Chunk next_chunk(Dice& dice) {
  Chunk chunk;
  const uint32_t kind = dice.below(16);
  if (kind == 0) {
    for (uint32_t left = 1 + dice.below(400); left > 0; --left) chunk.bytes.push_back(dice.byte());
  } else if (kind == 1) {
    // Few zeros and many small codes: deeper into the decoder.
    for (uint32_t left = 1 + dice.below(400); left > 0; --left) {
      const bool ends = dice.below(30) == 0;
      chunk.bytes.push_back(ends ? uint8_t{0} : static_cast<uint8_t>(1 + dice.below(6)));
    }
  } else if (kind == 2) {
    // Runs of three bytes, of which one in 2^16 is a payload with its checksum.
    for (uint32_t left = 1 + dice.below(100); left > 0; --left) {
      chunk.bytes.push_back(4);
      for (int i = 0; i < 3; ++i) chunk.bytes.push_back(dice.not_zero());
      chunk.bytes.push_back(0);
    }
  } else {
    chunk.payloads.push_back(payload(dice));
    chunk.bytes = frame(chunk.payloads[0]);
    chunk.sound = kind >= 7;
    if (!chunk.sound) hit(dice, chunk);
  }
  return chunk;
}

// FNV-1a of 64 bits (RFC 9923).
class Digest {
 public:
  void take(uint8_t byte) { value = (value ^ byte) * 0x100000001B3U; }
  void take(const uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) take(bytes[i]);
  }
  uint64_t value = 0xCBF29CE484222325U;
};

}  // namespace damage
