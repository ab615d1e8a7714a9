"""Strokes by scripts and by the redo panel: what they do to the mesh, and that each stays."""

from __future__ import annotations

import math
from dataclasses import replace

import bpy
import numpy as np
import pytest
from mathutils import Vector
from soft_scene import (
    TOP,
    cube,
    error_of,
    layer_names,
    mesh_state,
    moved,
    part,
    rest_places,
    seen_places,
)

STROKES = {
    "push": {"motion": "PUSH", "depth": 0.003},
    "pull": {"motion": "PUSH", "depth": -0.003},
    "grab": {"motion": "GRAB", "by": (0.002, 0.001, 0.002)},
    "twist": {"motion": "TWIST", "angle": 0.8},
    "pinch": {"motion": "PINCH", "share": 0.6},
    "spread": {"motion": "PINCH", "share": -0.6},
}


@pytest.mark.parametrize("name", list(STROKES))
def test_a_stroke_moves_the_surface_and_stays(thing, name):
    assert bpy.ops.palpate.stroke(place=(0.02, 0.02, 0.025), radius=0.02, **STROKES[name]) == {
        "FINISHED"
    }
    assert layer_names(thing) == ["Press 1"]
    shift = moved(thing, "Press 1")
    assert np.isfinite(shift).all()
    assert np.abs(shift).max() > 1e-4


def touched_at(thing, at):
    """Place of a soft object nearest to a place in the world."""
    frame = part("operators.scene.drawn_surface").frame_of(thing, bpy.context.scene)
    with part("operators.layer.place_marks").marked(thing):
        return part("operators.place.touched_place").nearest(thing, frame, at)


def test_a_push_goes_in_and_a_pull_out(thing):
    bpy.ops.palpate.stroke(place=TOP, radius=0.02, **STROKES["push"])
    bpy.ops.palpate.stroke(place=TOP, radius=0.02, **STROKES["pull"])
    assert layer_names(thing) == ["Press 1", "Press 2"]
    top = rest_places(thing)[:, 2] > 0.02
    assert moved(thing, "Press 1")[top, 2].mean() < 0.0 < moved(thing, "Press 2")[top, 2].mean()


def test_the_next_stroke_is_added_to_what_is_seen_and_begins_there(thing):
    bpy.ops.palpate.stroke(place=(0.025, 0.025, 0.025), radius=0.02, **STROKES["grab"])
    corner = seen_places(thing)[np.argmax(rest_places(thing).sum(axis=1))]
    assert np.linalg.norm(corner - 0.025) > 1e-3
    found = touched_at(thing, corner)
    assert np.allclose(found.seen, corner, atol=1e-6)
    assert np.allclose(found.rest, 0.025, atol=1e-6)
    bpy.ops.palpate.stroke(place=corner, radius=0.02, **STROKES["push"])
    both = moved(thing, "Press 1") + moved(thing, "Press 2")
    assert np.allclose(seen_places(thing) - rest_places(thing), both, atol=1e-6)


def test_a_stroke_is_undone_in_one_step_and_others_stay(thing):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.palpate.stroke("EXEC_DEFAULT", True, place=TOP, radius=0.02, **STROKES["push"])
    bpy.ops.palpate.stroke("EXEC_DEFAULT", True, place=TOP, radius=0.02, **STROKES["grab"])
    bpy.ops.ed.undo()
    assert layer_names(bpy.context.object) == ["Press 1"]


def test_a_mirrored_grab_moves_both_sides_alike(thing):
    asked = {"motion": "GRAB", "place": (0.02, 0.0, 0.025), "radius": 0.015, "by": (0, 0, 0.002)}
    bpy.ops.palpate.stroke(**asked)
    bpy.ops.palpate.stroke(**asked, mirrored=(True, False, False))
    rest = rest_places(thing)
    right, left = (rest[:, 2] > 0) & (rest[:, 0] > 0), (rest[:, 2] > 0) & (rest[:, 0] < 0)
    alone, both = (moved(thing, name)[:, 2] for name in ("Press 1", "Press 2"))
    assert alone[left].mean() < 0.5 * alone[right].mean()
    # The tetrahedra are not mirrored, coarse, and others in every bake: the same to some extent.
    assert both[left].mean() > 2.0 * alone[left].mean()
    assert both[left].mean() > 0.3 * both[right].mean()


def test_what_moves_nothing_is_refused_and_leaves_nothing(palpate, thing, before):
    assert "nothing" in error_of(bpy.ops.palpate.stroke, place=TOP, radius=0.02)
    assert mesh_state(thing) == before


def test_a_pinned_place_is_refused_and_leaves_nothing(palpate, thing, before):
    said = error_of(bpy.ops.palpate.stroke, place=(0, 0, -0.025), radius=0.005, **STROKES["pull"])
    assert "pinned" in said
    assert mesh_state(thing) == before


def test_what_was_never_baked_cannot_be_stroked(palpate):
    cube()
    assert "Make Soft" in error_of(bpy.ops.palpate.stroke, place=TOP, depth=0.001)


def test_the_place_is_found_on_the_mesh_as_it_is_posed_and_scaled_by_a_key(thing):
    thing.shape_key_add(name="Basis", from_mix=False)
    key = thing.shape_key_add(name="Tall", from_mix=False)
    for point in key.data:
        x, y, z = point.co
        # Turned about X by 90 degrees, and twice as tall.
        point.co = (x, -2.0 * z, y)
    key.value = 1.0
    bpy.context.view_layer.update()
    found = touched_at(thing, (0.01, -0.06, 0.004))
    assert np.allclose(found.seen, (0.01, -0.05, 0.004), atol=1e-6)
    assert np.allclose(found.rest, (0.01, 0.004, 0.025), atol=1e-6)
    # Keys move what layers add; they do not turn it.
    assert np.allclose(found.turn, np.eye(3), atol=1e-6)
    assert np.allclose(found.normal, [0, -1, 0], atol=1e-6)


def test_a_ray_meets_the_soft_object_in_front_and_nothing_behind_another(thing):
    places, scene = part("operators.place.seen_place"), bpy.context.scene
    ray = (Vector((0.01, 0.005, 1.0)), Vector((0.0, 0.0, -1.0)))
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    found = places.under_ray(scene, bpy.context.evaluated_depsgraph_get(), *ray)
    assert found.thing == thing
    assert np.allclose(found.seen, (0.01, 0.005, 0.025), atol=1e-6)
    assert np.allclose(found.normal, (0.0, 0.0, 1.0), atol=1e-6)
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0, 0, 0.5))
    assert places.under_ray(scene, bpy.context.evaluated_depsgraph_get(), *ray) is None


def test_angle_and_share_are_what_was_asked(thing):
    bpy.ops.palpate.stroke(place=TOP, radius=0.03, motion="TWIST", angle=math.radians(20))
    rest, shift = rest_places(thing), moved(thing, "Press 1")
    top = rest[:, 2] > 0
    around = np.cross(np.tile([0, 0, 1.0], (top.sum(), 1)), rest[top])
    assert ((shift[top] * around).sum(axis=1) > 0).all()


def test_nothing_is_asked_at_first_and_nothing_moves(thing):
    scene, room = bpy.context.scene, "operators.stroke.answer"
    strokes, motions = part(f"{room}.stroke"), part(f"{room}.motion")
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    asked, motion = motions.Asked, motions.Motion
    grips = part(f"{room}.grips").grips_at(drawn, np.array(TOP), 0.01, (True, True, False))
    stroke = strokes.Stroke(drawn, grips, 1000.0, 0.5)
    for kind, amount in ((motion.PUSH, 0.0), (motion.PUSH, -0.0), (motion.TWIST, 0.0)):
        _, stroked = stroke.stroked(asked(kind, amount))
        assert not stroked.displacements.any()
    assert stroke.stroked(asked(motion.PUSH, 0.002))[1].displacements.any()


def test_a_push_ends_where_the_body_does(thing):
    """The cube is 5 cm high, and held by its foot: 4 cm are the most."""
    for depth in (0.04, 0.2):
        bpy.ops.palpate.stroke(place=TOP, radius=0.03, motion="PUSH", depth=depth)
        thing.modifiers[-1].show_viewport = False
    whole, farther = moved(thing, "Press 1"), moved(thing, "Press 2")
    assert -whole[:, 2].min() > 0.01
    assert np.allclose(farther, whole, atol=0.02 * np.abs(whole).max())
    bottom = rest_places(thing)[:, 2].min()
    assert (rest_places(thing) + farther)[:, 2].min() > bottom - 0.001


def test_a_fingertip_is_not_swallowed(thing):
    """It goes in by three quarters of its width, as when it presses: the cube does not lean."""
    bpy.ops.palpate.stroke(place=TOP, radius=0.006, motion="PUSH", depth=0.03)
    shift, top = moved(thing, "Press 1"), rest_places(thing)[:, 2] > 0.024
    assert -shift[:, 2].min() < 1.01 * 0.009
    assert np.abs(shift[top, :2].mean(axis=0)).max() < 0.001


@pytest.fixture
def bar(palpate):
    """A soft bar that stands on its foot."""
    bar = cube(0.02)
    for vertex in bar.data.vertices:
        vertex.co.z *= 6.0
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    return bar


def test_a_limb_that_gives_way_as_a_whole_is_pushed_farther_than_its_fingertip(bar):
    """What is held by its foot bends: only what is pressed in beside that counts."""
    bpy.ops.palpate.stroke(place=(0.01, 0.0, 0.055), radius=0.006, motion="PUSH", depth=0.03)
    assert np.linalg.norm(moved(bar, "Press 1"), axis=1).max() > 0.02


def test_a_push_stays_as_far_as_it_went_where_it_goes_no_farther(bar, monkeypatch):
    """As on a bone in flesh: the first step goes in, the next one finds no rest."""
    stroke, depths = part("operators.stroke.answer.stroke").Stroke, []
    done = stroke._done

    def goes_once(self, asked, *, inward):
        depths.append(asked.amount)
        if asked.amount > depths[0]:
            raise part("core.errors").PalpateError("no deeper")
        return done(self, asked, inward=inward)

    monkeypatch.setattr(stroke, "_done", goes_once)
    bpy.ops.palpate.stroke(place=(0.01, 0.0, 0.045), radius=0.006, motion="PUSH", depth=0.03)
    assert depths[-1] > depths[0]
    assert np.linalg.norm(moved(bar, "Press 1"), axis=1).max() > 0.5 * depths[0]


def begun_at(thing, place, radius):
    """A stroke that has begun, and a push to ask of it."""
    scene, room = bpy.context.scene, "operators.stroke.answer"
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    grips = part(f"{room}.grips").grips_at(drawn, np.array(place), radius, (False,) * 3)
    motions = part(f"{room}.motion")
    stroke = part(f"{room}.free_stroke").stroke_of(thing, drawn, grips)
    return stroke, lambda depth: motions.Asked(motions.Motion.PUSH, depth)


@pytest.mark.parametrize(
    ("radius", "depth", "why"),
    [(0.006, 0.003, ""), (0.006, 0.03, "DEEPEST"), (0.03, 0.2, "ENDS")],
)
def test_a_push_that_ends_says_what_ends_it(thing, radius, depth, why):
    """The fingertip, or the body's far side; nothing where it goes as deep as was asked."""
    stroke, push = begun_at(thing, TOP, radius)
    asked, stroked = stroke.stroked(push(depth))
    assert stroked.ends == (getattr(part("operators.stroke.answer.deepest"), why) if why else "")
    assert (asked.amount < depth) == bool(why)


def test_a_push_ends_above_a_pinned_core(palpate):
    """Which is under half of what lies above the cube's middle."""
    thing = cube(0.05)
    thing.palpate.pin_mode = "CORE"
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    stroke, push = begun_at(thing, TOP, 0.012)
    asked, stroked = stroke.stroked(push(0.015))
    assert stroked.ends == part("operators.stroke.answer.deepest").PINNED
    assert 0.0 < asked.amount < 0.8 * 0.025
    shallow, whole = stroke.stroked(push(0.003))
    assert (shallow.amount, whole.ends) == (0.003, "")


@pytest.mark.parametrize("aside", [0.0, 0.004, 0.009, 0.014])
def test_a_push_ends_above_a_pinned_node_beside_its_way(thing, aside):
    """A ball that is led in by small steps meets it at the same depth."""
    drawn = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    grips = part("operators.stroke.answer.grips")
    grip = grips.grips_at(drawn, np.array(TOP), 0.012, (False,) * 3)[0]
    mesh = drawn.body.mesh
    inner = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.surface_nodes)[0]
    nodes, place = mesh.nodes.copy(), grip.centre(mesh)
    across = np.cross(grip.normal, (1.0, 0.0, 0.0))
    nodes[inner] = place - 0.02 * grip.normal + aside * across / np.linalg.norm(across)
    body = replace(drawn.body, mesh=replace(mesh, nodes=nodes), fixed=np.array([inner]))
    under = part("operators.stroke.answer.thickness").Thickness.under
    found = under(replace(drawn, body=body), grip)
    depths = np.linspace(0.0, 0.05, 50_001)
    middles = place + np.outer(grip.radius - depths, grip.normal)
    meets = np.linalg.norm(middles - nodes[inner], axis=1) < grip.radius
    assert found.pinned == meets.any() == (aside < grip.radius)
    if found.pinned:
        assert found.metres == pytest.approx(depths[meets.argmax()], abs=2e-6)


@pytest.mark.parametrize(
    ("error", "why"), [("UnsettledError", "NO_REST"), ("NotANumberError", "NO_NUMBER")]
)
@pytest.mark.parametrize("first", [True, False], ids=["at once", "farther in"])
def test_a_push_without_an_answer_says_why(bar, monkeypatch, error, why, first):
    """It is refused at once with the reason, or stays as far as it went, with the same one."""
    press, presses = part("core.contact.press").Press, []
    to = press.to

    def has_no_answer(self, goals):
        presses.append(goals)
        # The first one sets the fingertip down.
        if len(presses) > (1 if first else 2):
            raise getattr(part("core.contact.unsettled"), error)("press: 1e-3 of the largest")
        return to(self, goals)

    monkeypatch.setattr(press, "to", has_no_answer)
    why = getattr(part("operators.stroke.answer.deepest"), why)
    stroke, push = begun_at(bar, (0.01, 0.0, 0.045), 0.006)
    if first:
        with pytest.raises(part("core.errors").PalpateError) as refused:
            stroke.stroked(push(0.03))
        assert str(refused.value) == why
    else:
        asked, stroked = stroke.stroked(push(0.03))
        assert stroked.ends == why
        assert 0.0 < asked.amount < 0.03


@pytest.fixture
def real(thing):
    thing.palpate.shape = "ROTATION_STRAIN"
    return thing


@pytest.mark.parametrize("name", list(STROKES))
def test_by_the_materials_law_every_stroke_ends_where_its_hand_is(real, name):
    scene, room = bpy.context.scene, "operators.stroke.answer"
    drawn = part("operators.object.drawn_body").open_body(real, scene)
    motions, asked = part(f"{room}.motion"), dict(STROKES[name])
    motion = motions.Motion[asked.pop("motion")]
    amount, by = next(iter(asked.values())), None
    if motion is motions.Motion.GRAB:
        amount, by = 0.0, np.array(amount)
    wanted = motions.Asked(motion, 2.0 * amount if name == "push" else amount, by)
    grips = part(f"{room}.grips").grips_at(drawn, np.array(TOP), 0.012, (False,) * 3)
    ends = {}
    for shape in ("LINEAR", "ROTATION_STRAIN"):
        real.palpate.shape = shape
        stroke = part(f"{room}.free_stroke").stroke_of(real, drawn, grips)
        ends[shape] = stroke.stroked(wanted)[1]
        stroke.close()
    linear, law = ends["LINEAR"], ends["ROTATION_STRAIN"]
    most = np.abs(linear.displacements).max()
    assert np.abs(law.displacements - linear.displacements).max() > 1e-3 * most
    assert law.share != 1.0
    np.testing.assert_allclose(law.force, law.share * linear.force, rtol=1e-9)
    np.testing.assert_allclose(law.torque, law.share * linear.torque, rtol=1e-9, atol=1e-12)
    if name != "push":  # Of a fingertip's places each may slide.
        held = drawn.body.free_index(np.concatenate([one.nodes for one in linear.loads]))
        off = (law.displacements - linear.displacements)[held]
        assert np.abs(off).max() < 0.02 * most


def test_a_push_is_felt_as_a_press_is(real):
    scene, room = bpy.context.scene, "operators.stroke.answer"
    drawn = part("operators.object.drawn_body").open_body(real, scene)
    grips = part(f"{room}.grips").grips_at(drawn, np.array(TOP), 0.012, (False,) * 3)
    stroke = part(f"{room}.free_stroke").stroke_of(real, drawn, grips)
    motions = part(f"{room}.motion")
    _, pushed = stroke.stroked(motions.Asked(motions.Motion.PUSH, 0.006))
    stroke.close()
    (tip,) = pushed.touches
    shape = part("core.shape.shapes").shape(drawn.at_rest, "real")
    shape.wait_for(tip.nodes)
    modulus = real.palpate.young_modulus
    settings = part("core.contact.press").ContactSettings(modulus, real.palpate.static_friction)
    press = part("core.contact.single_press").press_tool
    linear = press(drawn.body, tip.tool, tip.pose, settings)
    (touch,) = part("core.shape.felt").felt(shape, [linear], modulus).touches
    assert pushed.force == pytest.approx(np.linalg.norm(touch.force), rel=1e-6)
    assert abs(pushed.force / np.linalg.norm(linear.force) - 1.0) > 1e-3
