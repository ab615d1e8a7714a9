"""Hosts that end in the middle of a press, whatever ends them: what is then said to the device."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ..table import Row
from .desk import KINDS, Desk, Word, desk
from .host import eventually
from .trials import trials

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
SETTLING_SECONDS = 0.3
PROMISED_MS = 20.0


@dataclass(frozen=True)
class LastWords:
    """What a device heard since its host was sent a signal."""

    number: signal.Signals
    pushed: bool
    """There was a force before."""
    words: tuple[Word, ...]
    sent: float
    """Time of the signal, s."""
    held_up_ms: float
    """How long this computer held up a line that has nothing to do with it, at the longest."""

    @property
    def ms_to_zero(self) -> float:
        """From the signal to the first zero after the last force, ms; infinite without one."""
        zeros: list[Word] = []
        for word in self.words:
            zeros = [] if word.pushes else [*zeros, word]
        return (zeros[0].time - self.sent) * 1e3 if zeros else float("inf")


def end_by(number: signal.Signals, at: Desk, *, taken: bool = False) -> LastWords:
    """Press with a device, send its host a signal, and listen; another program may have taken the
    port.
    """
    with at.host() as host, at.line.taken() if taken else nullcontext():
        at.press(host)
        (own,) = guardians(host.pid)
        before = any(word.pushes for word in at.words())
        sent = time.monotonic()
        host.signal(number)
        time.sleep(SETTLING_SECONDS)
        last = LastWords(number, before, tuple(at.words(sent)), sent, at.held_up_ms(sent))
    # The next host meets nobody.
    eventually(lambda: own not in guardians(), "the guardian has ended")
    return last


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


def guardian_rows(times: int, wanted: Callable[[str], bool]) -> Iterator[Row]:
    """A row for each signal and each kind of device, and one for a port that another has taken."""
    for kind in KINDS:
        place = partial(desk, kind)
        yield from ending_rows(place, kind, times, wanted)
        injected = f"SIGKILL to the host, its port taken by another, {kind}"
        if wanted(injected):
            by = partial(end_by, signal.SIGKILL, taken=True)
            yield _ended_row(place, injected, times, by)


def ending_rows(
    place: Callable[[], AbstractContextManager[Desk]],
    name: str,
    times: int,
    wanted: Callable[[str], bool],
) -> Iterator[Row]:
    """A row for each signal to hosts of this device, whose hosts follow each other."""
    for number in SIGNALS:
        injected = f"{number.name} to the host, {name}"
        if wanted(injected):
            yield _ended_row(place, injected, times, partial(end_by, number))


def _ended_row(
    place: Callable[[], AbstractContextManager[Desk]],
    injected: str,
    times: int,
    end: Callable[[Desk], LastWords],
) -> Row:
    with place() as at:
        ended = trials(times, partial(end, at))
    pushed = [one.pushed for one in ended.judged]
    worst = max((one.ms_to_zero for one in ended.judged), default=float("inf"))
    return ending_row(injected, "(no host)", pushed, worst, ended.note)


def ending_row(injected: str, told: str, pushed: Sequence[bool], worst_ms: float, note: str) -> Row:
    """Row of devices that were to hear zero, of which each had to push before."""
    broken = []
    if not all(pushed):
        broken.append("it did not push")
    if not pushed:
        broken.append("this computer was held up: not judged")
    if worst_ms > PROMISED_MS:
        broken.append(f"zero later than {PROMISED_MS:g} ms")
    return Row(
        injected=injected,
        times=len(pushed),
        told=told,
        broken=tuple(broken),
        zero_ms=worst_ms,
        note=note,
    )
