"""What bakes of smoothed elements take beside those of linear ones.

    python benchmarks/bake/formulations.py [--bodies mouse-1.7k cube-4.9k mouse-20k]

Bakes given tetrahedra in a process of its own, one thread, in the form that is chosen by itself:
seconds of the processor, and the bytes by which the process grows at most. Claim: smoothed elements
take at most three times the seconds and at most twice the memory.
"""

from __future__ import annotations

import argparse
import sys
import time

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.memory import in_fresh_process
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.stiffness.pins import PinNodes

CUBE, CUBE_CELLS = "cube-4.9k", 16
BODIES = ("mouse-1.7k", CUBE, "mouse-20k")
FORMULATIONS = ("linear", "smoothed")
# Smoothed over linear.
MOST_SECONDS, MOST_MEMORY = 3.0, 2.0


def baked(name: str, formulation: str) -> float:
    """Seconds of the processor that a bake takes, in this process."""
    mesh, fixed = paper_cube(cells=CUBE_CELLS) if name == CUBE else tets_of(name)
    settings = BakeSettings(0.3, 1000.0, PinNodes(fixed), formulation=formulation, threads=1)
    start = time.process_time()
    bake(mesh, settings)
    return time.process_time() - start


def main() -> int:
    """Print the table; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", choices=BODIES, default=BODIES)
    is_kept = True
    for name in parser.parse_args().bodies:
        taken = []
        for formulation in FORMULATIONS:
            seconds, grown = in_fresh_process(baked, name, formulation)
            taken.append((seconds, grown / 1e6))
            print(f"{name:<12}{formulation:<10}{seconds:>8.2f} s{grown / 1e6:>8.0f} MB", flush=True)
        (seconds, memory), (more_seconds, more_memory) = taken
        print(f"{'':<12}{'times':<10}{more_seconds / seconds:>8.2f}  {more_memory / memory:>8.2f}")
        is_kept &= more_seconds <= MOST_SECONDS * seconds and more_memory <= MOST_MEMORY * memory
    print("the claim holds" if is_kept else "the claim does NOT hold, see above")
    return 0 if is_kept else 1


if __name__ == "__main__":
    sys.exit(main())
