"""Devices of the link by messages: the one in C++, and the simulated one."""

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import Firmware


class Device:
    """The checker's device, by messages instead of lines."""

    silence_us = 20_000

    def __init__(self, checker):
        self.ask = checker.ask

    def restart(self):
        self.ask("restart")

    def new(self, hello):
        name = hello.name.encode().ljust(16, b"\0").hex()
        x, y, z = hello.half_extents
        self.ask(
            f"device {hello.protocol} {name} {hello.axes} {hello.largest_force} {x} {y} {z} "
            f"{hello.rate_hz} {hello.largest_damping}"
        )

    def hear(self, message, now_us):
        data = message if isinstance(message, bytes) else link.encode(message)
        return decoded(self.ask(f"hear {now_us} {data.hex()}"))

    def drive(self, now_us):
        """Mode, enabled, damp, force in N; and what the device says meanwhile."""
        mode, enabled, damp, x, y, z, said = self.ask(f"drive {now_us}").split()
        force = tuple(map(float, (x, y, z)))
        return (mode, enabled == "1", damp == "1", force), decoded(said)

    def force(self, now_us):
        return self.drive(now_us)[0][3]

    def state(self, now_us, position=(0, 0, 0), buttons=0, ready=1):
        x, y, z = position
        return decoded(self.ask(f"state {now_us} {x} {y} {z} {buttons} {ready}"))

    def orientation(self, *unit):
        return decoded(self.ask("orientation " + " ".join(map(repr, unit))))

    def counters(self):
        words = self.ask("counters").split()
        return dict(zip(words[::2], map(int, words[1::2]), strict=True))


class Simulated:
    """The simulated device's firmware, asked as the checker's device is."""

    # In seconds, 20 ms to the microsecond are no silence yet.
    silence_us = 20_001

    def new(self, hello):
        self.firmware, self.now_us = Firmware(hello), 0
        self.restart = self.firmware.plug_in

    def at(self, now_us):
        """Seconds that go on where the microseconds begin anew."""
        self.now_us += (now_us - self.now_us) % 2**32
        return self.now_us * 1e-6

    def hear(self, message, now_us):
        data = message if isinstance(message, bytes) else link.encode(message)
        return link.Decoder().feed(self.firmware.receive(data, self.at(now_us)))

    def drive(self, now_us):
        told, made = self.firmware.watch(self.at(now_us)), self.firmware
        mode = ("limp" if made.limp else "driven") if made.streaming else "waiting"
        return (mode, any(made.force), made.braked, made.force), link.Decoder().feed(told)

    def force(self, now_us):
        return self.drive(now_us)[0][3]

    def state(self, now_us, position=(0, 0, 0), buttons=0):
        return link.Decoder().feed(self.firmware.state(self.at(now_us), position, buttons))

    def orientation(self, *unit):
        return link.Decoder().feed(self.firmware.orientation(unit))

    def counters(self):
        counters, errors = self.firmware.counters, self.firmware.decoder.errors
        own = {"crc_errors": errors.crc_errors, "malformed": errors.malformed}
        return vars(counters) | own | {"late": counters.out_of_order}


def decoded(text):
    return [] if text == "-" else link.Decoder().feed(bytes.fromhex(text))
