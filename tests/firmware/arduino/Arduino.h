// As much of Arduino as the sketch uses, with a clock and a port in the test's hand.
#pragma once

#include <stddef.h>
#include <stdint.h>

constexpr uint8_t LOW = 0;
constexpr uint8_t HIGH = 1;
constexpr uint8_t OUTPUT = 1;
constexpr uint8_t INPUT_PULLUP = 2;
constexpr uint8_t pin_count = 8;

struct FakeBoard {
  uint32_t now_us = 0;
  uint8_t pins[pin_count] = {HIGH, HIGH, HIGH, HIGH, HIGH, HIGH, HIGH, HIGH};
  uint32_t turns[pin_count] = {};
  uint8_t heard[4096] = {};
  size_t heard_size = 0;
  size_t heard_read = 0;
  uint8_t said[1 << 16] = {};
  size_t said_size = 0;
  int room = 256;
  int32_t counts[3] = {0, 0, 0};
  float turned[4] = {1, 0, 0, 0};
  bool encoders_answer = true;
  bool gimbal_answers = true;
  bool motors_healthy = true;
  bool motors_on = false;
  float pushed_n[3] = {0, 0, 0};
};

extern FakeBoard fake;

inline uint32_t micros() { return fake.now_us; }
inline void pinMode(uint8_t, uint8_t) {}
inline int digitalRead(uint8_t pin) { return fake.pins[pin]; }
inline void digitalWrite(uint8_t pin, uint8_t value) {
  fake.turns[pin] += fake.pins[pin] != value;
  fake.pins[pin] = value;
}

struct FakeSerial {
  void begin(uint32_t) {}
  int available() { return static_cast<int>(fake.heard_size - fake.heard_read); }
  int read() { return available() > 0 ? fake.heard[fake.heard_read++] : -1; }
  int availableForWrite() { return fake.room; }
  size_t write(const uint8_t* data, size_t size) {
    for (size_t i = 0; i < size && fake.said_size < sizeof fake.said; ++i) {
      fake.said[fake.said_size++] = data[i];
    }
    return size;
  }
};

extern FakeSerial Serial;
