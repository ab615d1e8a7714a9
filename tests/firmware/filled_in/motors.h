// Motors that the tests look at.
#pragma once

#include <Arduino.h>

inline void begin_motors() {}

inline void motors_off() {
  fake.motors_on = false;
  for (float& newtons : fake.pushed_n) newtons = 0.0F;
}

inline bool push(const float (&force_n)[3], const int32_t (&)[3]) {
  fake.motors_on = true;
  for (uint8_t axis = 0; axis < 3; ++axis) fake.pushed_n[axis] = force_n[axis];
  return fake.motors_healthy;
}
