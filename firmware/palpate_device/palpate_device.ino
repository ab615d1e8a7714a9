// A haptic device of three axes for Palpate: Teensy, RP2040, ESP32 and the like.
//
// Fill in config.h, encoders.h and motors.h; README.md one folder up tells how. All else is the
// same for all devices.
#include "firmware.h"

void setup() { sketch::start(); }

void loop() { sketch::pass(); }
