"""A second press on what yields goes on from the imprint of the first, which is its surface now."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    TOP,
    begin,
    cube,
    empty,
    layer_names,
    moved,
    part,
    pose_by_bone,
    rest_places,
    seen_places,
    wait,
)

YIELD, DEPTH, RADIUS = 0.0005, 0.004, 0.012
# Some four nodes are pressed, and such a dent is drawn deeper than the tool (docs/materials.md): by
# 12 to 15 %.
DEEPER = 0.2
DOWN = (0.0, 0.0, -DEPTH)


@pytest.fixture(scope="module")
def clay_file(installed, tmp_path_factory):
    """File with a soft cube whose faces have vertices 2.5 mm apart, and which yields."""
    file = tmp_path_factory.mktemp("clay") / "clay.blend"
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    thing = cube()
    thing.palpate.edge_length = 0.08
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=19)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    thing.palpate.yield_depth = YIELD
    bpy.context.scene.palpate.tip, bpy.context.scene.palpate.tip_radius = "SPHERE", RADIUS
    bpy.ops.wm.save_mainfile()
    return file


@pytest.fixture
def clay(palpate, clay_file):
    """That cube."""
    bpy.ops.wm.open_mainfile(filepath=str(clay_file))
    return bpy.context.object


def tap(thing, at=TOP, by=DOWN):
    """A fingertip taps, and leaves its imprint; the force that it felt, N."""
    press = part("operators.press.press_once")
    return np.linalg.norm(press.press_once(thing, bpy.context.scene, at, by).force)


def opened(thing):
    """Its body as a press finds it."""
    return part("operators.object.drawn_body").open_body(thing, bpy.context.scene)


def deepest(thing, name):
    """What stays of a press in its middle, metres."""
    return -moved(thing, name)[:, 2].min()


def test_the_second_tap_is_felt_in_the_first_ones_imprint(clay):
    first = tap(clay)
    left = deepest(clay, "Press 1")
    assert 0.95 * (DEPTH - YIELD) < left < (1.0 + DEEPER) * (DEPTH - YIELD)
    second = tap(clay)
    # Two spheres that lie within each other are firmer than one on a plane (Hertz): the imprint is
    # a little wider than the fingertip that comes back to it.
    assert second > 1.1 * first
    # It goes on from there, nearly as far as before: the rim is met before the middle. How nearly
    # depends on the tetrahedra, which every bake has anew: 0.73 to 1.03 of it.
    further = deepest(clay, "Press 2")
    assert 0.6 * left < further < 1.15 * left
    seen = seen_places(clay) - rest_places(clay)
    assert -seen[:, 2].min() > left + 0.8 * further


def test_the_body_has_the_imprint_where_it_is_seen(clay):
    tap(clay)
    drawn = opened(clay)
    np.testing.assert_array_equal(drawn.at_rest.key, drawn.body.key)
    surface = drawn.body.mesh.surface_nodes
    moved_by = drawn.body.mesh.nodes - drawn.at_rest.mesh.nodes
    assert not np.delete(moved_by, surface, axis=0).any()
    # What is drawn is a grid of 2.5 mm on top; the imprint of a node there is between those around.
    nodes = drawn.at_rest.mesh.nodes[surface]
    on_top = np.abs(nodes[:, 2] - 0.025) < 1e-6
    expected = [between(clay, *node[:2]) for node in nodes[on_top]]
    assert np.linalg.norm(expected, axis=1).max() > 0.5 * deepest(clay, "Press 1")
    # Between vertices a dent of that radius is off a bilinear one by h^2 / 8 R along each axis.
    np.testing.assert_allclose(moved_by[surface][on_top], expected, atol=2e-4)


def between(thing, x, y):
    """The imprint at a place of the top, bilinear between the vertices around."""
    vertices, imprint = rest_places(thing), moved(thing, "Press 1")
    found = np.zeros(3)
    for vertex, left in zip(vertices, imprint, strict=True):
        if vertex[2] > 0.0249:
            shares = 1.0 - np.abs(vertex[:2] - (x, y)) / 0.0025
            found += max(shares[0], 0.0) * max(shares[1], 0.0) * left
    return found


def test_a_finger_touches_only_where_the_imprint_is(clay, sessions, states):
    tap(clay)
    left, chosen = deepest(clay, "Press 1"), bpy.context.scene.palpate
    guide = empty(at=(0.0, 0.0, 0.06))
    chosen.source, chosen.source_empty = "EMPTY", guide
    session = begin(sessions, states, clay, "EMPTY")
    for below, touches in ((0.5 * left, False), (left + 0.001, True)):
        guide.location.z = 0.025 - below + RADIUS
        bpy.context.view_layer.update()
        height = guide.location.z
        wait(session, lambda z=height: abs(session.snapshot.probe[2] - z) < 1e-6)
        wait(session, lambda t=session.snapshot.tick: session.snapshot.tick > t + 20)
        # Its rim is met a little before its middle: what stays is narrower than the fingertip.
        assert session.snapshot.touching == touches


@pytest.mark.parametrize("without", ["hidden", "removed", "no strength", "elastic"])
def test_without_its_imprint_the_surface_is_felt_as_at_first(clay, without):
    first = tap(clay)
    layer = clay.modifiers["Press 1"]
    layers = part("operators.layer.layers")
    match without:
        case "hidden":
            layer.show_viewport = False
        case "removed":
            layers.remove(clay, layer)
        case "no strength":
            layers.set_strength(clay, layer, 0.0)
        case "elastic":
            clay.palpate.yield_depth = 0.0
    bpy.context.view_layer.update()
    # Of an elastic object the dent is still seen, and the place on it only nearly the middle.
    assert tap(clay) == pytest.approx(first, rel=5e-2 if without == "elastic" else 1e-2)


def test_half_of_an_imprint_is_felt_as_half(clay):
    tap(clay)
    whole = opened(clay).imprint
    layers = part("operators.layer.layers")
    layers.set_strength(clay, clay.modifiers["Press 1"], 0.5)
    np.testing.assert_allclose(opened(clay).imprint, 0.5 * whole, atol=1e-9)


def test_the_second_tap_on_a_posed_limb_is_that_at_rest(clay):
    tap(clay)
    second = tap(clay)
    part("operators.layer.layers").remove(clay, clay.modifiers["Press 2"])
    pose_by_bone(clay, np.pi / 2.0)
    bpy.context.view_layer.update()
    # Turned about X, its top looks along -Y.
    posed = tap(clay, (0.0, -0.025, 0.0), (0.0, DEPTH, 0.0))
    assert posed == pytest.approx(second, rel=0.05)
    assert layer_names(clay) == ["Press 1", "Press 2"]


def test_an_animation_is_baked_on_the_imprint_once(clay, tmp_path):
    tap(clay)
    seen = seen_places(clay)
    scene, guide = bpy.context.scene, empty()
    for frame, height in ((1, 0.06), (2, 0.06), (3, 0.025 + RADIUS - DEPTH - 0.001)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 3
    scene.palpate.source, scene.palpate.source_empty = "EMPTY", guide
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "clay.blend"))
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    scene.frame_set(2)
    np.testing.assert_allclose(seen_places(clay), seen, rtol=0, atol=1e-7)
    scene.frame_set(3)
    # Beyond the imprint by a millimetre and more, of which the elastic part springs back later.
    deep = -(seen_places(clay) - rest_places(clay))[:, 2].min()
    assert 0.95 * (DEPTH + 0.001) < deep < (1.0 + DEEPER) * (DEPTH + 0.001)


def test_pressers_press_the_imprinted_surface(clay):
    tap(clay)
    left = deepest(clay, "Press 1")
    guide, group = empty(), bpy.data.collections.new("Pressers")
    group.objects.link(guide)
    guide.empty_display_size = RADIUS
    for below in (0.5 * left, left + 0.001):
        guide.location.z = 0.025 - below + RADIUS
        clay.palpate.pressers = group
        bpy.context.view_layer.update()
        bpy.context.scene.frame_set(bpy.context.scene.frame_current)
        pressed = np.abs(moved(clay, "Palpate Pressers")).max()
        assert (pressed > 1e-5) == (below > left)
