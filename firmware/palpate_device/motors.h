// What the tip is pushed with. FILL IN the three functions.
#pragma once

#include <stdint.h>

// Sets the drivers up, with all motors off. Called before anything else, so that pins do not float
// while the board starts.
inline void begin_motors() {
  // FILL IN. PWM beyond 20 kHz is not heard.
}

// No current in any motor, by the drivers' enable pin where there is one. Must work at any moment,
// also before begin_motors() and twice.
inline void motors_off() {
  // FILL IN.
}

// Pushes the tip with this force, N, in the axes of tip_position(); it is within the largest already.
// Return false when a driver reports a fault (heat, current, voltage).
inline bool push(const float (&force_n)[3], const int32_t (&counts)[3]) {
  // FILL IN. For three straight axes: force to current to duty, axis by axis. For a linkage: motor
  // torques are J^T f, with the Jacobian J of tip_position() at these counts.
  (void)force_n;
  (void)counts;
  return true;
}
