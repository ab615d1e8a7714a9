"""Public models on the machine, made soft: upright, of one size."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from palpate.core.bake.job import run_bake
from palpate.core.bake.settings import BakeSettings
from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.read_mesh import read_surface
from palpate.core.mesh.surface import Surface
from palpate.core.stiffness.formulation import SMOOTHED

DIAGONAL = 0.2


def standing_body(path: Path) -> SoftBody:
    """The body of smoothed elements that a bake makes of a file's surface, turned to stand on its
    second axis, with a diagonal of 200 mm. fTetWild, in a process of its own, says nothing.
    """
    surface = read_surface(path)
    vertices = surface.vertices[:, [2, 0, 1]]
    vertices *= DIAGONAL / np.linalg.norm(np.ptp(vertices, axis=0))
    with tempfile.TemporaryDirectory() as folder:
        upright = Surface.checked(vertices, surface.triangles)
        settings = BakeSettings(formulation=SMOOTHED, threads=1)
        body, _ = run_bake(upright, settings, Path(folder) / "body.npz")
        return body
