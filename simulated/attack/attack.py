"""Attacks on the servo: which kinds of device, which bodies, which injections, how often."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from ...core.errors import PalpateError
from .kept import keep_rows, kept_rows
from .real.firmware import firmware_rows
from .real.guardians import guardian_rows
from .real.lost_guardians import lost_guardian_rows
from .real.processes import process_rows
from .real.stalled_reader import stalled_reader_rows
from .table import Row, Table, cells, is_chosen
from .target import Target, baked_target, cube_target
from .virtual.cause import Cause
from .virtual.causes import CAUSES, HAPLY_CAUSES
from .virtual.episodes import attacked, unheard
from .virtual.haply_press import HaplyPress
from .virtual.virtual_press import MAX_FORCE, MAX_SLEW, RAMP_SECONDS, VirtualPress

KINDS = ("link1", "link2", "haply")


@dataclass(frozen=True)
class Attack:
    """What is tried; `bodies` are touched beside the cube, `only` are parts of causes' names."""

    kinds: tuple[str, ...] = KINDS
    times: int = 40
    seed: int = 1
    bodies: tuple[Path, ...] = ()
    only: tuple[str, ...] = ()
    board: Path | None = None
    """The firmware for boards, compiled for this computer."""
    kept: Path | None = None
    """Where rows of real processes are kept as they are found, and taken from."""


def virtual_tables(attack: Attack, say: Callable[[str], None]) -> Iterator[Table]:
    """Attack in virtual time, a table for each kind of device and body.

    Raises PalpateError where the servo cannot be stepped, and for what is no body.
    """
    causes = {kind: _chosen(kind, attack.only) for kind in attack.kinds}
    if not any(causes.values()):
        raise _nothing_chosen(attack.only)
    for target in [cube_target(), *map(baked_target, attack.bodies)]:
        for kind in attack.kinds:
            yield _virtual_table(kind, target, causes[kind], attack, say)


def _chosen(kind: str, only: tuple[str, ...]) -> list[Cause]:
    if kind == "haply":
        causes = HAPLY_CAUSES
    else:
        causes = tuple(cause for cause in CAUSES if int(kind[-1]) in cause.protocols)
    return [cause for cause in causes if is_chosen(cause.name, only)]


def _virtual_table(
    kind: str, target: Target, causes: list[Cause], attack: Attack, say: Callable[[str], None]
) -> Table:
    def make(rate_hz: int) -> VirtualPress:
        if kind == "haply":
            return HaplyPress(target)
        return VirtualPress(target, rate_hz=rate_hz, protocol=int(kind[-1]))

    rows = []
    for cause in causes:
        say(f"{kind}, {target.name}: {cause.name}")
        rows.append(attacked(make, cause, attack.times, attack.seed))
    if kind != "haply" and not attack.only:
        rows.append(unheard(make, attack.times, attack.seed))
    limits = f"ramp {RAMP_SECONDS * 1e3:.0f} ms, {MAX_FORCE:g} N, {MAX_SLEW:.0f} N/s"
    title = (
        f"A hostile device ({kind}) at a servo on {target.name}, in virtual time; 1 kHz, {limits}"
    )
    return Table(title, tuple(rows))


def real_table(attack: Attack, say: Callable[[str], None]) -> Table:
    """Attack processes on pseudo-terminals: signals, the plug, a reader that stalls.

    Raises
    ------
    PalpateError
        Windows has neither; or what was kept is no such file.
    OSError
        It cannot be read or written.
    """
    if sys.platform == "win32":
        raise PalpateError(
            "--real: Windows has no pseudo-terminals and no such signals; run it on Linux or "
            "macOS, or without --real"
        )

    times, board = attack.times, attack.board
    kept = kept_rows(attack.kept, times) if attack.kept else {}
    rows: list[Row] = []

    def wanted(injected: str) -> bool:
        if not is_chosen(injected, attack.only):
            return False
        if injected in kept:
            rows.append(kept[injected])
            return False
        say(f"on a pseudo-terminal: {injected}")
        return True

    # What was tried for an hour is said, and kept, before the next is tried.
    for row in chain(
        process_rows(times, wanted),
        stalled_reader_rows(wanted),
        guardian_rows(times, wanted),
        lost_guardian_rows(times, wanted),
        firmware_rows(board, times, wanted) if board else (),
    ):
        say("  ".join(cells(row)).rstrip())
        rows.append(row)
        if attack.kept:
            kept[row.injected] = row
            keep_rows(attack.kept, times, kept)
    if not rows:
        raise _nothing_chosen(attack.only)
    return Table("Real processes on a pseudo-terminal", tuple(rows))


def _nothing_chosen(only: tuple[str, ...]) -> PalpateError:
    return PalpateError(
        "no injection has {only} in its name; leave out --only for all",
        only=" or ".join(map(repr, only)),
    )
