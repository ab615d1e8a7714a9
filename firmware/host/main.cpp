// The firmware's protocol part on a computer, behind a pseudo-terminal instead of a plug.
//
//     c++ -std=c++17 -O1 -I firmware/palpate_link/src firmware/host/main.cpp -o build/board
//     build/board [--rate HZ] [--largest NEWTONS] [--protocol N]
//
// The first line on standard output is the port's path. Then it takes commands on standard input,
// one a line, and ends with its end:
//
//     move X Y Z MS      bring the tip there in a straight line (um) within MS milliseconds
//     turn W X Y Z       from now on tell this orientation of the stylus with every STATE
//     buttons MASK       hold exactly these
//     fail CODE DETAIL   a fault of the device's own
//     recover            the fault is over
//     ready 0|1          whether the motors would obey
//     deaf 0|1           lose all that the host sends
//     mute 0|1           lose all that the device sends
//     hit COUNT          flip a bit in each of the next bytes that the host sends
//     report             one line of JSON
#include <palpate_link.h>

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

namespace {

using palpate::max_frame;

constexpr uint64_t release_after_us = 500000;
constexpr uint64_t longest_rest_us = 5000;  // However slow STATE is, the watchdog is looked at.

[[noreturn]] void give_up(const char* what) {
  fprintf(stderr, "board: %s\n", what);
  exit(1);
}

[[noreturn]] void give_up_with_reason(const char* what) {
  fprintf(stderr, "board: %s: %s\n", what, strerror(errno));
  exit(1);
}

uint64_t clock_us() {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1000000U + static_cast<uint64_t>(now.tv_nsec) / 1000U;
}

// The port as the firmware sees it: bytes come, and frames go as far as there is room.
class Port {
 public:
  Port() {
    device_end_ = posix_openpt(O_RDWR | O_NOCTTY);
    if (device_end_ < 0 || grantpt(device_end_) != 0 || unlockpt(device_end_) != 0) {
      give_up_with_reason("no pseudo-terminal");
    }
    path_ = ptsname(device_end_);
    // The host's end is kept open here too, or reading would fail whenever no host is there.
    host_end_ = path_ == nullptr ? -1 : open(path_, O_RDWR | O_NOCTTY);
    termios raw = {};
    if (host_end_ < 0 || tcgetattr(host_end_, &raw) != 0) give_up_with_reason("no host's end");
    raw.c_iflag &= ~static_cast<tcflag_t>(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR |
                                          ICRNL | IXON);
    raw.c_oflag &= ~static_cast<tcflag_t>(OPOST);
    raw.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    raw.c_cflag &= ~static_cast<tcflag_t>(CSIZE | PARENB);
    raw.c_cflag |= CS8;
    if (tcsetattr(host_end_, TCSANOW, &raw) != 0 ||
        fcntl(device_end_, F_SETFL, O_NONBLOCK) != 0) {
      give_up_with_reason("the pseudo-terminal cannot be set up");
    }
  }

  const char* path() const { return path_; }
  int descriptor() const { return device_end_; }

  size_t read(uint8_t* buffer, size_t size) {
    const ssize_t count = ::read(device_end_, buffer, size);
    return count > 0 ? static_cast<size_t>(count) : 0;
  }

  bool has_room() const { return sizeof backlog_ - filled_ >= max_frame; }

  void write(const uint8_t* frame, size_t size) {
    if (!has_room()) return;
    memcpy(backlog_ + filled_, frame, size);
    filled_ += size;
    flush();
  }

  void flush() {
    if (filled_ == 0) return;
    const ssize_t count = ::write(device_end_, backlog_, filled_);
    if (count <= 0) return;
    filled_ -= static_cast<size_t>(count);
    memmove(backlog_, backlog_ + count, filled_);
  }

  // Lets the next host in, even if the last one locked the port and was killed: here the port stays,
  // where a plug's would have been closed.
  void release() {
#ifdef TIOCNXCL
    ioctl(host_end_, TIOCNXCL);
#endif
  }

 private:
  int device_end_ = -1;
  int host_end_ = -1;
  const char* path_ = nullptr;
  uint8_t backlog_[256];
  size_t filled_ = 0;
};

// What would be encoders and a hand.
struct Tip {
  double from_um[3] = {0, 0, 0};
  double to_um[3] = {0, 0, 0};
  uint64_t begin_us = 0;
  uint64_t end_us = 0;

  void position(uint64_t now_us, int32_t (&um)[3]) const {
    double part = 1.0;
    if (now_us < end_us) {
      part = static_cast<double>(now_us - begin_us) / static_cast<double>(end_us - begin_us);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double here = from_um[axis] + part * (to_um[axis] - from_um[axis]);
      um[axis] = static_cast<int32_t>(here < 0 ? here - 0.5 : here + 0.5);
    }
  }

  void move(uint64_t now_us, const double (&goal_um)[3], double milliseconds) {
    int32_t here[3];
    position(now_us, here);
    for (int axis = 0; axis < 3; ++axis) {
      from_um[axis] = here[axis];
      to_um[axis] = goal_um[axis];
    }
    begin_us = now_us;
    end_us = now_us + static_cast<uint64_t>(milliseconds * 1e3);
  }
};

struct Board {
  palpate::Device device;
  Port port;
  Tip tip;
  palpate::Drive drive;
  float turned[4] = {1.0F, 0.0F, 0.0F, 0.0F};
  bool tells_orientation = false;
  uint8_t buttons = 0;
  bool ready = true;
  bool deaf = false;
  bool mute = false;
  unsigned hits = 0;
  bool host_is_there = false;
  uint64_t last_heard_us = 0;
  uint64_t next_state_us = 0;
  uint64_t period_us = 1000;
  uint64_t states = 0;
  uint64_t dropped = 0;
  float strongest_n = 0.0F;
  // How long the watchdog took, and how long nobody had looked at it before, the last time.
  uint32_t forces_seen = 0;
  uint32_t limps_seen = 0;
  uint64_t forced_us = 0;
  uint64_t looked_us = 0;
  uint64_t limp_after_us = 0;
  uint64_t limp_look_us = 0;

  explicit Board(const palpate::DeviceHello& hello) : device(hello) {
    period_us = 1000000U / hello.rate_hz;
  }

  // The wrapping clock that boards have.
  static uint32_t short_clock(uint64_t us) { return static_cast<uint32_t>(us & 0xFFFFFFFFU); }

  void send(const uint8_t* frame, size_t size) {
    if (!mute) port.write(frame, size);
  }

  void send_answers() {
    uint8_t frame[max_frame];
    while (port.has_room()) {
      const size_t size = device.answer(frame);
      if (size == 0) return;
      send(frame, size);
    }
  }

  void listen(uint64_t now_us) {
    uint8_t bytes[256];
    const size_t count = port.read(bytes, sizeof bytes);
    if (count > 0) {
      last_heard_us = now_us;
      host_is_there = true;
    } else if (host_is_there && now_us - last_heard_us > release_after_us) {
      // Once a silence: the next host may be taking the port at any later moment.
      host_is_there = false;
      port.release();
    }
    for (size_t i = 0; i < count && !deaf; ++i) {
      const bool hit = hits > 0;
      hits -= hit;
      device.receive(static_cast<uint8_t>(hit ? bytes[i] ^ 0x10 : bytes[i]), short_clock(now_us));
      send_answers();
    }
  }

  void time_watchdog(uint64_t now_us) {
    const palpate::Counters& seen = device.counters();
    if (seen.forces != forces_seen) forced_us = now_us;
    if (seen.limp != limps_seen) {
      limp_after_us = now_us - forced_us;
      limp_look_us = now_us - looked_us;
    }
    forces_seen = seen.forces;
    limps_seen = seen.limp;
    looked_us = now_us;
  }

  void tick() {
    const uint64_t now_us = clock_us();
    port.flush();
    listen(now_us);
    drive = device.drive(short_clock(now_us));
    time_watchdog(now_us);
    const float* force = drive.force_n;
    const float size = sqrtf(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    if (size > strongest_n) strongest_n = size;
    send_answers();
    if (now_us < next_state_us) return;
    // A board that was held up goes on from now; it does not catch up.
    next_state_us = now_us - next_state_us > period_us ? now_us + period_us
                                                       : next_state_us + period_us;
    if (!port.has_room()) {
      ++dropped;
      return;
    }
    int32_t position_um[3];
    tip.position(now_us, position_um);
    uint8_t frame[max_frame];
    // Both fit where the longest frame does.
    const size_t turn = tells_orientation ? device.orientation(turned, frame) : 0;
    if (turn > 0) send(frame, turn);
    const size_t length =
        device.state(short_clock(now_us), position_um, buttons, ready, frame);
    if (length == 0) return;
    ++states;
    send(frame, length);
  }

  // How long nothing needs to be done; whole milliseconds, rounded up, are what poll() takes.
  int rest_ms() const {
    const uint64_t now_us = clock_us();
    if (now_us >= next_state_us) return 0;
    const uint64_t rest_us = next_state_us - now_us;
    return rest_us < longest_rest_us ? static_cast<int>(rest_us / 1000) + 1 : static_cast<int>(longest_rest_us / 1000);
  }

  static const char* name_of(palpate::Mode mode) {
    switch (mode) {
      case palpate::Mode::waiting: return "waiting";
      case palpate::Mode::limp: return "limp";
      case palpate::Mode::driven: return "driven";
      case palpate::Mode::failed: return "failed";
    }
    return "?";
  }

  void report() {
    const palpate::Counters& seen = device.counters();
    printf("{\"mode\": \"%s\", \"enabled\": %s, \"damp\": %s, \"force\": [%.9g, %.9g, %.9g], "
           "\"strongest\": %.9g, \"limp_after_us\": %" PRIu64 ", \"limp_look_us\": %" PRIu64 ", ",
           name_of(device.mode()), drive.enabled ? "true" : "false", drive.damp ? "true" : "false",
           static_cast<double>(drive.force_n[0]), static_cast<double>(drive.force_n[1]),
           static_cast<double>(drive.force_n[2]), static_cast<double>(strongest_n),
           limp_after_us, limp_look_us);
    printf("\"states\": %" PRIu64 ", \"dropped\": %" PRIu64 ", \"hellos\": %" PRIu32
           ", \"forces\": %" PRIu32 ", \"lost\": %" PRIu32 ", \"duplicates\": %" PRIu32
           ", \"late\": %" PRIu32 ", \"refused\": %" PRIu32 ", \"unknown\": %" PRIu32 ", \"unexpected\": %" PRIu32
           ", \"limp\": %" PRIu32 ", \"crc_errors\": %" PRIu32 ", \"malformed\": %" PRIu32 "}\n",
           states, dropped, seen.hellos, seen.forces, seen.lost, seen.duplicates, seen.late,
           seen.refused, seen.unknown, seen.unexpected, seen.limp, device.receiver().crc_errors,
           device.receiver().malformed);
  }

  void obey(const char* line) {
    double goal_um[3];
    double milliseconds = 0;
    unsigned number = 0;
    unsigned detail = 0;
    if (sscanf(line, "move %lf %lf %lf %lf", &goal_um[0], &goal_um[1], &goal_um[2],
               &milliseconds) == 4) {
      tip.move(clock_us(), goal_um, milliseconds);
    } else if (sscanf(line, "turn %f %f %f %f", &turned[0], &turned[1], &turned[2],
                      &turned[3]) == 4) {
      tells_orientation = true;
    } else if (sscanf(line, "fail %u %u", &number, &detail) == 2) {
      device.fail(static_cast<uint8_t>(number), static_cast<uint16_t>(detail));
    } else if (sscanf(line, "buttons %u", &number) == 1) {
      buttons = static_cast<uint8_t>(number);
    } else if (sscanf(line, "ready %u", &number) == 1) {
      ready = number != 0;
    } else if (sscanf(line, "deaf %u", &number) == 1) {
      deaf = number != 0;
    } else if (sscanf(line, "hit %u", &number) == 1) {
      hits = number;
    } else if (sscanf(line, "mute %u", &number) == 1) {
      mute = number != 0;
    } else if (strcmp(line, "recover") == 0) {
      device.recover();
    } else if (strcmp(line, "report") == 0) {
      report();
    } else {
      give_up("no such command");
    }
  }
};

// Lines from standard input, without waiting for any.
class Commands {
 public:
  // False when standard input has ended.
  bool obey_all(Board& board) {
    char bytes[256];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) return count < 0 && errno == EINTR;
    for (ssize_t i = 0; i < count; ++i) {
      if (bytes[i] != '\n') {
        if (filled_ + 1 >= sizeof line_) give_up("a command is too long");
        line_[filled_++] = bytes[i];
        continue;
      }
      line_[filled_] = '\0';
      filled_ = 0;
      board.obey(line_);
    }
    return true;
  }

 private:
  char line_[128];
  size_t filled_ = 0;
};

void read_options(int count, char** words, palpate::DeviceHello& hello) {
  for (int i = 1; i < count; i += 2) {
    if (i + 1 == count) give_up("an option without a number");
    const double number = strtod(words[i + 1], nullptr);
    if (strcmp(words[i], "--rate") == 0 && number >= 1 && number <= 8000) {
      hello.rate_hz = static_cast<uint16_t>(number);
    } else if (strcmp(words[i], "--largest") == 0 && number >= 0 && number <= 1000) {
      hello.largest_force_n = static_cast<float>(number);
    } else if (strcmp(words[i], "--protocol") == 0 && number >= 0 && number <= 255) {
      hello.protocol = static_cast<uint8_t>(number);
    } else {
      give_up("usage: board [--rate HZ] [--largest NEWTONS] [--protocol N]");
    }
  }
}

}  // namespace

int main(int count, char** words) {
  palpate::DeviceHello hello;
  memcpy(hello.name, "Reference", 9);
  hello.largest_force_n = 3.0F;
  for (float& extent : hello.half_extents_m) extent = 0.1F;
  read_options(count, words, hello);

  static Board board(hello);
  Commands commands;
  setvbuf(stdout, nullptr, _IOLBF, 0);
  printf("%s\n", board.port.path());
  for (;;) {
    pollfd wanted[2] = {{board.port.descriptor(), POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    if (poll(wanted, 2, board.rest_ms()) < 0 && errno != EINTR) give_up_with_reason("poll");
    if (wanted[1].revents != 0 && !commands.obey_all(board)) return 0;
    board.tick();
  }
}
