"""An object that nobody holds, and what it may lie on."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from soft_scene import part, select, soft_cube

# Of fingertips, metres; and a place on top of the cube.
RADIUS, TOP = 0.012, (0.004, 0.002, 0.025)


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
def tip(free_cube):
    """A fingertip of `RADIUS` metres."""
    chosen = bpy.context.scene.palpate
    chosen.tip, chosen.own_sizes, chosen.tip_radius = "SPHERE", True, RADIUS
    return chosen


@pytest.fixture
def force_alone(free_cube):
    """Force (3,), N, of the engine alone on a fingertip that is led 3 mm into the cube at `TOP`."""
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene).body
    rest, tools = part("core.rest.resting"), part("core.contact.tool.tools")
    pose, support = part("core.contact.tool.pose").Pose, part("core.rest.support")
    settings = rest.RestSettings(free_cube.palpate.young_modulus, 0.5)
    floor = support.Floor(-0.025, 0.5)
    alone = rest.Resting(body, [floor], settings=settings).settle()
    top = alone.surface()[:, 2].max()
    start = np.array([TOP[0], TOP[1], top + RADIUS + 2e-3])
    tool = [(tools.sphere(RADIUS), pose(start, np.eye(3)))]
    pressed = rest.Resting(body, [floor], tool, placement=alone.placement, settings=settings)
    pressed.settle()
    pressed.lead([pose(start - (0.0, 0.0, 0.005), np.eye(3))])
    return np.asarray(pressed.settle().tools[0].force)


@pytest.fixture
def stack(free_cube, colliders):
    """Makes a second cube over the first, which rests on all soft objects of the collection."""

    def make(gap=0.0005):
        free_cube.location.z = 0.0255
        other = free_cube.copy()
        bpy.context.collection.objects.link(other)
        other.location = (0.004, 0.0, 0.0755 + gap)
        for one in (free_cube, other):
            colliders.objects.link(one)
        bpy.context.view_layer.update()
        return other

    return make


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
