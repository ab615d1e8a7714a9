// A device as somebody may have filled it in.
#pragma once

#include <stdint.h>

constexpr char device_name[] = "Filled in";
constexpr uint16_t rate_hz = 1000;
constexpr uint32_t baud = 115200;
constexpr float half_extents_m[3] = {0.0625F, 0.125F, 0.25F};
constexpr float largest_force_n = 2.0F;
constexpr float damping_ns_per_m = 2.0F;
constexpr bool tells_orientation = true;
constexpr int button_pins[] = {-1, 3};
constexpr int heartbeat_pin = 5;
