// Where boards differ.
#pragma once

#include <Arduino.h>
#include <palpate_link.h>

#include "config.h"

// Never waits: a board whose loop stands still because nobody reads its port is deaf too. What does
// not fit is not sent; the next STATE is newer anyway.
inline bool line_has_room() {
  return Serial.availableForWrite() >= static_cast<int>(palpate::max_frame);
}

inline void send(const uint8_t* frame, size_t size) {
  if (size == 0) return;
  Serial.write(frame, size);
#if defined(CORE_TEENSY) && !defined(USB_DISABLED)
  // Without it a Teensy waits for more to fill a USB packet.
  Serial.send_now();
#endif
}

inline void begin_board() {
  Serial.begin(baud);
  for (const int pin : button_pins) {
    if (pin >= 0) pinMode(static_cast<uint8_t>(pin), INPUT_PULLUP);
  }
  if (heartbeat_pin >= 0) pinMode(static_cast<uint8_t>(heartbeat_pin), OUTPUT);
}

inline uint8_t read_buttons() {
  uint8_t mask = 0;
  uint8_t number = 0;
  for (const int pin : button_pins) {
    if (pin >= 0 && digitalRead(static_cast<uint8_t>(pin)) == LOW) {
      mask = static_cast<uint8_t>(mask | (1U << number));
    }
    ++number;
  }
  return mask;
}

inline void beat(bool driven) {
  static bool high = false;
  if (heartbeat_pin < 0 || !driven) return;
  high = !high;
  digitalWrite(static_cast<uint8_t>(heartbeat_pin), high ? HIGH : LOW);
}
