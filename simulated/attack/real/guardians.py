"""Hosts that end in the middle of a press, whatever ends them: what is then said to the device."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from ....core.servo import link
from ....core.servo.haply_models import DEFAULT_MODEL, haply_model
from ...board.haply_firmware import TORQUES
from ...hand.options import SimulatedOptions
from ...simulated_process import SimulatedDevice
from ..table import Row
from .host import Host, device
from .overheard import Overheard
from .pressing import INTO_THE_CUBE, Way, press

SIGNALS: tuple[signal.Signals, ...] = ()
if sys.platform != "win32":
    SIGNALS = (
        signal.SIGKILL,
        signal.SIGSEGV,
        signal.SIGABRT,
        signal.SIGQUIT,
        signal.SIGTERM,
        signal.SIGSTOP,
    )
KINDS = ("link", "haply")
WAYS = {
    "link": INTO_THE_CUBE,
    "haply": Way(haply_model(DEFAULT_MODEL).rest, (0.002, -0.012, 0.0), 0.3),
}
"""In the 2DIY's own axes 12 mm below the cube's top."""
SETTLING_SECONDS = 0.3
FILL = 0x10
NO_TORQUE = bytes([FILL] * 4)
REQUEST = 10
PROMISED_MS = 20.0


@dataclass(frozen=True)
class Word:
    """A force, or none, that was said to a device at a time, s."""

    time: float
    pushes: bool


@dataclass(frozen=True)
class LastWords:
    """What a device heard since its host was sent a signal."""

    number: signal.Signals
    pushed: bool
    """There was a force before."""
    words: tuple[Word, ...]
    sent: float
    """Time of the signal, s."""

    @property
    def ms_to_zero(self) -> float:
        """From the signal to the first zero after the last force, ms; infinite without one."""
        zeros: list[Word] = []
        for word in self.words:
            zeros = [] if word.pushes else [*zeros, word]
        return (zeros[0].time - self.sent) * 1e3 if zeros else float("inf")


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


def end_by(number: signal.Signals, kind: str) -> LastWords:
    """Press with a device of this kind, send its host a signal, and listen."""
    with ExitStack() as stack:
        hand = stack.enter_context(hand_of(kind))
        line = stack.enter_context(Overheard(hand.port))
        host = stack.enter_context(Host(line.port, kind))
        press(host, hand, WAYS[kind])
        before = [w for w in WORDS[kind](list(line.said)) if w.pushes]
        sent = time.monotonic()
        host.signal(number)
        time.sleep(SETTLING_SECONDS)
        words = [word for word in WORDS[kind](list(line.said)) if word.time >= sent]
        return LastWords(number, bool(before), tuple(words), sent)


def hand_of(kind: str) -> SimulatedDevice:
    """A simulated device of this kind."""
    if kind == "link":
        return device()
    return SimulatedDevice(SimulatedOptions(), haply=DEFAULT_MODEL)


def guardians(host: int | None = None) -> list[int]:
    """Process ids of the guardians that run on this Linux; of one host only, by its id."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if not (folder / "cmdline").read_bytes().startswith(b"palpate-guardian"):
                continue
            # After the name, which may hold anything, the state and the parent.
            parent = (folder / "stat").read_text().rpartition(")")[2].split()[1]
            if host is None or int(parent) == host:
                found.append(int(folder.name))
        except OSError:
            # It has ended meanwhile.
            continue
    return found


def guardian_rows(times: int, signals: Sequence[signal.Signals] = SIGNALS) -> list[Row]:
    """A row for each signal and each kind of device."""
    rows = []
    for kind in KINDS:
        for number in signals:
            all_of_them = [end_by(number, kind) for _ in range(times)]
            injected = f"{number.name} to the host, {kind}"
            pushed = [one.pushed for one in all_of_them]
            worst = max(one.ms_to_zero for one in all_of_them)
            rows.append(ending_row(injected, "(no host)", pushed, worst))
    return rows


def ending_row(injected: str, told: str, pushed: Sequence[bool], worst_ms: float) -> Row:
    """Row of devices that were to hear zero, of which each had to push before."""
    broken = []
    if not all(pushed):
        broken.append("it did not push")
    if worst_ms > PROMISED_MS:
        broken.append(f"zero later than {PROMISED_MS:g} ms")
    return Row(
        injected=injected,
        times=len(pushed),
        told=told,
        broken=tuple(broken),
        zero_ms=worst_ms,
    )
