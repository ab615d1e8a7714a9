// What the device is. FILL IN all of it.
#pragma once

#include <stdint.h>

// UTF-8, at most 16 bytes; users choose the device by it.
constexpr char device_name[] = "My device";

// STATE per second, and the motors' own rate. A board that hangs on a UART chip instead of native USB
// gets 27 bytes of ten bits through for each, 42 with an orientation: at 115200 baud 300 or 190 Hz fill
// 70 % of the line.
constexpr uint16_t rate_hz = 1000;
constexpr uint32_t baud = 115200;  // Without meaning on native USB.

// How far the tip can go from the middle, m.
constexpr float half_extents_m[3] = {0.05F, 0.05F, 0.05F};

// The largest force of the tip in any direction that motors and gears stand for minutes, N. As long
// as this is zero the device only measures: the host sends it no force.
constexpr float largest_force_n = 0.0F;

// How hard the device brakes when the host asks for damping, N s/m. Too much of it makes the motors
// growl: velocity comes from differences of encoder counts.
constexpr float damping_ns_per_m = 2.0F;

// Whether the device knows how its stylus is turned: fill in orientation.h then. Once told, it must
// be told with every STATE, or there is no force.
constexpr bool tells_orientation = false;

// Buttons to ground, -1 for none. The first one is the host's "let go".
constexpr int button_pins[] = {-1, -1};

// Turns while the firmware is in its right mind and somebody drives, -1 for none: see README.md,
// "When the firmware itself fails".
constexpr int heartbeat_pin = -1;
