"""Guardians that are killed or stopped in mid-press: noticed by their hosts, and replaced."""

from __future__ import annotations

import os
import signal
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import product

from ..table import Row
from .guardians import WAYS, WORDS, LastWords, ending_row, guardians, hand_of
from .host import Host, eventually
from .overheard import Overheard
from .pressing import press

SIGNALS: tuple[signal.Signals, ...] = ()
if sys.platform != "win32":
    SIGNALS = (signal.SIGKILL, signal.SIGSTOP)


@dataclass(frozen=True)
class Loss:
    """A guardian that was killed or stopped, and what its host did then."""

    pushed: bool
    """There was a force before."""
    unguarded: int
    """Faults of that name."""
    ms_to_zero: float
    """From the signal to the first zero, ms; infinite without one."""
    last: LastWords
    """What was said when the host was killed while it pressed again."""


def lose(kind: str, by: signal.Signals) -> Loss:
    """Press with a device, send its guardian a signal, press again, and kill the host."""
    with ExitStack() as stack:
        hand = stack.enter_context(hand_of(kind))
        line = stack.enter_context(Overheard(hand.port))
        host = stack.enter_context(Host(line.port, kind))

        def others(pid: int) -> list[int]:
            return [found for found in guardians(host.process.pid) if found != pid]

        press(host, hand, WAYS[kind])
        (first,) = guardians(host.process.pid)
        pushed = any(word.pushes for word in WORDS[kind](list(line.said)))
        sent = time.monotonic()
        os.kill(first, by)
        eventually(lambda: host.report()["faults"]["unguarded"] > 0, "the host notices")
        eventually(lambda: bool(others(first)), "another guardian is there")
        eventually(lambda: first not in guardians(), "the first guardian has ended")
        words = [word for word in WORDS[kind](list(line.said)) if word.time >= sent]
        zero = next((word.time for word in words if not word.pushes), float("inf"))
        press(host, hand, WAYS[kind])
        unguarded = host.report()["faults"]["unguarded"]
        (second,) = others(first)
        killed = time.monotonic()
        host.signal(signal.SIGKILL)
        eventually(lambda: second not in guardians(), "the second guardian has ended")
        last = tuple(word for word in WORDS[kind](list(line.said)) if word.time >= killed)
        return Loss(
            pushed=pushed,
            unguarded=unguarded,
            ms_to_zero=(zero - sent) * 1e3,
            last=LastWords(signal.SIGKILL, pushed, last, killed),
        )


def lost_guardian_rows(times: int) -> list[Row]:
    """A row for each kind of device and signal."""
    rows = []
    for kind, by in product(WAYS, SIGNALS):
        losses = [lose(kind, by) for _ in range(times)]
        worst = max(loss.last.ms_to_zero for loss in losses)
        if by is signal.SIGKILL:
            # One that is stopped is found by its silence, later: the host lives meanwhile.
            worst = max(worst, *(loss.ms_to_zero for loss in losses))
        injected = f"{by.name} to the guardian, then SIGKILL to the host, {kind}"
        rows.append(ending_row(injected, "unguarded", [loss.pushed for loss in losses], worst))
    return rows
