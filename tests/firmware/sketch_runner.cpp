// Runs the sketch at the tests' command, one request and one answer a line. Time passes only in
// `run`, and 50 us in each pass of loop().
#include <Arduino.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

FakeBoard fake;
FakeSerial Serial;

#include "palpate_device.ino"

namespace {

constexpr uint32_t pass_us = 50;

[[noreturn]] void give_up(const char* what) {
  fprintf(stderr, "sketch_runner: %s\n", what);
  exit(1);
}

void hear(const char* digits) {
  if (fake.heard_read == fake.heard_size) fake.heard_read = fake.heard_size = 0;
  for (; digits[0] != '\0' && digits[0] != '\n'; digits += 2) {
    unsigned value = 0;
    if (sscanf(digits, "%2x", &value) != 1) give_up("no hexadecimal number");
    if (fake.heard_size == sizeof fake.heard) give_up("too many bytes");
    fake.heard[fake.heard_size++] = static_cast<uint8_t>(value);
  }
}

// Until the time is over, or the motors go off when that is what is waited for; returns how long.
uint32_t run(uint32_t time_us, bool until_off) {
  uint32_t passed = 0;
  while (passed < time_us && !(until_off && !fake.motors_on)) {
    fake.now_us += pass_us;
    passed += pass_us;
    loop();
  }
  return passed;
}

void obey(const char* line) {
  unsigned number = 0;
  unsigned value = 0;
  if (strncmp(line, "hear ", 5) == 0) {
    hear(line + 5);
  } else if (sscanf(line, "clock %u", &number) == 1) {
    fake.now_us = number;
    sketch::last_tick_us = number;
  } else if (sscanf(line, "run %u", &number) == 1) {
    printf("%" PRIu32, run(number, false));
  } else if (sscanf(line, "until-off %u", &number) == 1) {
    printf("%" PRIu32, run(number, true));
  } else if (sscanf(line, "counts %" SCNd32 " %" SCNd32 " %" SCNd32, &fake.counts[0],
                    &fake.counts[1], &fake.counts[2]) == 3) {
  } else if (sscanf(line, "turned %f %f %f %f", &fake.turned[0], &fake.turned[1],
                    &fake.turned[2], &fake.turned[3]) == 4) {
  } else if (sscanf(line, "gimbal %u", &number) == 1) {
    fake.gimbal_answers = number != 0;
  } else if (sscanf(line, "encoders %u", &number) == 1) {
    fake.encoders_answer = number != 0;
  } else if (sscanf(line, "healthy %u", &number) == 1) {
    fake.motors_healthy = number != 0;
  } else if (sscanf(line, "room %u", &number) == 1) {
    fake.room = static_cast<int>(number);
  } else if (sscanf(line, "pin %u %u", &number, &value) == 2 && number < pin_count) {
    fake.pins[number] = static_cast<uint8_t>(value);
  } else if (sscanf(line, "turns %u", &number) == 1 && number < pin_count) {
    printf("%" PRIu32, fake.turns[number]);
  } else if (strcmp(line, "motors\n") == 0) {
    printf("%d", fake.motors_on);
    for (const float newtons : fake.pushed_n) printf(" %.9g", static_cast<double>(newtons));
  } else if (strcmp(line, "said\n") == 0) {
    for (size_t i = 0; i < fake.said_size; ++i) printf("%02x", fake.said[i]);
    fake.said_size = 0;
  } else {
    give_up("no such request");
  }
  printf("\n");
}

}  // namespace

int main() {
  static char line[1 << 14];
  // Whoever asks waits for the answer at the other end of a pipe.
  setvbuf(stdout, nullptr, _IOLBF, 0);
  setup();
  while (fgets(line, sizeof line, stdin) != nullptr) obey(line);
  return 0;
}
