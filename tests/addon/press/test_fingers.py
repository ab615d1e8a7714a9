"""Fingers with a shape, and two of them, pressed by scripts: no window, no clock."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    empty,
    error_of,
    layer_names,
    mesh_object,
    mesh_state,
    moved,
    part,
    rest_places,
    select,
    soft_cube,
)

TOP, DOWN = (0.0, 0.0, 0.025), (0.0, 0.0, -0.004)
LEFT, RIGHT = (-0.025, 0.0, 0.01), (0.025, 0.0, 0.01)


@pytest.fixture
def chosen(palpate):
    """The scene's settings, with tools so large that few contact points suffice."""
    settings = bpy.context.scene.palpate
    settings.tip_radius, settings.rod_length = 0.02, 0.02
    settings.plate_width = settings.plate_depth = 0.04
    return settings


def pressed(thing, ats, bys, *, keep=False):
    return part("operators.press.press_once").press_several(
        thing, bpy.context.scene, ats, bys, keep=keep
    )


def forces(thing, ats, bys):
    return [np.array(finger.force) for finger in pressed(thing, ats, bys).fingers]


def ball(radius=0.02, at=(0.0, 0.0, 0.1), name="Ball"):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=at, segments=24, ring_count=16)
    bpy.context.object.name = name
    bpy.context.view_layer.update()
    return bpy.context.object


@pytest.mark.parametrize("tip", ["SPHERE", "PLATE", "ROD"])
def test_a_tool_presses_out_and_touches_an_area(chosen, tip, thing):
    chosen.tip = tip
    finger = pressed(thing, [TOP], [DOWN]).fingers[0]
    assert finger.force[2] > 3 * abs(finger.force[0])
    assert 0.0 < finger.made.area < 0.05**2
    assert finger.made.largest_pressure >= 0.9 * finger.force[2] / finger.made.area


def test_a_kept_shape_lies_outside_the_tool(chosen, thing):
    """The corner on top is under the fingertip, however far the elements alone would take it."""
    chosen.tip, chosen.tip_radius = "SPHERE", 0.01
    corner = np.array([0.025, 0.025, 0.025])
    press = pressed(thing, [corner - [0.002, 0.002, 0.0]], [(0.0, 0.0, -0.006)], keep=True)
    touch = press.fingers[0].made
    drawn = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    tools = part("operators.press.press_once").pressing_tools([touch])

    def inside(displacement):
        places = drawn.frame.body_from_local(rest_places(thing) + displacement.reshape(-1, 3))
        return -touch.tool.distance(touch.pose.to_tool(places))[0].min()

    nodes = drawn.body.deform(touch.nodes, touch.nodal_forces, thing.palpate.young_modulus)
    assert inside(drawn.drawn_displacement(0.0 * nodes)) > 4e-3
    kept = moved(thing, press.layer)
    assert inside(kept) < 1e-6
    alone = drawn.drawn_displacement(nodes, tools)
    np.testing.assert_allclose(kept.ravel(), alone, atol=1e-6)
    # On what was drawn before, as from frame to frame.
    for frame in (2.0 * nodes, nodes):
        again = drawn.drawn_displacement(frame, tools, drawn.canvas)
    assert np.shares_memory(again, drawn.canvas)
    np.testing.assert_array_equal(again, alone)


def test_friction_of_the_material_holds_a_fingertip_back(chosen, thing):
    chosen.tip = "SPHERE"
    aslant = (0.004, 0.0, -0.004)
    slippery = pressed(thing, [TOP], [aslant]).force
    thing.palpate.static_friction = 0.8
    rough = pressed(thing, [TOP], [aslant]).force
    assert rough[0] < slippery[0] - 0.1 * slippery[2]


def test_a_larger_fingertip_feels_more(chosen, thing):
    chosen.tip = "SPHERE"
    felt = []
    for radius in (0.015, 0.03):
        chosen.tip_radius = radius
        felt.append(pressed(thing, [TOP], [DOWN]).force[2])
    assert felt[1] > 1.1 * felt[0]


def test_a_tool_much_larger_than_the_body_presses_as_deep_as_it_is_told(chosen, thing):
    chosen.tip = "SPHERE"

    def felt(radius):
        chosen.tip_radius = radius
        return forces(thing, [TOP], [DOWN])[0][2]

    assert felt(1000.0) == pytest.approx(felt(10.0), rel=0.01)
    assert felt(1000.0) > 0.02


def test_a_plate_takes_the_surface_under_it_along(chosen, thing):
    chosen.tip, chosen.plate_width, chosen.plate_depth = "PLATE", 0.03, 0.03
    press = pressed(thing, [TOP], [DOWN])
    assert press.largest_displacement == pytest.approx(0.004, rel=0.1)
    assert press.fingers[0].made.area == pytest.approx(0.03**2, rel=0.3)


def test_sizes_of_tools_are_scene_units(chosen, thing):
    """A scene in millimetres whose object is as large gives the same newtons."""
    chosen.tip = "SPHERE"
    metres = pressed(thing, [TOP], [DOWN])
    bpy.context.scene.unit_settings.scale_length = 0.001
    thing.scale = (1000.0,) * 3
    bpy.context.view_layer.update()
    chosen.tip_radius = 20.0
    millimetres = pressed(thing, [np.multiply(1000, TOP)], [np.multiply(1000, DOWN)])
    assert np.allclose(metres.force, millimetres.force, rtol=0.01, atol=1e-4)
    assert np.isclose(metres.fingers[0].depth, millimetres.fingers[0].depth)


def test_a_mesh_presses_like_the_tool_it_is_shaped_as(chosen):
    thing, tool = soft_cube(), ball(0.02)
    select(thing)
    before = mesh_state(tool)
    chosen.tip = "SPHERE"
    sphere = pressed(thing, [TOP], [DOWN])
    chosen.tip, chosen.tip_object = "MESH", tool
    mesh = pressed(thing, [TOP], [DOWN])
    assert np.isclose(mesh.force[2], sphere.force[2], rtol=0.2)
    assert "simplified" in mesh.remarks[0]
    assert mesh_state(tool) == before


def test_the_scale_of_a_tool_object_counts(chosen):
    thing, tool = soft_cube(), ball(0.015)
    select(thing)
    chosen.tip, chosen.tip_object = "MESH", tool
    small = pressed(thing, [TOP], [DOWN]).force[2]
    tool.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    assert pressed(thing, [TOP], [DOWN]).force[2] > 1.02 * small


def test_a_hollow_mesh_presses_with_its_hull_and_says_so(chosen, thing):
    corner = [(x, y, z) for x in (0, 0.03) for y in (0, 0.03) for z in (0, 0.03)]
    dent = (0.015, 0.015, 0.015)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]
    top = [(1, 5, 8), (5, 7, 8), (7, 3, 8), (3, 1, 8)]
    tool = mesh_object([*corner, dent], [*faces, *top], name="Cup")
    select(thing)
    chosen.tip, chosen.tip_object = "MESH", tool
    assert "not convex" in pressed(thing, [TOP], [DOWN]).remarks[0]
    hull = part("operators.tool.hull").hull_of(tool, bpy.context.scene)
    assert sorted(map(tuple, np.round(hull.corners, 6).tolist())) == sorted(
        map(tuple, np.round(corner, 6).tolist())
    )


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [([], []), ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])],
    ids=["empty", "flat"],
)
def test_a_tool_without_volume_is_refused(chosen, vertices, faces, thing):
    chosen.tip, chosen.tip_object = "MESH", mesh_object(vertices, faces, name="Nothing")
    select(thing)
    message = error_of(bpy.ops.palpate.press, at=TOP, by=DOWN)
    assert "Nothing has no volume" in message
    assert layer_names(thing) == []


def test_a_tool_that_is_not_there_or_is_the_body_is_refused(chosen):
    thing, tool = soft_cube(), ball()
    select(thing)
    chosen.tip = "MESH"
    assert "pick one under Finger" in error_of(bpy.ops.palpate.press, at=TOP, by=DOWN)
    chosen.tip_object = tool
    bpy.data.objects.remove(tool)
    assert "pick one under Finger" in error_of(bpy.ops.palpate.press, at=TOP, by=DOWN)
    chosen.tip_object = thing
    assert "cannot press itself" in error_of(bpy.ops.palpate.press, at=TOP, by=DOWN)


def test_a_pinch_squeezes_from_both_sides(chosen, thing):
    by = 0.003
    assert bpy.ops.palpate.pinch(at_1=LEFT, by_1=(by, 0, 0), at_2=RIGHT, by_2=(-by, 0, 0)) == {
        "FINISHED"
    }
    assert layer_names(thing) == ["Press 1"]
    left, right = forces(thing, [LEFT, RIGHT], [(by, 0, 0), (-by, 0, 0)])
    assert left[0] < 0 < right[0]
    alone = forces(thing, [LEFT], [(by, 0, 0)])[0]
    # The other finger holds the body against this one, which therefore feels more.
    assert not np.allclose(left, alone, rtol=1e-3)


def test_two_fingertips_feel_each_other(chosen, thing):
    chosen.tip = "SPHERE"
    ways = [(0.003, 0, 0), (-0.003, 0, 0)]
    left, right = forces(thing, [LEFT, RIGHT], ways)
    alone = forces(thing, [LEFT], ways[:1])[0]
    assert left[0] < 0 < right[0]
    assert not np.allclose(left, alone, rtol=1e-3)


def test_a_pinch_that_does_not_move_is_refused(chosen):
    soft_cube()
    message = error_of(bpy.ops.palpate.pinch, at_1=LEFT, by_1=(0.003, 0, 0), at_2=RIGHT)
    assert "'by_2' is zero" in message


def test_the_paper_mode_differs_within_a_triangle(chosen, thing):
    place = (0.003, 0.001, 0.025)
    chosen.contact_mode = "PAPER"
    paper = pressed(thing, [place], [DOWN]).force[2]
    chosen.contact_mode = "CONSISTENT"
    assert not np.isclose(pressed(thing, [place], [DOWN]).force[2], paper, rtol=0.01)


def test_who_leads_is_refused_in_words_where_nobody_does(chosen):
    leads = part("operators.session.finger_leads")
    source = part("operators.session.press_state").Source
    scene, guide = bpy.context.scene, empty()
    refused = part("core.errors").PalpateError
    with pytest.raises(refused, match="no Empty is chosen; pick one below Press With"):
        leads.leads_of(scene, source.EMPTY)
    chosen.source_empty, chosen.second = guide, "EMPTY"
    with pytest.raises(refused, match="below Second Finger"):
        leads.leads_of(scene, source.EMPTY)
    chosen.second_empty = guide
    with pytest.raises(refused, match="both fingers are led by Empty"):
        leads.leads_of(scene, source.EMPTY)
    chosen.second, chosen.source = "SERIAL", "SERIAL"
    with pytest.raises(refused, match="has no port"):
        leads.leads_of(scene, source.DEVICE)
    chosen.port = chosen.second_port = "/dev/ttyACM0"
    with pytest.raises(refused, match="both fingers use"):
        leads.leads_of(scene, source.DEVICE)
