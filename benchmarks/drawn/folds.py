"""What it takes to keep the drawn surface of a body out of itself, and how deep it still is.

    python benchmarks/drawn/folds.py [--times N]

The plush hare, as *Real* draws it: its ears are led to each other, beside each other, and over its
face; processor's time of a picture, medians. The exit status tells whether what is left is less
than 2 % of the hare's size everywhere. Depths are told by what finds them in the product; that is
held against a look into tetrahedra by `tests/core/fold`.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.fold.folds import Folds
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.shapes import shape
from palpate.core.stiffness.pins import PinNodes

HARE = Path(__file__).resolve().parents[2] / "sample_scenes" / "hare-tets.npz"
# Ways of the left ear, newtons spread over its upper half, and the modulus, pascal.
ASKED = {
    "to the other ear": ((0.0, -1.0, 0.0), (0.002, 0.006, 0.008, 0.012, 0.02)),
    "aside": ((0.3, 1.0, -0.5), (0.006, 0.02)),
    "over the face": ((1.0, 0.0, -0.3), (0.006, 0.02)),
}
EAR, YOUNG = 0.15, 2e4
MOST = 0.02


def main() -> int:
    """Prints depths and times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=5)
    options = parser.parse_args()
    with np.load(HARE) as stored:
        mesh = TetMesh.checked(stored["X"], stored["T"])
        pins = PinNodes(stored["fixed"])
    body, _ = bake(mesh, BakeSettings(poisson_ratio=0.1, young_modulus=YOUNG, pins=pins))
    folds, drawn = Folds(body), shape(body, "real")
    free = body.compliance.free_surface
    ear = free[(mesh.nodes[free, 2] > EAR) & (mesh.nodes[free, 1] > 0.0)]
    drawn.wait_for(ear)
    failed = False
    print(f"{len(free)} free nodes; ear goes, deepest before, after (of the size), ms")
    for name, (way, forces) in ASKED.items():
        for force in forces:
            load = np.tile(force * np.array(way) / len(ear), (len(ear), 1))
            made = drawn.displacements(ear, load, YOUNG)
            took = []
            for _ in range(options.times):
                start = time.process_time()
                opened = folds.opened(made)
                took.append(1e3 * (time.process_time() - start))
            before, after = (folds.within(one).deepest / folds.size for one in (made, opened))
            gone = 1e3 * np.linalg.norm(made, axis=1).max()
            print(
                f"{name}: {gone:.0f} mm, {100 * before:.1f} %, {100 * after:.1f} %, "
                f"{np.median(took):.1f} ms"
            )
            failed = failed or after > MOST
    drawn.close()
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
