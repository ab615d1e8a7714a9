"""What bakes take, beside what was predicted before they began.

    python benchmarks/bake/prediction.py [FILE ...] [--times N]

Bakes the sample scenes' bodies, or the meshes in files (OBJ, PLY, STL), by default settings, each
in a process of its own with one thread, and prints seconds of tetrahedralization and of the rest,
predicted and taken. Claimed: each bake takes between half and twice what was predicted. Seconds
are the processor's, so that other work on the machine does not count. fTetWild does not take the
same time twice: ``--times`` bakes each mesh so often, and each of these is claimed.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from palpate.benchmarks.measuring.bodies import surface_of
from palpate.benchmarks.measuring.memory import in_fresh_process
from palpate.core.bake.cost.prediction import estimate_cost, predicted_mesh, tetrahedralize_seconds
from palpate.core.bake.cost.size import ShapeSize
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.errors import PalpateError
from palpate.core.mesh.decimate import decimate
from palpate.core.mesh.read_mesh import read_surface
from palpate.core.mesh.surface import Surface

BODIES = ("cube", "mouse", "drumstick", "hare")
SETTINGS = BakeSettings(threads=1)
LARGEST_FACTOR = 2.0


@dataclass(frozen=True)
class Row:
    """One bake: sizes, and seconds of tetrahedralization and of all, predicted and taken."""

    name: str
    size: ShapeSize
    predicted: tuple[float, float]
    taken: tuple[float, float]
    nodes: tuple[int, int]

    @property
    def factor(self) -> float:
        """Predicted over taken."""
        return self.predicted[1] / self.taken[1]

    def __str__(self) -> str:
        bending = (self.size.bending or 0.0) / self.size.diagonal
        shape = f"{self.size.triangles:6,} {bending:6.2f}"
        nodes = f"{self.nodes[0]:7,} {self.nodes[1]:7,}"
        filled = f"{self.predicted[0]:6.1f} {self.taken[0]:6.1f}"
        whole = f"{self.predicted[1]:6.1f} {self.taken[1]:6.1f} {self.factor:6.2f}"
        return f"{self.name:24.24} {shape} {nodes}   {filled}   {whole}"


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--times", type=int, default=1)
    asked = parser.parse_args()
    surfaces = {file.stem: read_surface(file) for file in asked.files}
    print(f"{'':23} triangles   bend   nodes: p. t.   fTetWild: p. t.    all: p. t. p/t")
    held = True
    for name, surface in (surfaces or {name: surface_of(name) for name in BODIES}).items():
        for _ in range(asked.times):
            try:
                row, _ = in_fresh_process(baked, name, surface)
            except PalpateError as refusal:
                print(f"{name:24.24} refused: {refusal}", flush=True)
                break
            print(row, flush=True)
            held &= 1 / LARGEST_FACTOR <= row.factor <= LARGEST_FACTOR
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def baked(name: str, surface: Surface) -> Row:
    """Bake once, in this process, which fTetWild fills with words and files."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    size = ShapeSize.of(decimate(surface.welded(), SETTINGS.decimate_above))
    cost = estimate_cost(ShapeSize.of(surface), SETTINGS)
    nodes = predicted_mesh(size, SETTINGS).nodes
    marks: dict[str, float] = {}

    def note(step: str, _share: float | None) -> None:
        marks.setdefault(step, time.process_time())

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        begun = time.process_time()
        body, _ = bake(surface, SETTINGS, note)
        ended = time.process_time()
        os.chdir("/")
    filled = marks["check"] - marks["tetrahedralize"]
    return Row(
        name,
        size,
        (tetrahedralize_seconds(size, SETTINGS, nodes), cost.seconds),
        (filled, ended - begun),
        (nodes, len(body.mesh.nodes)),
    )


if __name__ == "__main__":
    sys.exit(main())
