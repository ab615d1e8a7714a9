"""What stands on a slender foot is told from what stands broadly."""

import bpy
import pytest
from mathutils import Matrix
from soft_scene import part, select

pytestmark = pytest.mark.usefixtures("palpate")


def slender(thing):
    drawn_surface, foot = part("operators.scene.drawn_surface"), part("operators.pins.slender_foot")
    return foot.is_slender(drawn_surface.read(thing, bpy.context.scene), 0.1)


@pytest.mark.parametrize(
    ("size", "expected"),
    [((1, 1, 1), False), ((1, 1, 1.1), False), ((1, 1, 1.4), True), ((3, 0.4, 1), True)],
)
def test_the_lesser_width_counts_beside_the_height(size, expected):
    bpy.ops.mesh.primitive_cube_add(size=0.1)
    thing = bpy.context.object
    # Turned about the vertical, so that no width lies along an axis.
    thing.data.transform(Matrix.Rotation(0.5, 4, "Z") @ Matrix.Diagonal((*size, 1.0)))
    assert slender(select(thing)) is expected


def test_up_is_the_world_s_as_the_object_stands():
    bpy.ops.mesh.primitive_cube_add(size=0.1)
    thing = bpy.context.object
    thing.data.transform(Matrix.Diagonal((3.0, 1.0, 1.0, 1.0)))
    assert not slender(select(thing))
    thing.rotation_euler.y = 1.5708
    assert slender(select(thing))


def test_a_dome_stands_broadly_and_a_ball_and_a_cone_on_its_tip_do_not():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.05)
    ball = bpy.context.object
    assert slender(select(ball))
    ball.data.transform(Matrix.Diagonal((1.0, 1.0, 0.5, 1.0)))
    assert not slender(select(ball))
    bpy.ops.mesh.primitive_cone_add(radius1=0.0, radius2=0.05, depth=0.1)
    assert slender(select(bpy.context.object))
