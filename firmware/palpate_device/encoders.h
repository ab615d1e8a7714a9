// Where the tip is. FILL IN the three functions.
#pragma once

#include <stdint.h>

// Switches the encoders on. Return false when one of them does not answer: the device then reports a
// fault and gives no force.
inline bool begin_encoders() {
  // FILL IN. Teensy: QuadEncoder or Encoder. RP2040: a PIO quadrature counter. ESP32: PCNT, by
  // ESP32Encoder. Absolute encoders (AS5047, AS5600): begin SPI or Wire here.
  return true;
}

// Reads all three at the same moment, as nearly as can be. Return false when one is not to be
// trusted (no magnet, parity, no answer). It must not wait: a bus needs a time limit below 1 ms.
inline bool read_encoders(int32_t (&counts)[3]) {
  // FILL IN.
  counts[0] = counts[1] = counts[2] = 0;
  return true;
}

// Counts to micrometres from the middle of the workspace, right-handed, z up.
inline void tip_position(const int32_t (&counts)[3], int32_t (&position_um)[3]) {
  // FILL IN. For three straight axes this is all; for a linkage its forward kinematics stand here.
  constexpr float um_per_count[3] = {1.0F, 1.0F, 1.0F};
  for (uint8_t axis = 0; axis < 3; ++axis) {
    position_um[axis] = static_cast<int32_t>(static_cast<float>(counts[axis]) * um_per_count[axis]);
  }
}
