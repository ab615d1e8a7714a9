"""``palpate devices attack``: an adversary for the servo, or for a device."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path

from ...core.errors import PalpateError
from ...core.servo.ports import BAUD, check_port
from ...simulated.attack.attack import KINDS, Attack, real_table, virtual_tables
from ...simulated.attack.port.host_attack import HostAttack, host_table
from ...simulated.attack.published import REAL, VIRTUAL, publish
from ...simulated.attack.table import Table

HELP = "attack the servo as a hostile device, or a device as a hostile host"
DESCRIPTION = (
    "Attack the servo as a hostile device ('simulated'), in virtual time and with --real on a real "
    "pseudo-terminal, or as a hostile host the device at a port, and print what came of each "
    "injection. Exits with 1 if a rule of docs/safety.md or docs/link.md is broken."
)
SIMULATED = "simulated"
EXIT_BROKEN = 1


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "target",
        metavar="TARGET",
        help=f"{SIMULATED}, or one kind of device only ("
        + ", ".join(f"{SIMULATED}:{kind}" for kind in KINDS)
        + "), or the port of a device that speaks the link",
    )
    parser.add_argument("--times", type=int, default=40, help="of each kind (default: 40)")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same table (default: 1)")
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="TEXT",
        help="injections with one of these in their names",
    )
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
        "--board",
        type=Path,
        metavar="PROGRAM",
        help="with --real: also beside firmware/host/main.cpp, compiled",
    )
    parser.add_argument(
        "--kept",
        type=Path,
        metavar="FILE",
        help="with --real: keep rows here as they are found; those that are here already are not "
        "tried again, so that what was broken off goes on",
    )
    parser.add_argument(
        "--publish",
        type=Path,
        metavar="FILE",
        help="put the tables into this document; those of --real have a place of their own",
    )
    at_port = parser.add_argument_group("a device at a port")
    at_port.add_argument(
        "--max-force",
        type=float,
        default=0.2,
        metavar="N",
        help="ask for no more than this (default: %(default)s)",
    )
    at_port.add_argument(
        "--allowance",
        type=float,
        default=10.0,
        metavar="MS",
        help="what line and computer may take of the device's 20 ms (default: %(default)s)",
    )
    at_port.add_argument(
        "--baud",
        type=int,
        default=BAUD,
        metavar="BITS",
        help="speed of the line, as the device has it (default: %(default)s)",
    )
    at_port.add_argument("--yes", action="store_true", help="begin without asking")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Attack, print the tables; 1 if a rule is broken."""
    if arguments.times < 1:
        raise PalpateError("--times must be at least 1")
    if arguments.kept and not arguments.real:
        raise PalpateError("--kept goes with --real: in virtual time a table takes minutes")
    tables = []
    for table in _tables(arguments):
        tables.append(table)
        if not arguments.json:
            print("\n".join(table.lines()), flush=True)
            print()
    if arguments.json:
        print(json.dumps({"tables": [dataclasses.asdict(table) for table in tables]}))
    if arguments.publish is not None:
        publish(arguments.publish, tables, REAL if arguments.real else VIRTUAL)
    return EXIT_BROKEN if any(table.broken for table in tables) else 0


def _tables(arguments: argparse.Namespace) -> Iterator[Table]:
    name, _, kind = arguments.target.partition(":")
    if name != SIMULATED:
        return iter([_at_port(arguments)])
    if kind not in ("", *KINDS):
        raise PalpateError(
            "{target}: no such kind of device; take one of {known}, or {simulated} for all",
            target=arguments.target,
            known=", ".join(f"{SIMULATED}:{known}" for known in KINDS),
            simulated=SIMULATED,
        )
    attack = Attack(
        kinds=(kind,) if kind else KINDS,
        times=arguments.times,
        seed=arguments.seed,
        bodies=tuple(arguments.body),
        only=tuple(arguments.only),
        board=arguments.board,
        kept=arguments.kept,
    )
    if arguments.real:
        return iter([real_table(attack, _say)])
    return virtual_tables(attack, _say)


def _at_port(arguments: argparse.Namespace) -> Table:
    attack = HostAttack(
        path=arguments.target,
        times=arguments.times,
        seed=arguments.seed,
        only=tuple(arguments.only),
        largest_force=arguments.max_force,
        allowance_ms=arguments.allowance,
        baud=arguments.baud,
    )
    check_port(attack.path)
    warning = (
        f"{attack.path}: its motors will push for some minutes, in all directions and by jerks, "
        f"with up to {attack.largest_force:g} N as told. Hold nothing that matters; pull the plug "
        "to end it"
    )
    if not arguments.yes:
        if not sys.stdin.isatty():
            raise PalpateError("{warning}. Give --yes to begin", warning=warning)
        print(warning, file=sys.stderr)
        if input("begin? [y/N] ").strip().lower() not in ("y", "yes"):
            raise PalpateError("not begun")
    else:
        print(warning, file=sys.stderr)
    return host_table(attack, _say)


def _say(line: str) -> None:
    """On a terminal the newest line alone; elsewhere all, as a record of an hour that broke off."""
    is_shown = sys.stderr.isatty()
    sys.stderr.write(f"\r\033[K{line}" if is_shown else f"{line}\n")
    sys.stderr.flush()
