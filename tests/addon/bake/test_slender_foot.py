"""What stands on a slender foot is told from what stands broadly."""

import bpy
import pytest
from mathutils import Matrix
from soft_scene import cube, part, select

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


@pytest.fixture
def pole():
    """A pole that is high beside its foot, with settings for a quick bake."""
    thing = cube()
    thing.data.transform(Matrix.Diagonal((1.0, 1.0, 2.0, 1.0)))
    return select(thing)


def started(thing, **options):
    """Whether a bake that is started holds the object by its core; the bake is ended."""
    session = part("operators.bake.bake_session").start(thing, bpy.context.scene, **options)
    session.end()
    assert session.held_by_core == (thing.palpate.pin_mode == "CORE")
    return session.held_by_core


def test_who_makes_it_soft_by_hand_has_it_held_by_its_core(pole):
    assert started(pole, by_hand=True)


def test_scripts_and_whoever_chose_pins_have_what_they_ask_for(pole):
    assert not started(pole)
    pole.palpate.pin_fraction = 0.2
    assert not started(pole, by_hand=True)


@pytest.mark.parametrize("rebuild", [False, True])
def test_a_body_that_is_baked_again_keeps_its_pins(pole, rebuild):
    bpy.ops.palpate.make_soft()
    assert not started(pole, by_hand=True, rebuild=rebuild)
