// Messages and their payloads, both directions.
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

namespace palpate {

constexpr uint8_t first_protocol = 1;    // No end tells how fresh its words are.
constexpr uint8_t protocol_version = 2;  // The newest one; a device that speaks it speaks both.

enum class Type : uint8_t { hello = 1, state = 2, force = 3, fault = 4, orientation = 5 };

constexpr uint8_t state_ready = 1;
constexpr uint8_t state_fault = 2;
constexpr uint8_t state_taken = 4;  // Protocol 2: a FORCE was taken in this session.
constexpr uint8_t force_enable = 1;
constexpr uint8_t force_damp = 2;

constexpr uint8_t fault_limp = 1;
constexpr uint8_t fault_protocol = 2;
constexpr uint8_t fault_first_of_maker = 128;

constexpr size_t host_hello_size = 2;
constexpr size_t device_hello_size = 37;
constexpr size_t state_size = 21;
constexpr size_t force_size = 10;
// What protocol 2 has behind these.
constexpr size_t device_hello_more = 2;
constexpr size_t state_more = 2;
constexpr size_t force_more = 8;
constexpr size_t fault_size = 4;
constexpr size_t orientation_size = 11;

constexpr int16_t quaternion_unit = 32767;  // What 1 is in an ORIENTATION.
// Shortest and longest quaternion that is believed, in its own steps: 1 % around a unit's.
constexpr int64_t quaternion_shortest = 32440;
constexpr int64_t quaternion_longest = 33094;

struct DeviceHello {
  uint8_t protocol = protocol_version;
  char name[16] = {};  // UTF-8, padded with zeros; all sixteen bytes may be used.
  uint8_t axes = 3;
  float largest_force_n = 0.0F;  // Zero: the device only measures.
  float half_extents_m[3] = {0.0F, 0.0F, 0.0F};
  uint16_t rate_hz = 1000;
  uint16_t largest_damping = 0;  // 0.01 N s/m, protocol 2; zero: the host asks for none.

  // Whether its figures can be those of a device. NaN compares false.
  bool is_sound() const {
    return is_amount(largest_force_n) && is_amount(half_extents_m[0]) &&
           is_amount(half_extents_m[1]) && is_amount(half_extents_m[2]);
  }

 private:
  static bool is_amount(float value) { return value >= 0.0F && value <= 3.4028234e38F; }
};

struct State {
  uint16_t sequence = 0;
  uint32_t time_us = 0;
  int32_t position_um[3] = {0, 0, 0};
  uint8_t buttons = 0;
  uint8_t flags = 0;
  bool tells = false;  // Protocol 2: the next is there.
  uint16_t taken = 0;  // Sequence of the last FORCE taken; nothing without state_taken.
};

struct Force {
  uint16_t sequence = 0;
  int16_t force_mn[3] = {0, 0, 0};
  uint8_t flags = 0;
  bool answers = false;        // Protocol 2: the next are there.
  uint32_t state_time_us = 0;  // Device time of the STATE that it answers.
  uint16_t age = 0;            // 10 us since that came to the host.
  uint16_t damping = 0;        // 0.01 N s/m.
};

struct Fault {
  uint8_t code = 0;
  uint16_t detail = 0;
};

// How the stylus is turned in the State of the same sequence, which follows.
struct Orientation {
  uint16_t sequence = 0;
  int16_t quaternion[4] = {quaternion_unit, 0, 0, 0};  // w, x, y, z; stylus to device.

  // Whether its length is that of a rotation, within 1 %.
  bool is_unit() const {
    int64_t square = 0;
    for (const int16_t part : quaternion) square += static_cast<int32_t>(part) * part;
    return square >= quaternion_shortest * quaternion_shortest &&
           square <= quaternion_longest * quaternion_longest;
  }
};

// The nearest to a unit quaternion w, x, y, z; false when it is none, which NaN is not either.
inline bool quantise(const float (&unit)[4], int16_t (&steps)[4]) {
  const float square =
      unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2] + unit[3] * unit[3];
  if (!(square >= 0.9801F && square <= 1.0201F)) return false;
  const float scale = static_cast<float>(quaternion_unit) / sqrtf(square);
  for (int i = 0; i < 4; ++i) {
    const float part = unit[i] * scale;
    steps[i] = static_cast<int16_t>(part < 0.0F ? part - 0.5F : part + 0.5F);
  }
  return true;
}

// Writes numbers one after the other, low byte first, whatever the board's own order.
class Packer {
 public:
  explicit Packer(uint8_t* to) : to_(to) {}

  void u8(uint8_t value) { to_[size_++] = value; }
  void u16(uint16_t value) {
    u8(static_cast<uint8_t>(value & 0xFFU));
    u8(static_cast<uint8_t>(value >> 8));
  }
  void u32(uint32_t value) {
    u16(static_cast<uint16_t>(value & 0xFFFFU));
    u16(static_cast<uint16_t>(value >> 16));
  }
  void f32(float value) {
    static_assert(sizeof value == 4, "the link's numbers are IEEE 754 of four bytes");
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    u32(bits);
  }
  size_t size() const { return size_; }

 private:
  uint8_t* to_;
  size_t size_ = 0;
};

// The inverse of Packer; the caller has compared the length.
class Unpacker {
 public:
  explicit Unpacker(const uint8_t* from) : from_(from) {}

  uint8_t u8() { return *from_++; }
  uint16_t u16() {
    const uint16_t low = u8();
    return static_cast<uint16_t>(low | (static_cast<uint16_t>(u8()) << 8));
  }
  uint32_t u32() {
    const uint32_t low = u16();
    return low | (static_cast<uint32_t>(u16()) << 16);
  }
  // By way of memcpy, since a cast of what does not fit is up to the compiler before C++20.
  int16_t i16() { return as<int16_t>(u16()); }
  int32_t i32() { return as<int32_t>(u32()); }
  float f32() { return as<float>(u32()); }

 private:
  template <class To, class From>
  static To as(From bits) {
    static_assert(sizeof(To) == sizeof(From), "the same bits read otherwise");
    To value;
    memcpy(&value, &bits, sizeof value);
    return value;
  }

  const uint8_t* from_;
};

inline size_t pack_host_hello(uint8_t protocol, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::hello));
  out.u8(protocol);
  return out.size();
}

inline size_t pack(const DeviceHello& hello, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::hello));
  out.u8(hello.protocol);
  for (const char letter : hello.name) out.u8(static_cast<uint8_t>(letter));
  out.u8(hello.axes);
  out.f32(hello.largest_force_n);
  for (const float extent : hello.half_extents_m) out.f32(extent);
  out.u16(hello.rate_hz);
  if (hello.protocol != first_protocol) out.u16(hello.largest_damping);
  return out.size();
}

inline size_t pack(const State& state, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::state));
  out.u16(state.sequence);
  out.u32(state.time_us);
  for (const int32_t um : state.position_um) out.u32(static_cast<uint32_t>(um));
  out.u8(state.buttons);
  out.u8(state.flags);
  if (state.tells) out.u16(state.taken);
  return out.size();
}

inline size_t pack(const Force& force, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::force));
  out.u16(force.sequence);
  for (const int16_t mn : force.force_mn) out.u16(static_cast<uint16_t>(mn));
  out.u8(force.flags);
  if (force.answers) {
    out.u32(force.state_time_us);
    out.u16(force.age);
    out.u16(force.damping);
  }
  return out.size();
}

inline size_t pack(const Fault& fault, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::fault));
  out.u8(fault.code);
  out.u16(fault.detail);
  return out.size();
}

inline size_t pack(const Orientation& orientation, uint8_t* payload) {
  Packer out(payload);
  out.u8(static_cast<uint8_t>(Type::orientation));
  out.u16(orientation.sequence);
  for (const int16_t part : orientation.quaternion) out.u16(static_cast<uint16_t>(part));
  return out.size();
}

inline bool is(const uint8_t* payload, size_t size, Type type, size_t wanted) {
  return size == wanted && payload[0] == static_cast<uint8_t>(type);
}

// True for any HELLO, whatever follows its first two bytes: these are all that may be read of a
// protocol other than one's own.
inline bool read_protocol(const uint8_t* payload, size_t size, uint8_t& protocol) {
  if (size < 2 || payload[0] != static_cast<uint8_t>(Type::hello)) return false;
  protocol = payload[1];
  return true;
}

inline bool unpack(const uint8_t* payload, size_t size, DeviceHello& hello) {
  const bool is_first = size > 1 && payload[1] == first_protocol;
  const size_t wanted = device_hello_size + (is_first ? 0 : device_hello_more);
  if (!is(payload, size, Type::hello, wanted)) return false;
  Unpacker in(payload + 1);
  hello.protocol = in.u8();
  for (char& letter : hello.name) letter = static_cast<char>(in.u8());
  hello.axes = in.u8();
  hello.largest_force_n = in.f32();
  for (float& extent : hello.half_extents_m) extent = in.f32();
  hello.rate_hz = in.u16();
  hello.largest_damping = is_first ? uint16_t{0} : in.u16();
  return (is_first || hello.protocol == protocol_version) && hello.is_sound();
}

inline bool unpack(const uint8_t* payload, size_t size, State& state) {
  state.tells = size == state_size + state_more;
  if (!is(payload, size, Type::state, state_size + (state.tells ? state_more : 0))) return false;
  Unpacker in(payload + 1);
  state.sequence = in.u16();
  state.time_us = in.u32();
  for (int32_t& um : state.position_um) um = in.i32();
  state.buttons = in.u8();
  state.flags = in.u8();
  state.taken = state.tells ? in.u16() : uint16_t{0};
  return true;
}

inline bool unpack(const uint8_t* payload, size_t size, Force& force) {
  force.answers = size == force_size + force_more;
  if (!is(payload, size, Type::force, force_size + (force.answers ? force_more : 0))) return false;
  Unpacker in(payload + 1);
  force.sequence = in.u16();
  for (int16_t& mn : force.force_mn) mn = in.i16();
  force.flags = in.u8();
  if (force.answers) {
    force.state_time_us = in.u32();
    force.age = in.u16();
    force.damping = in.u16();
  }
  return true;
}

inline bool unpack(const uint8_t* payload, size_t size, Fault& fault) {
  if (!is(payload, size, Type::fault, fault_size)) return false;
  Unpacker in(payload + 1);
  fault.code = in.u8();
  fault.detail = in.u16();
  return true;
}

inline bool unpack(const uint8_t* payload, size_t size, Orientation& orientation) {
  if (!is(payload, size, Type::orientation, orientation_size)) return false;
  Unpacker in(payload + 1);
  orientation.sequence = in.u16();
  for (int16_t& part : orientation.quaternion) part = in.i16();
  return orientation.is_unit();
}

}  // namespace palpate
