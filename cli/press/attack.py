"""``palpate devices attack``: an adversary for the servo, or for a device."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path

from ...core.errors import PalpateError
from ...simulated.attack.attack import KINDS, Attack, real_table, virtual_tables
from ...simulated.attack.published import publish
from ...simulated.attack.table import Table

HELP = "attack the servo as a hostile device, or a device as a hostile host"
DESCRIPTION = (
    "Attack the servo as a hostile device ('simulated'), in virtual time and with --real on a real "
    "pseudo-terminal, and print what came of each injection. Exits with 1 if a rule of "
    "docs/safety.md is broken."
)
SIMULATED = "simulated"
EXIT_BROKEN = 1


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "target",
        metavar="TARGET",
        help=f"{SIMULATED}, or one kind of device only: "
        + ", ".join(f"{SIMULATED}:{kind}" for kind in KINDS),
    )
    parser.add_argument("--times", type=int, default=40, help="of each kind (default: 40)")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same table (default: 1)")
    parser.add_argument("--only", default="", metavar="TEXT", help="injections with this in them")
    parser.add_argument(
        "--body",
        type=Path,
        nargs="+",
        action="extend",
        default=[],
        metavar="BODY.npz",
        help="touch these beside a cube",
    )
    parser.add_argument(
        "--real",
        action="store_true",
        help="processes on a pseudo-terminal instead of virtual time; real seconds",
    )
    parser.add_argument(
        "--publish", type=Path, metavar="FILE", help="put the tables into this document"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Attack, print the tables; 1 if a rule is broken."""
    if arguments.times < 1:
        raise PalpateError("--times must be at least 1")
    tables = []
    for table in _tables(arguments):
        tables.append(table)
        if not arguments.json:
            print("\n".join(table.lines()), flush=True)
            print()
    if arguments.json:
        print(json.dumps({"tables": [dataclasses.asdict(table) for table in tables]}))
    if arguments.publish is not None:
        publish(arguments.publish, tables)
    return EXIT_BROKEN if any(table.broken for table in tables) else 0


def _tables(arguments: argparse.Namespace) -> Iterator[Table]:
    attack = Attack(
        kinds=_kinds(arguments.target),
        times=arguments.times,
        seed=arguments.seed,
        bodies=tuple(arguments.body),
        only=arguments.only,
    )
    if arguments.real:
        return iter([real_table(attack, _say)])
    return virtual_tables(attack, _say)


def _kinds(target: str) -> tuple[str, ...]:
    name, _, kind = target.partition(":")
    if name == SIMULATED and (kind in KINDS or target == SIMULATED):
        return (kind,) if kind else KINDS
    known = ", ".join(f"{SIMULATED}:{kind}" for kind in KINDS)
    raise PalpateError(
        "{target}: not a target of an attack; take {known}, or {simulated} for all",
        target=target,
        known=known,
        simulated=SIMULATED,
    )


def _say(line: str) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{line}")
        sys.stderr.flush()
