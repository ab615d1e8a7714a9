"""What a frame is made of besides the deformation, and touches to draw."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.drawn_map import DrawnMap
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.single_press import touch_at

PROJECT = Path(__file__).resolve().parents[3]
DRAWN_VERTICES = 100_000


@dataclass(frozen=True)
class Load:
    """A touch as the deformation wants it: three nodes and the forces on them."""

    triangle: NDArray[np.int64]
    nodal_forces: NDArray[np.float64]


def in_turn(loads: list[Load], work: Callable[[Load], object]) -> Callable[[], object]:
    """Work on one load after the other, from the first again after the last."""
    place = 0

    def next_one() -> object:
        nonlocal place
        place = (place + 1) % len(loads)
        return work(loads[place])

    return next_one


def random_loads(body: SoftBody, count: int) -> list[Load]:
    """Touches of random free triangles by 3 mm, as forces on their nodes."""
    rng = np.random.default_rng(1999)
    free = np.isin(body.mesh.surface_triangles, body.compliance.free_surface).all(axis=1)
    touches = [
        touch_at(body, int(triangle), rng.dirichlet([1, 1, 1]), rng.normal(scale=0.003, size=3))
        for triangle in rng.choice(np.flatnonzero(free), count)
    ]
    return [Load(touch.triangle, touch.nodal_forces) for touch in touches]


def hung_vertices(body: SoftBody) -> DrawnMap:
    """A hundred thousand vertices drawn on the body's surface."""
    rng = np.random.default_rng(1999)
    triangles = body.mesh.surface_triangles
    chosen = triangles[rng.integers(0, len(triangles), DRAWN_VERTICES)]
    weights = rng.dirichlet([1, 1, 1], DRAWN_VERTICES)
    return DrawnMap.hang(np.einsum("pc,pcx->px", weights, body.mesh.nodes[chosen]), body)


def drawn_coordinates(
    rest: NDArray[np.float32], displacements: NDArray[np.float32]
) -> NDArray[np.float32]:
    """What Blender is handed: flat coordinates (3 p,)."""
    return rest + displacements.ravel()


def blender_write_seconds() -> float | None:
    """Median time of writing as many coordinates into a shape key; None without bpy."""
    pythons = sorted(PROJECT.glob(".venv-bpy-*/bin/python"))
    if not pythons:
        return None
    script = Path(__file__).with_name("shape_key_write.py")
    ended = subprocess.run(
        [str(pythons[0]), str(script), str(DRAWN_VERTICES), "200"],
        check=True,
        capture_output=True,
        text=True,
    )
    return float(json.loads(ended.stdout.splitlines()[-1])["seconds"])
