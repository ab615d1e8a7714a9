"""Forces as attributes of the evaluated mesh: what shaders and geometry nodes see."""

from __future__ import annotations

import csv

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
    opens_usd,
    part,
    rest_places,
    seen_places,
    wait,
)

SHOWN = ("palpate_displacement", "palpate_normal", "palpate_pressure", "palpate_traction")
PUSH = {"place": TOP, "radius": 0.02, "depth": 0.004}


@pytest.fixture(scope="module")
def fine_file(installed, tmp_path_factory):
    """File with a soft cube whose faces have vertices 2.5 mm apart."""
    file = tmp_path_factory.mktemp("fine") / "fine.blend"
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    cube()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=19)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    bpy.ops.wm.save_mainfile()
    return file


@pytest.fixture
def fine(palpate, fine_file):
    """That cube, which tells of forces."""
    bpy.ops.wm.open_mainfile(filepath=str(fine_file))
    thing = bpy.context.object
    thing.palpate.force_attributes = True
    return thing


def shown(thing, name):
    """An attribute of the evaluated mesh, (p, 3) or (p,); None without."""
    bpy.context.view_layer.update()
    found = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.attributes.get(name)
    if found is None:
        return None
    is_vector = found.data_type == "FLOAT_VECTOR"
    values = np.empty((3 if is_vector else 1) * len(found.data), dtype=np.float32)
    found.data.foreach_get("vector" if is_vector else "value", values)
    return values.reshape(-1, 3) if is_vector else values


def shares(thing):
    """Area of each vertex of the evaluated mesh, square metres."""
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    areas = np.zeros(len(mesh.vertices))
    for face in mesh.polygons:
        for vertex in face.vertices:
            areas[vertex] += face.area / len(face.vertices)
    return areas


def attributes(thing):
    return sorted(one.name for one in thing.data.attributes)


def test_a_stroke_s_pressure_sums_up_to_its_force(fine):
    # So shallow, rubber presses back as the linear body does that is pressed beside it.
    fine.palpate.law = "rubber"
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    pressure, traction = shown(fine, "palpate_pressure"), shown(fine, "palpate_traction")
    normal = shown(fine, "palpate_normal")
    drawn = part("operators.object.drawn_body").open_body(fine, bpy.context.scene)
    pressed = part("core.contact.press")
    sphere = part("core.contact.tool.tools").sphere(0.02)
    pose = part("core.contact.tool.pose").Pose
    press = pressed.Press(drawn.body, [sphere], pressed.ContactSettings(fine.palpate.young_modulus))
    press.to([pose(np.array([0.0, 0.0, 0.046]), np.eye(3))])
    touch = press.to([pose(np.array([0.0, 0.0, 0.041]), np.eye(3))])[0]
    total = (traction * shares(fine)[:, None]).sum(axis=0)
    # As exact as vertices 2.5 mm apart sample a patch of about 12.
    np.testing.assert_allclose(total, touch.force, atol=0.06 * touch.force[2])
    # Its peak is that of the contact points, some twenty, up to their unevenness.
    assert 0.6 * touch.largest_pressure < pressure.max() < 1.5 * touch.largest_pressure
    np.testing.assert_allclose(np.linalg.norm(traction, axis=1), pressure, rtol=1e-5, atol=1e-3)
    touched = pressure > 0.0
    assert 10 < touched.sum() < 200
    np.testing.assert_allclose(np.linalg.norm(normal[touched], axis=1), 1.0, atol=1e-5)
    assert (normal[touched, 2] > 0.7).all()
    assert not normal[~touched].any()
    assert (rest_places(fine)[touched, 2] > 0.0249).all()
    np.testing.assert_array_equal(shown(fine, "palpate_displacement"), moved(fine, "Press 1"))


def test_layers_add_up_as_strong_as_they_are(fine):
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    once = {name: shown(fine, name) for name in SHOWN}
    layers = part("operators.layer.layers")
    layers.set_strength(fine, fine.modifiers["Press 1"], 0.5)
    for name in ("palpate_displacement", "palpate_pressure", "palpate_traction"):
        np.testing.assert_allclose(shown(fine, name), 0.5 * once[name], rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(shown(fine, "palpate_normal"), once["palpate_normal"], atol=1e-5)
    second = fine.modifiers["Press 1"]
    layers.set_strength(fine, second, 1.0)
    assert bpy.ops.palpate.stroke(place=(0.025, 0, 0), radius=0.02, depth=0.003) == {"FINISHED"}
    both = shown(fine, "palpate_traction")
    fine.modifiers["Press 1"].show_viewport = False
    other = shown(fine, "palpate_traction")
    np.testing.assert_allclose(both, once["palpate_traction"] + other, rtol=1e-5, atol=1e-2)
    assert other.any()


def test_its_attributes_go_with_a_layer(fine):
    before = attributes(fine)
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    assert attributes(fine) == sorted([*before, "Press 1", "Press 1 Traction"])
    layers = part("operators.layer.layers")
    layers.rename(fine, fine.modifiers["Press 1"], "Cheek")
    assert attributes(fine) == sorted([*before, "Cheek", "Cheek Traction"])
    assert shown(fine, "palpate_pressure").any()
    layers.remove(fine, fine.modifiers["Cheek"])
    assert attributes(fine) == before


def test_nobody_who_does_not_ask_has_them(fine):
    fine.palpate.force_attributes = False
    before = attributes(fine)
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    assert attributes(fine) == sorted([*before, "Press 1"])
    assert all(shown(fine, name) is None for name in SHOWN)


def test_it_can_be_switched_at_any_time(fine):
    layers = part("operators.layer.layers")
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    layers.set_strength(fine, fine.modifiers["Press 1"], 0.25)
    pressure = shown(fine, "palpate_pressure")
    fine.palpate.force_attributes = False
    assert all(shown(fine, name) is None for name in SHOWN)
    assert layers.strength(fine.modifiers["Press 1"]) == pytest.approx(0.25)
    fine.palpate.force_attributes = True
    np.testing.assert_array_equal(shown(fine, "palpate_pressure"), pressure)
    assert layer_names(fine) == ["Press 1"]


def test_a_running_press_shows_what_it_presses_and_escape_removes_all(fine, sessions, states):
    chosen = bpy.context.scene.palpate
    chosen.tip, chosen.own_sizes, chosen.tip_radius = "SPHERE", True, 0.02
    before = attributes(fine)
    session = begin(sessions, states, fine)
    session.post(states.SetDown((0.0, 0.0, 0.046)))
    session.post(states.Move((0.0, 0.0, 0.041)))
    wait(session, lambda: session.snapshot.touching and session.snapshot.probe[2] < 0.0411)
    wait(session, lambda: np.any(session.snapshot.pressures))
    session.tick()
    traction = shown(fine, "palpate_traction")
    force = np.asarray(session.snapshot.contact_force)
    total = (traction * shares(fine)[:, None]).sum(axis=0)
    np.testing.assert_allclose(total, force, atol=0.08 * np.linalg.norm(force))
    session.post(states.Moment.CANCEL)
    assert attributes(fine) == before


def test_pressers_show_what_they_press(fine):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.02, location=(0, 0, 0.041))
    ball, hand = bpy.context.object, bpy.data.collections.new("Hand")
    hand.objects.link(ball)
    fine.palpate.pressers = hand
    assert shown(fine, "palpate_pressure").max() > 0.0
    ball.location.z = 0.1
    bpy.context.view_layer.update()
    assert not shown(fine, "palpate_pressure").any()


def test_an_imprint_bears_nothing_once_it_is_let_go(fine):
    fine.palpate.yield_depth = 0.001
    assert bpy.ops.palpate.stroke(**PUSH) == {"FINISHED"}
    assert shown(fine, "palpate_displacement").any()
    assert not shown(fine, "palpate_pressure").any()


@opens_usd
def test_a_baked_usd_file_plays_them_frame_by_frame(fine, tmp_path):
    guide, scene, table = empty(), bpy.context.scene, tmp_path / "forces.csv"
    for frame, height in ((1, 0.06), (3, 0.042), (5, 0.06)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 5
    scene.palpate.tip_radius, scene.palpate.tip = 0.02, "SPHERE"
    scene.palpate.source, scene.palpate.source_empty = "EMPTY", guide
    handlers = list(bpy.app.handlers.frame_change_pre)
    assert bpy.ops.palpate.press_frames(keep="USD", forces=str(table)) == {"FINISHED"}
    assert list(bpy.app.handlers.frame_change_pre) == handlers
    rows = csv.DictReader(table.read_text(encoding="utf-8").splitlines())
    forces = {int(row["frame"]): row for row in rows}
    rest = rest_places(fine)
    for frame in (3, 1, 2, 4):
        scene.frame_set(frame)
        traction, pressure = shown(fine, "palpate_traction"), shown(fine, "palpate_pressure")
        felt = float(forces[frame]["force_N"])
        total = np.linalg.norm((traction * shares(fine)[:, None]).sum(axis=0))
        assert total == pytest.approx(felt, rel=0.1, abs=1e-6)
        found = shown(fine, "palpate_normal") * pressure[:, None]
        np.testing.assert_allclose(found, traction, rtol=0, atol=1e-3 * max(pressure.max(), 1.0))
        places = rest + shown(fine, "palpate_displacement")
        np.testing.assert_allclose(seen_places(fine), places, rtol=0, atol=1e-6)
    assert float(forces[3]["force_N"]) > 0.01


def test_what_a_file_has_under_an_attribute_s_name_makes_room_for_it(fine):
    write_of = part("operators.traction.layer_traction").write_of
    layers = part("operators.layer.layers")
    assert bpy.ops.palpate.stroke(motion="PUSH", **PUSH) == {"FINISHED"}
    (layer,) = layers.layers_of(fine)
    mesh = layers.mesh_of(fine, layer)
    name = layers.attribute_name(layer) + part("operators.layer.layer_groups").TRACTION
    mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, "INT", "POINT")
    write_of(fine, layer, np.full(3 * len(mesh.vertices), 2.0, dtype=np.float32))
    attribute = mesh.attributes[name]
    assert (attribute.data_type, attribute.domain) == ("FLOAT_VECTOR", "POINT")
    assert tuple(attribute.data[0].vector) == (2.0, 2.0, 2.0)
