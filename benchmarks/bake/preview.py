"""How long it takes until a preview can be pressed, beside starting another process for it.

    python benchmarks/bake/preview.py [FILE ...]

Makes the previews of the sample scenes' bodies, or of the meshes in files (OBJ, PLY, STL), in a
thread as Make Soft does, and prints seconds by the clock and by the processor, nodes, and how far
the surface lies from it at most; then what a process takes that only imports what a bake needs.
Claimed: half a second of the processor, which is what it takes by the clock where nothing else
runs.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

from palpate.benchmarks.measuring.bodies import surface_of
from palpate.benchmarks.measuring.timing import seconds_of
from palpate.core.bake.preview_job import PreviewJob
from palpate.core.bake.settings import BakeSettings
from palpate.core.mesh.read_mesh import read_surface
from palpate.core.mesh.surface import Surface

BODIES = ("cube", "mouse", "drumstick", "hare")
LONGEST_SECONDS = 0.5
IMPORTS = "import palpate.core.bake.steps"


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path)
    asked = parser.parse_args()
    surfaces = {file.stem: read_surface(file) for file in asked.files}
    surfaces = surfaces or {name: surface_of(name) for name in BODIES}
    print(f"{'':24} triangles  clock, s  processor, s   nodes   off, %")
    longest = max(previewed(name, surface) for name, surface in surfaces.items())
    importing = seconds_of(lambda: subprocess.run([sys.executable, "-c", IMPORTS], check=True))
    print(f"a process that only imports what a bake needs: {importing:.2f} s")
    held = longest < LONGEST_SECONDS
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def previewed(name: str, surface: Surface) -> float:
    """Make one, print its row, and return its seconds of the processor."""
    clock, processor = time.perf_counter(), time.process_time()
    made = PreviewJob(surface, BakeSettings()).result()
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    told = "none" if made is None else f"{len(made.body.mesh.nodes):7} {100 * made.off:8.1f}"
    print(f"{name:24.24} {len(surface.triangles):9,} {clock:9.2f} {processor:13.2f} {told}")
    return processor


if __name__ == "__main__":
    sys.exit(main())
