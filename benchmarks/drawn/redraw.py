"""What a step of a press costs beside a shape key and beside Blender's own Elastic Grab.

    python benchmarks/drawn/redraw.py [--quick]

A ball of 3,000, 126,000 and 504,000 vertices (``--quick``: without the last) in the windowed
Blender, all in one run: a live layer whose vertices all move under a fingertip, a shape key that is
written anew, and a step of a sculpting stroke. Milliseconds of the processor, of all threads,
medians: what hands the step over, Blender's evaluation, and its drawing (in software here, and so
most of it). The layer's own share has the shape in it, from the body's nodes to the vertices, and
what keeps these out of the tool; the key's places are known. Beside, megabytes of memory that the
system hands out page by page: of 504,000 vertices the layer's attribute and the moved places go
into such memory anew in each step, for Blender still shows the last ones; a shape key's do not.

Claims: the layer's own share within 10 ms for all, and evaluating it at most `MOST_OF_KEY` times
the shape key, or `MOST_WHEN_FRESH` times where that needs fresh memory, and `NODES` ms more: so
much the nodes cost with the smallest mesh.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "tests" / "gui"))

from windowed_blender import WindowedBlender, package_of, program_of  # noqa: E402

SCENARIO = "redraw_in_window::a_step_is_drawn"
COUNTS = ("3000", "126000", "504000")
MOST_OWN, MOST_OF_KEY, MOST_WHEN_FRESH, NODES = 10.0, 1.5, 2.0, 0.5
# Below so much only what is small is written anew.
FRESH_MEGABYTES = 1.0
LIMIT_SECONDS = 1200.0


def main() -> int:
    """Print the table; 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true")
    counts = COUNTS[:-1] if parser.parse_args().quick else COUNTS
    program, package = program_of(PROJECT), package_of(PROJECT)
    if not os.access(program, os.X_OK) or not package.is_file():
        print("not measured: there is no Blender with a window, or no package (make test-gui)")
        return 0
    blender = WindowedBlender(
        program,
        package,
        PROJECT,
        folder=str(PROJECT / "benchmarks" / "measuring" / "redraw"),
        arguments=counts,
        limit_seconds=LIMIT_SECONDS,
        output=PROJECT / "build" / "redraw",
    )
    blender.play([SCENARIO])
    outcome = blender.outcomes[SCENARIO]
    kept = [_table(outcome.figures[count]) for count in counts if count in outcome.figures]
    print(outcome.failure or ("the claims hold" if all(kept) else "the claims do NOT hold"))
    return 0 if all(kept) and not outcome.failure else 1


def _table(figures: dict[str, dict[str, float]]) -> bool:
    """Print the rows of one count; whether the claims hold."""
    print(f"{figures['vertices']:,} vertices; ms    own  evaluation  drawing   MB fresh for these")
    for name in ("layer", "shape key", "elastic grab"):
        one = figures[name]
        print(
            f"  {name:<18}{one['own']:9.1f}{one['evaluation']:12.1f}{one['drawing']:9.1f}"
            f"{one['fresh for own']:12.1f}{one['fresh for evaluation']:6.1f}"
        )
    layer, key = figures["layer"], figures["shape key"]
    is_fresh = layer["fresh for evaluation"] > FRESH_MEGABYTES
    most = MOST_WHEN_FRESH if is_fresh else MOST_OF_KEY
    return layer["own"] <= MOST_OWN and layer["evaluation"] <= most * key["evaluation"] + NODES


if __name__ == "__main__":
    sys.exit(main())
