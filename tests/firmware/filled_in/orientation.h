// A gimbal that the tests turn.
#pragma once

#include <Arduino.h>

inline bool read_orientation(const int32_t (&)[3], float (&unit)[4]) {
  for (uint8_t i = 0; i < 4; ++i) unit[i] = fake.turned[i];
  return fake.gimbal_answers;
}
