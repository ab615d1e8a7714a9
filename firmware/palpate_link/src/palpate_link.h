// The device's side of Palpate's serial link, version 1; docs/link.md is its definition.
//
// C++17, header only. No heap, no exceptions, no clock and no port: bytes and times are handed in,
// so that the same files run on a board and, under tests, on a computer.
#pragma once

#include "palpate/cobs.h"
#include "palpate/crc16.h"
#include "palpate/device.h"
#include "palpate/frame.h"
#include "palpate/messages.h"
