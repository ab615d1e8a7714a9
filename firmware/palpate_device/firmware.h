// Between the link and the parts that are filled in; the same for all devices.
#pragma once

#include <palpate_link.h>
#include <string.h>

#include "board.h"
#include "config.h"
#include "encoders.h"
#include "motors.h"
#include "orientation.h"

namespace sketch {

// What FAULT tells of this firmware. Both stay until the board is switched off and on: after an error
// incremental encoders may have lost counts, and nobody has looked at the driver yet.
constexpr uint8_t fault_encoder = palpate::fault_first_of_maker;
constexpr uint8_t fault_motor = palpate::fault_first_of_maker + 1;

constexpr uint32_t period_us = 1000000UL / rate_hz;
// Bytes taken between two looks at the watchdog, so that a flood of them cannot hold it up.
constexpr uint8_t bytes_per_pass = 64;
// Velocity from differences of counts is rough; this much of each new one is taken.
constexpr float velocity_share = 0.2F;

inline palpate::DeviceHello make_hello() {
  palpate::DeviceHello hello;
  static_assert(sizeof device_name - 1 <= sizeof hello.name, "a name has at most 16 bytes");
  memcpy(hello.name, device_name, sizeof device_name - 1);
  hello.largest_force_n = largest_force_n;
  for (uint8_t axis = 0; axis < 3; ++axis) hello.half_extents_m[axis] = half_extents_m[axis];
  hello.rate_hz = rate_hz;
  hello.largest_damping = static_cast<uint16_t>(damping_ns_per_m * 100.0F + 0.5F);
  return hello;
}

// One sketch includes this file once, so plain variables serve.
static palpate::Device device(make_hello());
static bool encoders_answer = false;
static bool position_known = false;
static uint32_t last_tick_us = 0;
static int32_t position_um[3] = {0, 0, 0};
static float velocity_m_s[3] = {0.0F, 0.0F, 0.0F};

inline void hear() {
  uint8_t frame[palpate::max_frame];
  for (uint8_t i = 0; i < bytes_per_pass && Serial.available() > 0; ++i) {
    device.receive(static_cast<uint8_t>(Serial.read()), micros());
    while (line_has_room()) {
      const size_t size = device.answer(frame);
      if (size == 0) break;
      send(frame, size);
    }
  }
}

inline bool find_tip(int32_t (&counts)[3]) {
  if (!encoders_answer || !read_encoders(counts)) return false;
  int32_t now_um[3];
  tip_position(counts, now_um);
  for (uint8_t axis = 0; axis < 3; ++axis) {
    const int64_t moved_um = static_cast<int64_t>(now_um[axis]) - position_um[axis];
    // The first position is no movement.
    const float metres = position_known ? static_cast<float>(moved_um) * 1e-6F : 0.0F;
    velocity_m_s[axis] += velocity_share * (metres * rate_hz - velocity_m_s[axis]);
    position_um[axis] = now_um[axis];
  }
  position_known = true;
  return true;
}

inline void push_tip(const palpate::Drive& drive, const int32_t (&counts)[3]) {
  float force_n[3];
  const float asked = static_cast<float>(drive.damping) * 0.01F;
  const float damping = drive.damping > 0 ? asked : damping_ns_per_m;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    force_n[axis] = drive.force_n[axis];
    if (drive.damp) force_n[axis] -= damping * velocity_m_s[axis];
  }
  palpate::shorten(force_n, largest_force_n);
  if (!push(force_n, counts)) {
    motors_off();
    device.fail(fault_motor, 0);
  }
}

// Before its STATE; room for one whole frame is room for both.
inline void tell_orientation(const int32_t (&counts)[3]) {
  static_assert(palpate::orientation_size + 4 + palpate::state_size + 4 <= palpate::max_frame,
                "an ORIENTATION and its STATE must fit where the longest frame does");
  float unit[4];
  uint8_t frame[palpate::max_frame];
  if (read_orientation(counts, unit)) send(frame, device.orientation(unit, frame));
}

inline void tick(const palpate::Drive& drive) {
  int32_t counts[3] = {0, 0, 0};
  const bool found = find_tip(counts);
  if (!found) {
    motors_off();
    position_known = false;
    device.fail(fault_encoder, 0);
  } else if (drive.enabled || drive.damp) {
    push_tip(drive, counts);
  }
  if (!line_has_room()) return;
  if (tells_orientation && found) tell_orientation(counts);
  uint8_t frame[palpate::max_frame];
  const bool ready = encoders_answer && largest_force_n > 0.0F;
  send(frame, device.state(micros(), position_um, read_buttons(), ready, frame));
}

inline void start() {
  begin_motors();
  motors_off();
  begin_board();
  encoders_answer = begin_encoders();
  last_tick_us = micros();
}

inline void pass() {
  hear();
  const uint32_t now_us = micros();
  const palpate::Drive drive = device.drive(now_us);
  const bool driven = drive.enabled || drive.damp;
  // In every pass, not only in every tick: letting go does not wait.
  if (!driven) motors_off();
  beat(driven);
  // The watchdog may have something to tell.
  uint8_t frame[palpate::max_frame];
  if (line_has_room()) send(frame, device.answer(frame));
  const uint32_t late_us = now_us - last_tick_us;
  if (late_us < period_us) return;
  // A loop that was held up goes on from now; it does not catch up.
  last_tick_us = late_us < 2 * period_us ? last_tick_us + period_us : now_us;
  tick(drive);
}

}  // namespace sketch
