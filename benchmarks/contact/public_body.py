"""Which elements are felt and drawn as a finer body of a file's mesh: smoothed or linear ones?

    python benchmarks/contact/public_body.py FILE.(obj|ply|stl)

The file's surface, turned to stand on its second axis and 200 mm in diagonal, is made soft
once with each formulation, and with every tetrahedron cut in eight. A ball of
8 mm is pressed in by 2.4 mm at places drawn at random. Printed are forces over those of the finer
body, and how far the drawn surface nodes of both are apart (root of squares, of those of the finer
body). Claimed, by exit code: smoothed elements are the nearer ones in the median of both.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.refined import refined
from palpate.benchmarks.measuring.standing import standing_body
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.formulation import LINEAR, SMOOTHED
from palpate.core.stiffness.pins import PinNodes

RADIUS, DEPTH = 0.008, 0.0024
PRESSES = 12
# Places are above this share of the height.
LOWEST = 0.25


def places(mesh: TetMesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Middles of triangles drawn by their area, and the outward normals there."""
    i, j, k = (mesh.nodes[mesh.surface_triangles[:, corner]] for corner in range(3))
    normals, middles = np.cross(j - i, k - i), (i + j + k) / 3
    areas = np.linalg.norm(normals, axis=1)
    low, high = mesh.nodes[:, 2].min(), mesh.nodes[:, 2].max()
    share = areas * (middles[:, 2] > low + LOWEST * (high - low))
    chosen = np.random.default_rng(3).choice(
        len(share), PRESSES, replace=False, p=share / share.sum()
    )
    return middles[chosen], normals[chosen] / areas[chosen, None]


def pressed(
    body: SoftBody, place: NDArray[np.float64], normal: NDArray[np.float64]
) -> tuple[float, NDArray[np.float64]]:
    """Force, newton, and displacements of all nodes (those inside are nil), metres."""
    touch = press_tool(body, sphere(RADIUS), Pose.at(place + (RADIUS - DEPTH) * normal))
    moved = np.zeros(body.mesh.nodes.shape)
    moved[body.compliance.free_surface] = body.deform(touch.nodes, touch.nodal_forces)
    return float(np.linalg.norm(touch.force)), moved


def main() -> int:
    """Print both formulations' forces and shapes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    whole = standing_body(parser.parse_args().file)
    pins = PinNodes(whole.fixed)
    linear, _ = bake(whole.mesh, BakeSettings(formulation=LINEAR, pins=pins, threads=1))
    fine_mesh, fine_pins = refined(whole.mesh, whole.fixed)
    fine_settings = BakeSettings(formulation=SMOOTHED, pins=PinNodes(fine_pins), threads=1)
    fine, _ = bake(fine_mesh, fine_settings)
    print(f"{len(whole.mesh.nodes):,} nodes, cut in eight {len(fine_mesh.nodes):,}")
    found: dict[str, list[tuple[float, float]]] = {LINEAR: [], SMOOTHED: []}
    for place, normal in zip(*places(whole.mesh), strict=True):
        true_force, true = pressed(fine, place, normal)
        true = true[: len(whole.mesh.nodes)]
        for body in (linear, whole):
            force, moved = pressed(body, place, normal)
            off = np.linalg.norm(moved - true) / np.linalg.norm(true)
            found[body.formulation].append((force / true_force, float(off)))
    worst = {}
    for name, rows in found.items():
        forces, shapes = np.array(rows).T
        low, middle, high = np.quantile(forces, (0.1, 0.5, 0.9))
        worst[name] = abs(middle - 1.0), float(np.median(shapes))
        print(
            f"{name:<10} force {middle:.3f} (tenths {low:.3f}, {high:.3f})   "
            f"drawn {100 * worst[name][1]:.1f} % off"
        )
    pairs = zip(worst[SMOOTHED], worst[LINEAR], strict=True)
    return int(any(ours > theirs for ours, theirs in pairs))


if __name__ == "__main__":
    sys.exit(main())
