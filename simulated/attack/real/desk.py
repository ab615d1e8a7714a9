"""A device whose line is listened to, for one host after another."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass

from ....core.servo import link
from ....core.servo.haply_models import DEFAULT_MODEL, haply_model
from ...board.haply_firmware import TORQUES
from ...hand.options import SimulatedOptions
from ...simulated_process import SimulatedDevice
from .host import Host, device
from .line.overheard import Overheard
from .line.pulse import Pulse
from .pressing import INTO_THE_CUBE, Hand, Way, press

KINDS = ("link", "haply")
WAYS = {
    "link": INTO_THE_CUBE,
    "haply": Way(haply_model(DEFAULT_MODEL).rest, (0.002, -0.012, 0.0), 0.3),
}
"""In the 2DIY's own axes 12 mm below the cube's top."""
FILL = 0x10
NO_TORQUE = bytes([FILL] * 4)
REQUEST = 10
WATCHED_SECONDS = 0.03
ARRIVAL_SECONDS = 0.01


@dataclass(frozen=True)
class Word:
    """A force, or none, that was said to a device at a time, s."""

    time: float
    pushes: bool


def words_of_the_link(said: Iterable[tuple[float, bytes]]) -> list[Word]:
    """FORCE in what a host said."""
    decoder = link.Decoder()
    return [
        Word(heard, bool(message.flags & link.ForceFlag.ENABLE))
        for heard, piece in said
        for message in decoder.feed(piece)
        if isinstance(message, link.Force)
    ]


def words_of_the_haply(said: Iterable[tuple[float, bytes]]) -> list[Word]:
    """Torques in what a host said, for whoever reads as a board does."""
    words, waiting = [], b""
    for heard, piece in said:
        waiting += piece
        while len(waiting) >= REQUEST:
            if waiting[0] == TORQUES:
                torques = waiting[2:REQUEST]
                words.append(Word(heard, torques != NO_TORQUE * 2))
                waiting = waiting[REQUEST:]
            else:
                waiting = waiting[1:]
    return words


WORDS: dict[str, Callable[[Iterable[tuple[float, bytes]]], list[Word]]] = {
    "link": words_of_the_link,
    "haply": words_of_the_haply,
}


@dataclass(frozen=True)
class Desk:
    """A hand at a device of a kind, and its line."""

    kind: str
    hand: Hand
    line: Overheard
    pulse: Pulse

    @contextmanager
    def host(self) -> Iterator[Host]:
        """A host at the line, and nothing said yet; afterwards the hand is above the body again."""
        self.line.said.clear()
        self.pulse.forget()
        with Host(self.line.port, self.kind) as host:
            yield host
        way = WAYS[self.kind]
        self.hand.move_hand(way.above, way.seconds)
        time.sleep(2.0 * way.seconds)

    def press(self, host: Host) -> None:
        """Bring the hand into the body, out of it first."""
        press(host, self.hand, WAYS[self.kind])

    def words(self, since: float = 0.0) -> list[Word]:
        """What this host said to the device since a time, s."""
        return [word for word in WORDS[self.kind](list(self.line.said)) if word.time >= since]

    def held_up_ms(self, begin: float) -> float:
        """How long this computer held up bytes beside this line soon after a time."""
        end = begin + WATCHED_SECONDS
        time.sleep(max(0.0, end + ARRIVAL_SECONDS - time.monotonic()))
        return self.pulse.longest_ms(begin, end)


def opened(kind: str) -> SimulatedDevice:
    """A simulated device of this kind."""
    if kind == "link":
        return device()
    return SimulatedDevice(SimulatedOptions(), haply=DEFAULT_MODEL)


@contextmanager
def desk(
    kind: str, hand: AbstractContextManager[Hand] | None = None, baud: int | None = None
) -> Iterator[Desk]:
    """A device of this kind, a simulated one unless told otherwise, listened to; its line carries
    `baud` bits a second, or as many as come.
    """
    with hand or opened(kind) as there, Overheard(there.port, baud) as line, Pulse() as pulse:
        yield Desk(kind, there, line, pulse)
