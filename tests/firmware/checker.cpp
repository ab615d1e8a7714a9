// The firmware's protocol part at the tests' command: a request a line on standard input, an answer
// a line on standard output. With `fuzz SEED BYTES` it throws damage at itself instead.
//
// Bytes are hexadecimal, none of them a dash. Times are microseconds.
#include "damage.h"

#include <palpate_link.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace {

using palpate::max_frame;

[[noreturn]] void give_up(const char* what) {
  fprintf(stderr, "checker: %s\n", what);
  exit(1);
}

void require(bool holds, const char* what) {
  if (!holds) give_up(what);
}

// ------------------------------------------------------------------------------------- requests

struct Bytes {
  uint8_t data[1 << 16];
  size_t size = 0;
};

const char* next_word() {
  const char* word = strtok(nullptr, " \n");
  if (word == nullptr) give_up("a word is missing");
  return word;
}

long long next_number() { return strtoll(next_word(), nullptr, 10); }

// False at the end of the line.
bool next_if_any(long long& number) {
  const char* word = strtok(nullptr, " \n");
  if (word != nullptr) number = strtoll(word, nullptr, 10);
  return word != nullptr;
}

float next_float() { return strtof(next_word(), nullptr); }

void next_bytes(Bytes& bytes) {
  const char* word = next_word();
  bytes.size = 0;
  if (strcmp(word, "-") == 0) return;
  for (; word[0] != '\0'; word += 2) {
    unsigned value = 0;
    require(word[1] != '\0' && sscanf(word, "%2x", &value) == 1, "no hexadecimal number");
    require(bytes.size < sizeof bytes.data, "too many bytes");
    bytes.data[bytes.size++] = static_cast<uint8_t>(value);
  }
}

void print_bytes(const uint8_t* data, size_t size) {
  if (size == 0) printf("-");
  for (size_t i = 0; i < size; ++i) printf("%02x", data[i]);
}

void answer_stream(const Bytes& bytes) {
  palpate::Receiver receiver;
  for (size_t i = 0; i < bytes.size; ++i) {
    if (!receiver.take(bytes.data[i])) continue;
    print_bytes(receiver.payload(), receiver.size());
    printf(" ");
  }
  printf("%" PRIu32 " %" PRIu32, receiver.crc_errors, receiver.malformed);
}

void next_hello(palpate::DeviceHello& hello) {
  static Bytes name;
  hello.protocol = static_cast<uint8_t>(next_number());
  next_bytes(name);
  require(name.size <= sizeof hello.name, "a name has at most 16 bytes");
  memset(hello.name, 0, sizeof hello.name);
  memcpy(hello.name, name.data, name.size);
  hello.axes = static_cast<uint8_t>(next_number());
  hello.largest_force_n = next_float();
  for (float& extent : hello.half_extents_m) extent = next_float();
  hello.rate_hz = static_cast<uint16_t>(next_number());
  long long damping = 0;
  if (next_if_any(damping)) hello.largest_damping = static_cast<uint16_t>(damping);
}

// Fields of a message to its frame.
void answer_pack() {
  uint8_t payload[palpate::max_payload];
  uint8_t frame[max_frame];
  size_t size = 0;
  const char* kind = next_word();
  if (strcmp(kind, "host-hello") == 0) {
    size = palpate::pack_host_hello(static_cast<uint8_t>(next_number()), payload);
  } else if (strcmp(kind, "device-hello") == 0) {
    palpate::DeviceHello hello;
    next_hello(hello);
    size = palpate::pack(hello, payload);
  } else if (strcmp(kind, "state") == 0) {
    palpate::State state;
    state.sequence = static_cast<uint16_t>(next_number());
    state.time_us = static_cast<uint32_t>(next_number());
    for (int32_t& um : state.position_um) um = static_cast<int32_t>(next_number());
    state.buttons = static_cast<uint8_t>(next_number());
    state.flags = static_cast<uint8_t>(next_number());
    long long taken = 0;
    state.tells = next_if_any(taken);
    state.taken = static_cast<uint16_t>(taken);
    size = palpate::pack(state, payload);
  } else if (strcmp(kind, "force") == 0) {
    palpate::Force force;
    force.sequence = static_cast<uint16_t>(next_number());
    for (int16_t& mn : force.force_mn) mn = static_cast<int16_t>(next_number());
    force.flags = static_cast<uint8_t>(next_number());
    long long time = 0;
    force.answers = next_if_any(time);
    if (force.answers) {
      force.state_time_us = static_cast<uint32_t>(time);
      force.age = static_cast<uint16_t>(next_number());
      force.damping = static_cast<uint16_t>(next_number());
    }
    size = palpate::pack(force, payload);
  } else if (strcmp(kind, "fault") == 0) {
    palpate::Fault fault;
    fault.code = static_cast<uint8_t>(next_number());
    fault.detail = static_cast<uint16_t>(next_number());
    size = palpate::pack(fault, payload);
  } else if (strcmp(kind, "orientation") == 0) {
    palpate::Orientation orientation;
    orientation.sequence = static_cast<uint16_t>(next_number());
    for (int16_t& part : orientation.quaternion) part = static_cast<int16_t>(next_number());
    size = palpate::pack(orientation, payload);
  } else {
    give_up("no such message");
  }
  print_bytes(frame, palpate::write_frame(payload, size, frame));
}

// A payload to its fields.
void answer_unpack(const Bytes& payload) {
  uint8_t protocol = 0;
  palpate::DeviceHello hello;
  palpate::State state;
  palpate::Force force;
  palpate::Fault fault;
  palpate::Orientation orientation;
  if (palpate::unpack(payload.data, payload.size, hello)) {
    printf("device-hello %u ", hello.protocol);
    print_bytes(reinterpret_cast<const uint8_t*>(hello.name), sizeof hello.name);
    printf(" %u %.9g", hello.axes, static_cast<double>(hello.largest_force_n));
    for (const float extent : hello.half_extents_m) printf(" %.9g", static_cast<double>(extent));
    printf(" %u", hello.rate_hz);
    if (hello.protocol != palpate::first_protocol) printf(" %u", hello.largest_damping);
  } else if (palpate::read_protocol(payload.data, payload.size, protocol) &&
             (payload.size == palpate::host_hello_size || protocol < palpate::first_protocol ||
              protocol > palpate::protocol_version)) {
    printf("host-hello %u", protocol);
  } else if (palpate::unpack(payload.data, payload.size, state)) {
    printf("state %u %" PRIu32, state.sequence, state.time_us);
    for (const int32_t um : state.position_um) printf(" %" PRId32, um);
    printf(" %u %u", state.buttons, state.flags);
    if (state.tells) printf(" %u", state.taken);
  } else if (palpate::unpack(payload.data, payload.size, force)) {
    printf("force %u %d %d %d %u", force.sequence, force.force_mn[0], force.force_mn[1],
           force.force_mn[2], force.flags);
    if (force.answers) {
      printf(" %" PRIu32 " %u %u", force.state_time_us, force.age, force.damping);
    }
  } else if (palpate::unpack(payload.data, payload.size, fault)) {
    printf("fault %u %u", fault.code, fault.detail);
  } else if (palpate::unpack(payload.data, payload.size, orientation)) {
    printf("orientation %u", orientation.sequence);
    for (const int16_t part : orientation.quaternion) printf(" %d", part);
  } else {
    printf("unknown");
  }
}

const char* name_of(palpate::Mode mode) {
  switch (mode) {
    case palpate::Mode::waiting: return "waiting";
    case palpate::Mode::limp: return "limp";
    case palpate::Mode::driven: return "driven";
    case palpate::Mode::failed: return "failed";
  }
  return "?";
}

void print_answers(palpate::Device& device) {
  uint8_t frame[max_frame];
  bool any = false;
  while (const size_t size = device.answer(frame)) {
    print_bytes(frame, size);
    any = true;
  }
  if (!any) printf("-");
}

void answer_device(palpate::Device& device, const char* verb) {
  uint8_t frame[max_frame];
  if (strcmp(verb, "hear") == 0) {
    static Bytes bytes;
    const uint32_t now = static_cast<uint32_t>(next_number());
    next_bytes(bytes);
    static uint8_t answers[1 << 16];
    size_t size = 0;
    for (size_t i = 0; i < bytes.size; ++i) {
      device.receive(bytes.data[i], now);
      while (const size_t length = device.answer(frame)) {
        require(size + length <= sizeof answers, "too many answers");
        memcpy(answers + size, frame, length);
        size += length;
      }
    }
    print_bytes(answers, size);
  } else if (strcmp(verb, "drive") == 0) {
    const palpate::Drive drive = device.drive(static_cast<uint32_t>(next_number()));
    printf("%s %d %d", name_of(device.mode()), drive.enabled, drive.damp);
    for (const float newtons : drive.force_n) printf(" %.9g", static_cast<double>(newtons));
    printf(" ");
    print_answers(device);
  } else if (strcmp(verb, "state") == 0) {
    const uint32_t now = static_cast<uint32_t>(next_number());
    int32_t position[3];
    for (int32_t& um : position) um = static_cast<int32_t>(next_number());
    const uint8_t buttons = static_cast<uint8_t>(next_number());
    const bool ready = next_number() != 0;
    print_bytes(frame, device.state(now, position, buttons, ready, frame));
  } else if (strcmp(verb, "orientation") == 0) {
    float unit[4];
    for (float& part : unit) part = next_float();
    print_bytes(frame, device.orientation(unit, frame));
  } else if (strcmp(verb, "fail") == 0) {
    const uint8_t code = static_cast<uint8_t>(next_number());
    device.fail(code, static_cast<uint16_t>(next_number()));
    print_answers(device);
  } else if (strcmp(verb, "recover") == 0) {
    device.recover();
    print_answers(device);
  } else if (strcmp(verb, "restart") == 0) {
    device.restart();
    print_answers(device);
  } else if (strcmp(verb, "counters") == 0) {
    const palpate::Counters& seen = device.counters();
    printf("hellos %" PRIu32 " forces %" PRIu32 " lost %" PRIu32 " duplicates %" PRIu32
           " late %" PRIu32 " refused %" PRIu32 " unknown %" PRIu32 " unexpected %" PRIu32 " limp %" PRIu32
           " crc_errors %" PRIu32 " malformed %" PRIu32,
           seen.hellos, seen.forces, seen.lost, seen.duplicates, seen.late, seen.refused, seen.unknown,
           seen.unexpected, seen.limp, device.receiver().crc_errors, device.receiver().malformed);
  } else {
    give_up("no such request");
  }
}

int serve() {
  static char line[1 << 18];
  static Bytes bytes;
  // Whoever asks waits for the answer at the other end of a pipe.
  setvbuf(stdout, nullptr, _IOLBF, 0);
  palpate::Device device{palpate::DeviceHello()};
  while (fgets(line, sizeof line, stdin) != nullptr) {
    const char* verb = strtok(line, " \n");
    if (verb == nullptr) continue;
    if (strcmp(verb, "crc") == 0) {
      next_bytes(bytes);
      printf("%04x", palpate::crc16(bytes.data, bytes.size));
    } else if (strcmp(verb, "stuff") == 0) {
      static uint8_t coded[sizeof bytes.data + 1];
      next_bytes(bytes);
      print_bytes(coded, palpate::cobs_encode(bytes.data, bytes.size, coded));
    } else if (strcmp(verb, "unstuff") == 0) {
      static uint8_t plain[sizeof bytes.data];
      size_t size = 0;
      next_bytes(bytes);
      if (palpate::cobs_decode(bytes.data, bytes.size, plain, size)) {
        print_bytes(plain, size);
      } else {
        printf("bad");
      }
    } else if (strcmp(verb, "frame") == 0) {
      uint8_t frame[max_frame];
      next_bytes(bytes);
      print_bytes(frame, palpate::write_frame(bytes.data, bytes.size, frame));
    } else if (strcmp(verb, "stream") == 0) {
      next_bytes(bytes);
      answer_stream(bytes);
    } else if (strcmp(verb, "pack") == 0) {
      answer_pack();
    } else if (strcmp(verb, "unpack") == 0) {
      next_bytes(bytes);
      answer_unpack(bytes);
    } else if (strcmp(verb, "shorten") == 0) {
      float vector[3];
      for (float& component : vector) component = next_float();
      palpate::shorten(vector, next_float());
      for (const float component : vector) printf("%.9g ", static_cast<double>(component));
    } else if (strcmp(verb, "device") == 0) {
      palpate::DeviceHello hello;
      next_hello(hello);
      device = palpate::Device(hello);
    } else {
      answer_device(device, verb);
    }
    printf("\n");
  }
  return 0;
}

// ------------------------------------------------------------------------------------- fuzzing

using damage::Dice;

struct Tally {
  uint64_t bytes = 0;
  uint64_t damaged = 0;
  uint64_t resynchronised = 0;
  uint64_t frames_answered = 0;
};

// A device under fire, and beside it a receiver alone, so that payloads can be looked at.
struct Target {
  palpate::Device device;
  palpate::Receiver receiver;
  Tally tally;
  uint32_t now_us = 0xFFF00000U;  // So that the clock wraps on the way.
  uint16_t sequence = 0;

  explicit Target(const palpate::DeviceHello& hello) : device(hello) {}

  // True when the byte ended a sound frame.
  bool take(uint8_t byte) {
    now_us += 9;
    ++tally.bytes;
    device.receive(byte, now_us);
    uint8_t frame[max_frame];
    while (const size_t size = device.answer(frame)) {
      ++tally.frames_answered;
      check_frame(frame, size);
    }
    const palpate::Drive drive = device.drive(now_us);
    const float* force = drive.force_n;
    const float size =
        sqrtf(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    require(size <= device.hello().largest_force_n * 1.00001F, "a force beyond the largest");
    require(drive.enabled || size == 0.0F, "a force without enable");
    return receiver.take(byte);
  }

  static void check_frame(const uint8_t* frame, size_t size) {
    require(size >= 5 && size <= max_frame, "a frame of impossible length");
    require(memchr(frame, 0, size) == frame + size - 1, "a zero inside a frame");
    palpate::Receiver reader;
    bool whole = false;
    for (size_t i = 0; i < size; ++i) whole = reader.take(frame[i]);
    require(whole, "an answer that cannot be read");
  }

  // After whatever came before: one frame may be swallowed with the damage, the next must count.
  void must_resynchronise() {
    palpate::Force force;
    uint8_t payload[palpate::max_payload];
    uint8_t frame[max_frame];
    const uint32_t forces = device.counters().forces;
    size_t size = palpate::write_frame(payload, palpate::pack_host_hello(1, payload), frame);
    for (int copy = 0; copy < 2; ++copy) {
      for (size_t i = 0; i < size; ++i) take(frame[i]);
    }
    require(device.mode() == palpate::Mode::limp, "HELLO was not understood after damage");
    force.sequence = sequence++;
    force.force_mn[2] = 32767;
    force.flags = palpate::force_enable;
    size = palpate::write_frame(payload, palpate::pack(force, payload), frame);
    bool whole = false;
    for (size_t i = 0; i < size; ++i) whole = take(frame[i]);
    require(whole && device.counters().forces == forces + 1, "FORCE was not taken after damage");
    ++tally.resynchronised;
  }
};

size_t random_frame(Dice& dice, uint16_t& sequence, uint8_t (&frame)[max_frame]) {
  uint8_t payload[palpate::max_payload];
  size_t size = 0;
  switch (dice.below(4)) {
    case 0:
      size = palpate::pack_host_hello(static_cast<uint8_t>(dice.below(3)), payload);
      break;
    case 1:
      size = 1 + dice.below(palpate::max_payload);
      for (size_t i = 0; i < size; ++i) payload[i] = dice.below(3) == 0 ? 0 : dice.byte();
      break;
    default: {
      palpate::Force force;
      force.sequence = sequence++;
      for (int16_t& mn : force.force_mn) {
        mn = static_cast<int16_t>(static_cast<int32_t>(dice.below(65536)) - 32768);
      }
      force.flags = static_cast<uint8_t>(dice.below(4));
      force.answers = dice.below(2) == 0;
      size = palpate::pack(force, payload);
    }
  }
  return palpate::write_frame(payload, size, frame);
}

size_t damaged(Dice& dice, uint8_t (&bytes)[2 * max_frame], size_t size) {
  const size_t at = dice.below(static_cast<uint32_t>(size));
  switch (dice.below(5)) {
    case 0:
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ (1U << dice.below(8)));
      return size;
    case 1:
      bytes[at] = dice.byte();
      return size;
    case 2:
      bytes[at] = 0;
      return size;
    case 3:
      memmove(bytes + at, bytes + at + 1, size - at - 1);
      return size - 1;
    default:
      memmove(bytes + at + 1, bytes + at, size - at);
      bytes[at] = dice.byte();
      return size + 1;
  }
}

// A frame that is hit, and two that follow. The first of them is lost only where the hit took the
// zero between them, the second never.
void hit_and_follow(Dice& dice, Target& target) {
  uint8_t frame[max_frame];
  uint8_t bytes[2 * max_frame];
  size_t size = random_frame(dice, target.sequence, frame);
  memcpy(bytes, frame, size);
  size = damaged(dice, bytes, size);
  for (size_t i = 0; i < size; ++i) target.take(bytes[i]);
  ++target.tally.damaged;
  const bool ended = size > 0 && bytes[size - 1] == 0;
  for (int follower = 0; follower < 2; ++follower) {
    const size_t length = random_frame(dice, target.sequence, frame);
    bool whole = false;
    for (size_t i = 0; i < length; ++i) whole = target.take(frame[i]);
    require(whole || (follower == 0 && !ended), "a frame after a hit was lost");
  }
}

int fuzz(uint64_t seed, uint64_t count) {
  Dice dice(seed);
  palpate::DeviceHello hello;
  memcpy(hello.name, "fuzzed", 6);
  hello.largest_force_n = 2.5F;
  Target target(hello);
  while (target.tally.bytes < count) {
    const uint32_t length = 1 + dice.below(400);
    switch (dice.below(4)) {
      case 0:
        for (uint32_t i = 0; i < length; ++i) target.take(dice.byte());
        break;
      case 1:  // Few zeros and many small codes: deeper into the decoder.
        for (uint32_t i = 0; i < length; ++i) {
          target.take(static_cast<uint8_t>(dice.below(30) == 0 ? 0 : 1 + dice.below(6)));
        }
        break;
      default:
        for (int i = 0; i < 8; ++i) hit_and_follow(dice, target);
    }
    target.must_resynchronise();
    if (dice.below(50) == 0) target.now_us += 30000;  // Long enough for the watchdog.
  }
  const palpate::Counters& seen = target.device.counters();
  printf("bytes %" PRIu64 " damaged %" PRIu64 " resynchronised %" PRIu64 " answers %" PRIu64
         " crc_errors %" PRIu32 " malformed %" PRIu32 " unknown %" PRIu32 " forces %" PRIu32
         " limp %" PRIu32 "\n",
         target.tally.bytes, target.tally.damaged, target.tally.resynchronised,
         target.tally.frames_answered, target.receiver.crc_errors, target.receiver.malformed,
         seen.unknown, seen.forces, seen.limp);
  return 0;
}

// ------------------------------------------------------------------ streams shared with Rust

// Reads a stream beside what was sent: a sound frame after a delimiter must be read, and what is read
// should have been sent. Prints the line of tests/vectors/damage.csv.
int read_damage(uint64_t seed, uint64_t count) {
  Dice dice(seed);
  palpate::Receiver receiver;
  damage::Digest sent, read;
  uint64_t bytes = 0, payloads = 0, phantoms = 0;
  uint8_t last_byte = 0;
  while (bytes < count) {
    const damage::Chunk chunk = damage::next_chunk(dice);
    const bool owed = chunk.sound && last_byte == 0;
    uint64_t right = 0, wrong = 0;
    sent.take(chunk.bytes.data(), chunk.bytes.size());
    for (const uint8_t byte : chunk.bytes) {
      if (!receiver.take(byte)) continue;
      const damage::Payload payload(receiver.payload(), receiver.payload() + receiver.size());
      read.take(static_cast<uint8_t>(payload.size()));
      read.take(payload.data(), payload.size());
      bool was_sent = false;
      for (const damage::Payload& expected : chunk.payloads) was_sent |= expected == payload;
      ++(was_sent ? right : wrong);
    }
    require(!owed || (right == 1 && wrong == 0), "a sound frame after a delimiter was lost");
    bytes += chunk.bytes.size();
    payloads += right + wrong;
    phantoms += wrong;
    if (!chunk.bytes.empty()) last_byte = chunk.bytes.back();
  }
  printf("%" PRIu64 ",%" PRIu64 ",%016" PRIx64 ",%" PRIu64 ",%016" PRIx64 ",%" PRIu32 ",%" PRIu32
         ",%" PRIu64 "\n",
         seed, bytes, sent.value, payloads, read.value, receiver.crc_errors, receiver.malformed,
         phantoms);
  return 0;
}

int write_damage(uint64_t seed, uint64_t count) {
  Dice dice(seed);
  for (uint64_t bytes = 0; bytes < count;) {
    const damage::Chunk chunk = damage::next_chunk(dice);
    bytes += fwrite(chunk.bytes.data(), 1, chunk.bytes.size(), stdout);
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count == 4) {
    const uint64_t seed = strtoull(words[2], nullptr, 10);
    const uint64_t bytes = strtoull(words[3], nullptr, 10);
    if (strcmp(words[1], "fuzz") == 0) return fuzz(seed, bytes);
    if (strcmp(words[1], "read-damage") == 0) return read_damage(seed, bytes);
    if (strcmp(words[1], "write-damage") == 0) return write_damage(seed, bytes);
  }
  if (count != 1) give_up("usage: checker [(fuzz | read-damage | write-damage) SEED BYTES]");
  return serve();
}
