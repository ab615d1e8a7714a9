// How the stylus is turned. FILL IN the function if `tells_orientation` in config.h is true; else
// leave all as it is.
#pragma once

#include <stdint.h>

// Rotation from the stylus' axes to the device's as a unit quaternion w, x, y, z, at the moment of
// read_encoders(), whose counts these are. Return false when it is not to be trusted: nothing is told
// then, and after 20 ms the host gives no force. It must not wait.
inline bool read_orientation(const int32_t (&counts)[3], float (&unit)[4]) {
  // FILL IN. Angles of a gimbal: the product of its joints' quaternions, base first. A sensor of nine
  // axes: its fused quaternion, turned into the device's axes; slower than STATE, tell the last.
  (void)counts;
  unit[0] = 1.0F;
  unit[1] = unit[2] = unit[3] = 0.0F;
  return true;
}
