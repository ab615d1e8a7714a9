"""Plays storms of random events in the windowed Blender, and says what came of each.

    python tests/gui/storm/play.py [--seeds 1 2 3] [--events 10000]

Its log, a picture and the figures are left in build/storm/.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(HERE.parent))

from windowed_blender import Outcome, WindowedBlender, package_of, program_of  # noqa: E402

SCENARIO = "long_storm::random_events_leave_the_meshes_and_nothing_running"
# For a machine that does much else; about a tenth of it otherwise.
SECONDS_AN_EVENT = 0.5
# Most of the time is drawing, pixel by pixel.
SCREEN = "800x600"


def main() -> int:
    """Play and print; 1 when a storm left something."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3])
    parser.add_argument("--events", type=int, default=10_000)
    asked = parser.parse_args()
    failed = 0
    for seed in asked.seeds:
        outcome = play(seed, asked.events)
        failed += bool(outcome.failure)
        print(f"seed {seed}, {asked.events:,} events: {outcome.failure or 'nothing is left'}")
        print(f"  {outcome.figures}", flush=True)
    return 1 if failed else 0


def play(seed: int, events: int) -> Outcome:
    """What became of one storm."""
    blender = WindowedBlender(
        program_of(REPOSITORY),
        package_of(REPOSITORY),
        REPOSITORY,
        folder="storm",
        arguments=(str(seed), str(events)),
        limit_seconds=120.0 + SECONDS_AN_EVENT * events,
        output=REPOSITORY / "build" / "storm" / str(seed),
        screen=SCREEN,
    )
    blender.play([SCENARIO])
    return blender.outcomes[SCENARIO]


if __name__ == "__main__":
    sys.exit(main())
