"""Guardians that are killed or stopped in mid-press: noticed by their hosts, and replaced."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import product

from ..table import Row
from .desk import KINDS, Desk, desk
from .guardians import LastWords, ending_row, guardians
from .host import Host, eventually
from .processes import killed_row
from .trials import trials

SIGNALS: tuple[signal.Signals, ...] = ()
if sys.platform != "win32":
    SIGNALS = (signal.SIGKILL, signal.SIGSTOP)


HEARD_SECONDS = 1.0
ALONE = "SIGKILL to the host and its guardian, link"


@dataclass(frozen=True)
class Loss:
    """A guardian that was killed or stopped, and what its host did then."""

    pushed: bool
    """There was a force before."""
    unguarded: int
    """Faults of that name."""
    ms_to_zero: float
    """From the signal to the first zero, ms; infinite without one."""
    held_up_ms: float
    """By this computer, a line beside it, at the longest."""
    last: LastWords
    """What was said when the host was killed while it pressed again."""


def lose(at: Desk, by: signal.Signals) -> Loss:
    """Press with a device, send its guardian a signal, press again, and kill the host."""
    with at.host() as host:

        def others(pid: int) -> list[int]:
            return [found for found in guardians(host.pid) if found != pid]

        at.press(host)
        (first,) = guardians(host.pid)
        pushed = any(word.pushes for word in at.words())
        sent = time.monotonic()
        os.kill(first, by)
        eventually(lambda: host.report()["faults"]["unguarded"] > 0, "the host notices")
        eventually(lambda: bool(others(first)), "another guardian is there")
        eventually(lambda: first not in guardians(), "the first guardian has ended")
        zero = _first_zero(at, sent)
        at.press(host)
        unguarded = host.report()["faults"]["unguarded"]
        # On a busy computer a second one may have been replaced as well.
        later = set(others(first))
        killed = time.monotonic()
        host.signal(signal.SIGKILL)
        eventually(lambda: not later & set(guardians()), "later guardians have ended")
        return Loss(
            pushed=pushed,
            unguarded=unguarded,
            ms_to_zero=(zero - sent) * 1e3,
            last=LastWords(
                signal.SIGKILL, pushed, tuple(at.words(killed)), killed, at.held_up_ms(killed)
            ),
            held_up_ms=max(at.held_up_ms(sent), at.held_up_ms(killed)),
        )


def _first_zero(at: Desk, since: float) -> float:
    """When the first zero was heard; infinity without one in a time longer than any line takes."""
    deadline = time.monotonic() + HEARD_SECONDS
    while True:
        zeros = [word.time for word in at.words(since) if not word.pushes]
        if zeros or time.monotonic() > deadline:
            return min(zeros, default=float("inf"))
        time.sleep(0.005)


def leave_alone(host: Host) -> None:
    """End a host and its guardian at once: the last word is a force, and nobody is there."""
    own = guardians(host.pid)
    # A host that is stopped does not see that its guardian has ended.
    host.signal(signal.SIGSTOP)
    for pid in own:
        os.kill(pid, signal.SIGKILL)
    host.signal(signal.SIGKILL)


def lost_guardian_rows(times: int, wanted: Callable[[str], bool]) -> Iterator[Row]:
    """A row for each kind of device and signal, and one for a host that ends with its guardian."""
    if wanted(ALONE):
        yield killed_row(times, ALONE, end=leave_alone)
    for kind, by in product(KINDS, SIGNALS):
        injected = f"{by.name} to the guardian, then SIGKILL to the host, {kind}"
        if not wanted(injected):
            continue
        with desk(kind) as at:
            losses = trials(times, partial(lose, at, by))
        ways = [loss.last.ms_to_zero for loss in losses.judged]
        if by is signal.SIGKILL:
            # One that is stopped is found by its silence, later: the host lives meanwhile.
            ways += [loss.ms_to_zero for loss in losses.judged]
        pushed = [loss.pushed for loss in losses.judged]
        worst = max(ways, default=float("inf"))
        yield ending_row(injected, "unguarded", pushed, worst, losses.note)
