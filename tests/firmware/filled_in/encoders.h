// Encoders that the tests turn; 20 micrometres a count.
#pragma once

#include <Arduino.h>

inline bool begin_encoders() { return fake.encoders_answer; }

inline bool read_encoders(int32_t (&counts)[3]) {
  for (uint8_t axis = 0; axis < 3; ++axis) counts[axis] = fake.counts[axis];
  return fake.encoders_answer;
}

inline void tip_position(const int32_t (&counts)[3], int32_t (&position_um)[3]) {
  for (uint8_t axis = 0; axis < 3; ++axis) position_um[axis] = 20 * counts[axis];
}
