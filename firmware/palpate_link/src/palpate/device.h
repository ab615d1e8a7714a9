// What a device does with the link, in both protocols: answer, stream, obey, let go.
#pragma once

#include "frame.h"
#include "messages.h"

namespace palpate {

constexpr uint32_t watchdog_us = 20000;
constexpr uint32_t fresh_us = 20000;  // What answers an older STATE is too late to be obeyed.

enum class Mode : uint8_t {
  waiting,  // No host has said HELLO: silence, no force.
  limp,     // STATE streams, nobody drives.
  driven,   // A FORCE was heard within the last 20 ms.
  failed,   // The device has a fault of its own: STATE streams with the fault flag, no force.
};

// What the motors shall do now.
struct Drive {
  float force_n[3] = {0.0F, 0.0F, 0.0F};
  bool enabled = false;
  bool damp = false;
  uint16_t damping = 0;  // 0.01 N s/m, at most what HELLO offers; zero: the device's own choice.
};

// Shortens a vector to `limit`, keeping its direction. What is no number becomes zero.
inline void shorten(float (&vector)[3], float limit) {
  const float size =
      sqrtf(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
  if (size <= limit) return;
  // Written so that NaN and infinity anywhere end here and not at the motors.
  const bool usable = size <= 3.4028234e38F && limit >= 0.0F;
  const float scale = usable ? limit / size : 0.0F;
  for (float& component : vector) component = usable ? component * scale : 0.0F;
}

struct Counters {
  uint32_t hellos = 0;
  uint32_t forces = 0;      // Valid and taken, enabled or not.
  uint32_t lost = 0;        // Gaps in the sequence.
  uint32_t duplicates = 0;  // Not used.
  uint32_t late = 0;        // Not used.
  uint32_t refused = 0;     // Not used: it answers a STATE of too long ago.
  uint32_t unknown = 0;     // Sound frames of no known type or length.
  uint32_t unexpected = 0;  // FORCE of a host that has not said HELLO.
  uint32_t limp = 0;        // Times the watchdog ran out.
};

// The device's side of the link. Times are those of any clock of microseconds that wraps at 2^32,
// such as micros(); they must not run backwards from call to call.
class Device {
 public:
  explicit Device(const DeviceHello& hello) : hello_(hello) {}

  // As after power-on, for a port that was away; counters stay.
  void restart() {
    receiver_.forget();
    streaming_ = false;
    heard_ = any_taken_ = false;
    hello_due_ = limp_due_ = protocol_due_ = false;
  }

  // Takes one byte from the host. Empty the answers after each, or answers to several HELLO become
  // one.
  void receive(uint8_t byte, uint32_t now_us) {
    if (!receiver_.take(byte)) return;
    // A FORCE that comes too late must find the watchdog barked, also when nobody asked meanwhile.
    watch(now_us);
    const uint8_t* payload = receiver_.payload();
    const size_t size = receiver_.size();
    Force force;
    uint8_t protocol = 0;
    if (read_protocol(payload, size, protocol)) {
      take_hello(protocol, size);
    } else if (!unpack(payload, size, force)) {
      ++counters_.unknown;
    } else if (!streaming_) {
      ++counters_.unexpected;
    } else {
      take_force(force, now_us);
    }
  }

  // What the motors shall do. Asked at least every millisecond or so, it is also what keeps the
  // watchdog awake.
  Drive drive(uint32_t now_us) {
    watch(now_us);
    return mode() == Mode::driven ? drive_ : Drive();
  }

  // The next waiting answer (HELLO or FAULT); returns its length, 0 when there is none. Call it only
  // when a whole frame fits on the line: an answer that was handed out is forgotten.
  size_t answer(uint8_t (&frame)[max_frame]) {
    uint8_t payload[max_payload];
    if (hello_due_) {
      hello_due_ = false;
      DeviceHello said = hello_;
      if (streaming_) said.protocol = protocol_;
      return write_frame(payload, pack(said, payload), frame);
    }
    Fault fault;
    if (protocol_due_) {
      protocol_due_ = false;
      fault.code = fault_protocol;
      fault.detail = other_protocol_;
    } else if (limp_due_ && streaming_) {
      limp_due_ = false;
      fault.code = fault_limp;
      fault.detail = static_cast<uint16_t>(counters_.limp & 0xFFFFU);
    } else if (own_due_ && streaming_) {
      own_due_ = false;
      fault = own_fault_;
    } else {
      return 0;
    }
    return write_frame(payload, pack(fault, payload), frame);
  }

  // The next STATE; returns its length, 0 as long as no host has said HELLO. `ready` is whether the
  // motors would obey.
  size_t state(uint32_t now_us, const int32_t (&position_um)[3], uint8_t buttons, bool ready,
               uint8_t (&frame)[max_frame]) {
    if (!streaming_) return 0;
    State state;
    state.sequence = sequence_++;
    state.time_us = now_us;
    for (uint8_t axis = 0; axis < 3; ++axis) state.position_um[axis] = position_um[axis];
    state.buttons = buttons;
    if (failed_) {
      state.flags = state_fault;
    } else if (ready && hello_.is_sound()) {
      state.flags = state_ready;
    }
    state.tells = protocol_ != first_protocol;
    if (state.tells && any_taken_) {
      state.flags = static_cast<uint8_t>(state.flags | state_taken);
      state.taken = heard_sequence_;
    }
    uint8_t payload[max_payload];
    return write_frame(payload, pack(state, payload), frame);
  }

  // How the stylus is turned in the STATE that state() gives next: send this one first. `unit` is the
  // rotation from the stylus' axes to the device's, w, x, y, z. Returns its length; 0 as long as no
  // host has said HELLO, and for what is no unit quaternion.
  size_t orientation(const float (&unit)[4], uint8_t (&frame)[max_frame]) const {
    Orientation orientation;
    orientation.sequence = sequence_;
    if (!streaming_ || !quantise(unit, orientation.quaternion)) return 0;
    uint8_t payload[max_payload];
    return write_frame(payload, pack(orientation, payload), frame);
  }

  // A fault of the device's own, told once and shown in each STATE until recover(). Codes of makers
  // begin at fault_first_of_maker.
  void fail(uint8_t code, uint16_t detail) {
    if (failed_ && own_fault_.code == code) return;  // Said once, however often it is found.
    failed_ = own_due_ = true;
    own_fault_.code = code;
    own_fault_.detail = detail;
  }

  // The fault is over; the next FORCE is obeyed. Ramping up is the host's part.
  void recover() {
    if (!failed_) return;
    failed_ = own_due_ = false;
    // A force from before would come back at once and in full.
    drive_ = Drive();
  }

  Mode mode() const {
    if (!streaming_) return Mode::waiting;
    if (failed_) return Mode::failed;
    return heard_ ? Mode::driven : Mode::limp;
  }

  const DeviceHello& hello() const { return hello_; }
  const Counters& counters() const { return counters_; }
  const Receiver& receiver() const { return receiver_; }

 private:
  void watch(uint32_t now_us) {
    // A difference of unsigned numbers is right across the clock's wrap.
    if (!heard_ || static_cast<uint32_t>(now_us - heard_at_us_) < watchdog_us) return;
    heard_ = false;
    drive_ = Drive();
    limp_due_ = true;
    ++counters_.limp;
  }

  void take_hello(uint8_t protocol, size_t size) {
    const bool ours = protocol >= first_protocol && protocol <= hello_.protocol;
    if (ours && size != host_hello_size) {
      ++counters_.unknown;
      return;
    }
    ++counters_.hellos;
    hello_due_ = true;
    // A new session, or none: whatever was asked for before is void.
    heard_ = any_taken_ = false;
    drive_ = Drive();
    streaming_ = ours;
    if (ours) {
      protocol_ = protocol;
    } else {
      protocol_due_ = true;
      other_protocol_ = protocol;
    }
  }

  void take_force(const Force& force, uint32_t now_us) {
    if (force.answers != (protocol_ != first_protocol)) {
      ++counters_.unexpected;
      return;
    }
    // Letting go is never too late.
    if (force.answers && force.flags != 0 &&
        static_cast<uint32_t>(now_us - force.state_time_us) > fresh_us) {
      ++counters_.refused;
      return;
    }
    if (heard_) {
      const uint16_t ahead = static_cast<uint16_t>(force.sequence - heard_sequence_);
      if (ahead == 0) {
        ++counters_.duplicates;
        return;
      }
      if (ahead > 0x7FFF) {
        ++counters_.late;
        return;
      }
      counters_.lost += static_cast<uint32_t>(ahead - 1);
    }
    ++counters_.forces;
    heard_ = true;
    heard_at_us_ = now_us;
    heard_sequence_ = force.sequence;
    any_taken_ = true;
    drive_ = Drive();
    drive_.damp = (force.flags & force_damp) != 0 && (!force.answers || force.damping > 0);
    if (drive_.damp && force.answers) {
      const uint16_t most = hello_.largest_damping;
      drive_.damping = force.damping < most ? force.damping : most;
      drive_.damp = drive_.damping > 0;
    }
    drive_.enabled = (force.flags & force_enable) != 0 && hello_.is_sound();
    if (!drive_.enabled) return;
    for (uint8_t axis = 0; axis < 3; ++axis) {
      drive_.force_n[axis] = static_cast<float>(force.force_mn[axis]) * 1e-3F;
    }
    shorten(drive_.force_n, hello_.largest_force_n);
  }

  DeviceHello hello_;
  Counters counters_;
  Receiver receiver_;
  Drive drive_;
  Fault own_fault_;
  uint32_t heard_at_us_ = 0;
  uint16_t heard_sequence_ = 0;
  uint16_t sequence_ = 0;
  uint8_t protocol_ = first_protocol;
  uint8_t other_protocol_ = 0;
  bool streaming_ = false;
  bool heard_ = false;
  bool any_taken_ = false;
  bool failed_ = false;
  bool hello_due_ = false;
  bool protocol_due_ = false;
  bool limp_due_ = false;
  bool own_due_ = false;
};

}  // namespace palpate
