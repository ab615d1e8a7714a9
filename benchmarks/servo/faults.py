"""What is injected in the middle of a press, how often, and what comes out: zero force, and a name.

    python benchmarks/servo/faults.py [--times N] [--virtual]

The first table is in virtual time: the servo's own ticks and the simulated device's own program,
each with its own codec, and between them whoever spoils the line. The second is of real processes
on a pseudo-terminal: the host stopped and killed by signals, the plug pulled, a reader that stalls.
``--virtual`` leaves that out.

Every row is judged by the rules of docs/safety.md; a row that breaks one says FAILED, and the exit
code is 1.
"""

from __future__ import annotations

import argparse
import sys
from random import Random

from palpate.tests.fault_injection.causes import CAUSES
from palpate.tests.fault_injection.episodes import killed_row, virtual_row
from palpate.tests.fault_injection.processes import process_rows
from palpate.tests.fault_injection.rows import print_rows
from palpate.tests.fault_injection.virtual_press import MAX_SLEW, RAMP_SECONDS


def main() -> int:
    """Both tables; 1 if a rule is broken."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=40, help="in virtual time (default: 40)")
    parser.add_argument("--virtual", action="store_true", help="no processes")
    arguments = parser.parse_args()
    dice = Random(4)  # noqa: S311 - which fault when, not secrets
    rows = [virtual_row(cause, arguments.times, dice) for cause in CAUSES]
    rows.append(killed_row(arguments.times, dice))
    title = f"In virtual time, 1 kHz, ramp {RAMP_SECONDS * 1e3:.0f} ms, 3 N, {MAX_SLEW:.0f} N/s"
    print_rows(title, rows)
    if not arguments.virtual:
        more = process_rows()
        print_rows("Real processes on a pseudo-terminal", more)
        rows += more
    return int(any(row.broken for row in rows))


if __name__ == "__main__":
    sys.exit(main())
