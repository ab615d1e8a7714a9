"""An object that nobody holds, and what it may lie on."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from soft_scene import select, soft_cube


@pytest.fixture
def free_cube(palpate):
    """A soft cube of 50 mm without pins at the origin, the active object, light and soft."""
    made = soft_cube(pins="NONE")
    made.palpate.static_friction = 0.5
    return made


@pytest.fixture
def colliders(free_cube):
    """The collection of what bears the cube."""
    made = bpy.data.collections.new("Bearing")
    free_cube.palpate.colliders = made
    return made


@pytest.fixture
def board(free_cube, colliders):
    """Makes boards that bear the cube: 0.4 m wide, the top in the middle of their own axes."""

    def make(at=(0.0, 0.0, 0.0), turn=None):
        corners = np.array(
            [(x, y, z) for x in (-0.2, 0.2) for y in (-0.2, 0.2) for z in (-0.1, 0.0)]
        )
        mesh = bpy.data.meshes.new("Board")
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        mesh.from_pydata(corners.tolist(), [], faces)
        made = bpy.data.objects.new("Board", mesh)
        made.matrix_world = Matrix.Translation(at) @ (turn or Matrix())
        bpy.context.collection.objects.link(made)
        colliders.objects.link(made)
        select(free_cube)
        return made

    return make
