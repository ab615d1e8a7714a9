"""Imprints of soft objects: by strokes, presses and animations, as Blender evaluates them."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from soft_scene import (
    TOP,
    begin,
    cube,
    empty,
    error_of,
    layer_names,
    mesh_state,
    moved,
    part,
    press_down,
    press_in,
    rest_places,
    seen_places,
    wait,
)
from without_palpate import without_palpate

YIELD = 0.001
# Dents are drawn deeper than their tool (docs/materials.md): by up to 21 % in 27 bakes of the cube,
# whose tetrahedra differ, and by 2 % in the middle one.
DEEPER = 1.35


@pytest.fixture(scope="module")
def fine_file(installed, tmp_path_factory):
    """File with a soft cube whose faces have vertices 5 mm apart."""
    file = tmp_path_factory.mktemp("fine") / "fine.blend"
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    thing = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=9)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert len(thing.data.vertices) == 602
    # It is where it stays at once; what is seen of others comes there from picture to picture.
    thing.palpate.shape = "LINEAR"
    bpy.context.scene.palpate.tip = "POINT"
    bpy.ops.wm.save_mainfile()
    return file


@pytest.fixture
def fine(palpate, fine_file):
    """That cube, elastic."""
    bpy.ops.wm.open_mainfile(filepath=str(fine_file))
    return bpy.context.object


@pytest.fixture
def clay(fine):
    """That cube, which remembers what goes beyond a millimetre."""
    fine.palpate.yield_depth = YIELD
    return fine


@pytest.fixture
def before(clay):
    """All that a press may change about it."""
    return mesh_state(clay)


def beyond(elastic, depth=YIELD):
    """What is left of displacements (p, 3), metres."""
    sizes = np.linalg.norm(elastic, axis=1)
    return elastic * np.maximum(1.0 - depth / np.maximum(sizes, 1e-30), 0.0)[:, None]


def elastic_stroke(thing, **asked):
    """Displacements of a stroke on the elastic object, undone."""
    before, thing.palpate.yield_depth = thing.palpate.yield_depth, 0.0
    assert bpy.ops.palpate.stroke(place=TOP, radius=0.02, **asked) == {"FINISHED"}
    name = layer_names(thing)[-1]
    shift = moved(thing, name).astype(np.float64)
    part("operators.layer.layers").remove(thing, thing.modifiers[name])
    thing.palpate.yield_depth = before
    return shift


@pytest.mark.parametrize(
    "asked",
    [
        {"motion": "PUSH", "depth": 0.004},
        {"motion": "PUSH", "depth": -0.004},
        {"motion": "TWIST", "angle": 0.8},
    ],
)
def test_of_a_stroke_stays_what_is_beyond_the_yield_depth(clay, asked):
    elastic = elastic_stroke(clay, **asked)
    assert bpy.ops.palpate.stroke(place=TOP, radius=0.02, **asked) == {"FINISHED"}
    assert layer_names(clay) == ["Press 1"]
    np.testing.assert_allclose(moved(clay, "Press 1"), beyond(elastic), rtol=0, atol=1e-8)
    assert np.abs(moved(clay, "Press 1")).max() > 1e-4


def test_a_stroke_that_springs_back_leaves_nothing(clay, before):
    assert "springs back" in error_of(
        bpy.ops.palpate.stroke, place=TOP, radius=0.02, motion="PUSH", depth=0.0005
    )
    assert mesh_state(clay) == before


def test_the_same_stroke_goes_on_from_the_imprint(clay):
    asked = {"place": TOP, "radius": 0.02, "motion": "GRAB", "by": (0.0, 0.0, -0.004)}
    assert bpy.ops.palpate.stroke(**asked) == {"FINISHED"}
    assert bpy.ops.palpate.stroke(**asked) == {"FINISHED"}
    first, second = moved(clay, "Press 1"), moved(clay, "Press 2")
    np.testing.assert_allclose(seen_places(clay) - rest_places(clay), first + second, atol=1e-6)
    deepest = first[:, 2].argmin()
    assert (first + second)[deepest, 2] < 1.5 * first[deepest, 2]


def test_an_imprint_is_undone_in_one_step(clay):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.palpate.stroke("EXEC_DEFAULT", True, place=TOP, radius=0.02, depth=0.003)
    bpy.ops.palpate.stroke("EXEC_DEFAULT", True, place=TOP, radius=0.02, depth=0.003)
    bpy.ops.ed.undo()
    assert layer_names(bpy.context.object) == ["Press 1"]


def test_a_press_by_a_script_leaves_its_imprint(clay):
    clay.palpate.yield_depth = 0.0
    press_down(clay)
    clay.modifiers["Press 1"].show_viewport = False
    clay.palpate.yield_depth = YIELD
    press_down(clay)
    elastic = moved(clay, "Press 1").astype(np.float64)
    np.testing.assert_allclose(moved(clay, "Press 2"), beyond(elastic), rtol=0, atol=1e-8)


def test_while_it_is_held_all_is_seen_and_let_go_the_imprint(clay, sessions, states):
    session = begin(sessions, states, clay)
    press_in(session, states)
    wait(session, lambda: session.seen.displacements is not None)
    live = part("operators.layer.live_layer").find(clay)
    held = part("operators.layer.layers").displacement(clay, live).astype(np.float64)
    stays = session.seen.imprint.left(len(held)).reshape(-1, 3)
    np.testing.assert_allclose(stays, beyond(held), rtol=0, atol=1e-6)
    session.post(states.Keep(session.seen.stays(clay)))
    assert session.kept_name == "Press 1"
    np.testing.assert_array_equal(moved(clay, "Press 1"), stays)


def test_escape_removes_an_imprint(clay, before, sessions, states):
    session = begin(sessions, states, clay)
    press_in(session, states)
    wait(session, lambda: session.seen.imprint.is_left)
    session.post(states.Moment.CANCEL)
    assert mesh_state(clay) == before


def test_a_place_that_was_left_keeps_its_imprint_during_the_press(clay, sessions, states):
    session = begin(sessions, states, clay)
    press_in(session, states)
    wait(session, lambda: session.seen.imprint.is_left)
    session.post(states.Moment.RELEASE)
    first = session.seen.imprint.left(len(clay.data.vertices))
    # Beside the body: nothing is touched any more.
    session.post(states.SetDown((0.0, 0.0, 0.1)))
    wait(session, lambda: session.seen.displacements is None and not session.snapshot.touching)
    live = part("operators.layer.live_layer").find(clay)
    now = part("operators.layer.layers").displacement(clay, live)
    np.testing.assert_allclose(now.ravel(), first, rtol=0, atol=1e-8)
    assert session.seen.stays(clay)


def test_memory_foam_fades_as_the_animation_plays_also_without_palpate(clay, tmp_path):
    scene, clay.palpate.forget_time = bpy.context.scene, 2.0
    scene.frame_set(10)
    assert bpy.ops.palpate.stroke(place=TOP, radius=0.02, depth=0.004) == {"FINISHED"}
    full = moved(clay, "Press 1")
    half = round(2.0 * math.log(2.0) * scene.render.fps)
    for frame, share in ((1, 1.0), (10, 1.0), (10 + half, 0.5), (10 + 2 * half, 0.25)):
        scene.frame_set(frame)
        expected = rest_places(clay) + share * full
        np.testing.assert_allclose(seen_places(clay), expected, rtol=0, atol=5e-5 * YIELD * 1000)
    scene.frame_set(10 + half)
    seen = seen_places(clay)
    np.testing.assert_allclose(without_palpate(tmp_path)[clay.name], seen, rtol=0, atol=1e-6)
    part("operators.layer.layers").remove(clay, clay.modifiers["Press 1"])
    assert not clay.animation_data.drivers


@pytest.fixture
def tapped(clay, tmp_path):
    """A fingertip that goes into the cube's top and out of it within the frames 1 to 7."""
    guide, scene = empty(), bpy.context.scene
    for frame, height in ((1, 0.05), (4, 0.041), (7, 0.05)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 25
    chosen = scene.palpate
    chosen.tip_radius = 0.02
    chosen.tip, chosen.source, chosen.source_empty = "SPHERE", "EMPTY", guide
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "clay.blend"))
    return clay


def test_a_baked_animation_remembers(tapped):
    scene = bpy.context.scene
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    rest = rest_places(tapped)
    depths = {}
    for frame in (1, 4, 7, 25):
        scene.frame_set(frame)
        depths[frame] = (rest - seen_places(tapped)).astype(np.float64)
    assert not depths[1].any()
    # The way out adds a little at the rim.
    np.testing.assert_allclose(depths[7], beyond(depths[4]), rtol=0, atol=0.05 * YIELD)
    np.testing.assert_array_equal(depths[25], depths[7])
    assert depths[7].max() > 5e-4


def test_a_baked_animation_forgets(tapped):
    scene, tapped.palpate.forget_time = bpy.context.scene, 0.25
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    rest, deep = rest_places(tapped), {}
    for frame in (13, 13 + 6):
        scene.frame_set(frame)
        deep[frame] = np.abs(seen_places(tapped) - rest).max()
    assert deep[19] == pytest.approx(deep[13] * math.exp(-6 / scene.render.fps / 0.25), rel=1e-3)


def test_pressers_are_elastic_in_any_order_of_frames(tapped):
    scene, group = bpy.context.scene, bpy.data.collections.new("Pressers")
    group.objects.link(scene.palpate.source_empty)
    scene.palpate.source_empty.empty_display_size = 0.02
    tapped.palpate.pressers = group
    scene.frame_set(4)
    assert np.abs(seen_places(tapped) - rest_places(tapped)).max() > YIELD
    scene.frame_set(7)
    np.testing.assert_allclose(seen_places(tapped), rest_places(tapped), rtol=0, atol=1e-8)


def test_a_fingertip_leaves_its_depth_less_the_yield_depth(clay):
    depth, apex = 0.004, np.linalg.norm(rest_places(clay) - TOP, axis=1).argmin()
    assert bpy.ops.palpate.stroke(place=TOP, radius=0.02, depth=depth) == {"FINISHED"}
    # It has a sphere's place there, which a parabola rounds off beside the tool.
    left = -moved(clay, "Press 1")[apex, 2]
    assert 0.98 * depth < left + YIELD < DEEPER * depth


def test_an_elastic_object_keeps_all_of_a_press(fine):
    assert bpy.ops.palpate.stroke(place=TOP, radius=0.02, depth=0.004) == {"FINISHED"}
    deep = -moved(fine, "Press 1")[:, 2].min()
    assert 0.98 * 0.004 < deep < DEEPER * 0.004


def test_an_empty_that_taps_the_same_place_twice_leaves_one_imprint(clay, sessions, states):
    guide, chosen = empty(at=(0.0, 0.0, 0.03)), bpy.context.scene.palpate
    chosen.source, chosen.source_empty = "EMPTY", guide
    session = begin(sessions, states, clay, "EMPTY")
    left = []
    for _ in range(2):
        for height in (0.021, 0.03):
            guide.location.z = height
            bpy.context.view_layer.update()
            wait(session, lambda z=height: abs(session.snapshot.probe[2] - z) < 1e-9)
            wait(session, lambda z=height: session.snapshot.touching == (z < 0.025))
            # Drawn once more than it is reached.
            wait(session, lambda z=height: (session.seen.displacements is None) == (z > 0.025))
        left.append(session.seen.imprint.left(len(clay.data.vertices)))
    assert left[0].any()
    np.testing.assert_allclose(left[1], left[0], rtol=0, atol=2e-5)
