"""Pins that nobody has chosen: a slender foot is told from a broad one, a pin group is taken."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from soft_scene import body_of, cube, part, select

pytestmark = pytest.mark.usefixtures("palpate")


def slender(thing):
    drawn_surface = part("operators.scene.drawn_surface")
    pins = part("operators.pins.unchosen_pins")
    return pins.is_slender(drawn_surface.read(thing, bpy.context.scene), 0.1)


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
    """What a bake that is started tells of the object's pins; the bake is ended."""
    session = part("operators.bake.bake_session").start(thing, bpy.context.scene, **options)
    session.end()
    return session.pins_told


def test_what_stands_rests_there_for_who_makes_it_soft_by_hand(pole):
    assert "rests on its floor" in started(pole, by_hand=True)
    assert pole.palpate.pin_mode == "NONE"
    assert pole.palpate.steady


def hovers(thing):
    thing.location.z = 1.0


def is_too_soft(thing):
    thing.palpate.young_modulus, thing.palpate.density = 500.0, 2000.0


def has_a_parent(thing):
    thing.parent = bpy.data.objects.new("Parent", None)


def is_keyed(thing):
    thing.keyframe_insert("location")


def joined(thing, other):
    """Into one mesh; without an override of the context, see ``chosen_alone``."""
    for one in bpy.context.scene.objects:
        one.select_set(one in (thing, other))
    select(thing)
    bpy.ops.object.join()


def is_apart(thing):
    mesh = thing.data.copy()
    mesh.transform(Matrix.Translation((0.3, 0.0, 0.0)))
    other = bpy.data.objects.new("Other", mesh)
    bpy.context.collection.objects.link(other)
    joined(thing, other)


def is_in_a_bowl(thing):
    """Within the box around the other part, and not in it: a frame of four bars around it."""
    thing.data.transform(Matrix.Scale(0.2, 4))
    bpy.ops.mesh.primitive_torus_add(major_radius=0.05, minor_radius=0.01)
    ring = bpy.context.object
    joined(thing, ring)


def lies_on_nothing(thing):
    thing.palpate.floor = "NONE"


@pytest.mark.parametrize(
    "change",
    [hovers, is_too_soft, has_a_parent, is_keyed, is_apart, is_in_a_bowl, lies_on_nothing],
)
def test_what_cannot_rest_where_it_is_is_pinned(change):
    thing = cube()
    change(thing)
    bpy.context.view_layer.update()
    assert started(select(thing), by_hand=True) is None
    assert thing.palpate.pin_mode == "BELOW"
    assert not thing.palpate.steady


@pytest.mark.parametrize(("scale", "away"), [(1.0, 0.03), (0.3, 0.0)])
def test_parts_that_are_in_each_other_rest_as_one(scale, away):
    thing = cube()
    mesh = thing.data.copy()
    mesh.transform(Matrix.Translation((away, 0.0, 0.0)) @ Matrix.Scale(scale, 4))
    other = bpy.data.objects.new("Other", mesh)
    bpy.context.collection.objects.link(other)
    joined(thing, other)
    started(select(thing), by_hand=True)
    assert thing.palpate.pin_mode == "NONE"


def test_who_makes_it_soft_by_hand_has_a_slender_one_in_the_air_held_by_its_core(pole):
    pole.location.z = 1.0
    select(pole)
    assert "slender foot" in started(pole, by_hand=True)
    assert pole.palpate.pin_mode == "CORE"


def test_scripts_and_whoever_chose_pins_have_what_they_ask_for(pole):
    assert started(pole) is None
    pole.palpate.pin_fraction = 0.2
    assert started(pole, by_hand=True) is None
    assert pole.palpate.pin_mode == "BELOW"


@pytest.mark.parametrize("rebuild", [False, True])
def test_a_body_that_is_baked_again_keeps_its_pins(pole, rebuild):
    bpy.ops.palpate.make_soft()
    assert started(pole, by_hand=True, rebuild=rebuild) is None
    assert pole.palpate.pin_mode == "BELOW"


@pytest.mark.parametrize("by_hand", [False, True])
def test_a_pin_group_pins_unless_pins_were_chosen(pole, by_hand):
    group = pole.vertex_groups.new(name="Pinned")
    assert started(pole) is None, "it pins nothing yet"
    group.add([0], 1.0, "REPLACE")
    assert "its vertex group Pinned" in started(pole, by_hand=by_hand)
    assert pole.palpate.pin_mode == "GROUP"
    pole.palpate.pin_mode = "BELOW"
    assert started(pole, by_hand=by_hand) is None
    assert pole.palpate.pin_mode == "BELOW"


def test_a_group_that_is_made_below_a_height_pins(pole):
    bpy.ops.palpate.pin_below(fraction=0.5)
    bpy.ops.palpate.make_soft()
    assert pole.palpate.pin_mode == "GROUP"
    body = body_of(pole)
    held = body.mesh.nodes[body.fixed][:, 2]
    assert np.ptp(held) == pytest.approx(0.5 * np.ptp(body.mesh.nodes[:, 2]), rel=0.3)
