"""The finger of a new scene: a fingertip in proportion to what it presses."""

from __future__ import annotations

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import cube, part, select, soft_cube

SCENES = Path(__file__).resolve().parents[3] / "sample_scenes"


@pytest.fixture
def chosen(palpate):
    """Settings as a new scene has them."""
    settings = bpy.context.scene.palpate
    for name in [known.identifier for known in settings.bl_rna.properties]:
        settings.property_unset(name)
    return settings


def radius_on(thing):
    """Radius of the fingertip that presses it, and the size of its mesh, metres."""
    scene = bpy.context.scene
    size = part("operators.scene.drawn_surface").size_of(thing, scene)
    return part("operators.tool.finger_tip").chosen_tip(scene, thing, size).tool.radius, size


@pytest.mark.parametrize("edge", [0.05, 1.7, 30.0])
@pytest.mark.parametrize("unit", [1.0, 0.001, 0.0254])
def test_it_is_a_twentieth_of_the_body_in_all_units_and_scales(chosen, edge, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    thing = cube(edge)
    thing.scale = (0.5, 0.5, 0.5)
    bpy.context.view_layer.update()
    assert chosen.tip == "SPHERE"
    radius, size = radius_on(thing)
    assert size == pytest.approx(0.5 * edge * unit * np.sqrt(3.0), rel=1e-5)
    assert radius == pytest.approx(0.05 * size)


def test_a_new_scene_presses_an_object_of_any_size_without_a_setting(chosen):
    """The same dent and the same force, but for the size."""
    forces = []
    for edge in (0.05, 2.0):
        thing = select(soft_cube(edge))
        top, deep = (0.0, 0.0, 0.5 * edge), (0.0, 0.0, -0.05 * edge)
        press = part("operators.press.press_once").press_once(
            thing, bpy.context.scene, top, deep, keep=False
        )
        forces.append(np.linalg.norm(press.force) / edge**2)
    assert forces[1] == pytest.approx(forces[0], rel=0.3)


def test_a_length_that_is_set_is_kept_for_every_object(chosen):
    chosen.tip_radius = 0.011
    assert chosen.own_sizes
    for edge in (0.05, 1.7):
        assert radius_on(cube(edge))[0] == pytest.approx(0.011)


def test_exact_size_begins_with_the_size_that_was_shown(chosen):
    thing = cube(1.7)
    share = radius_on(thing)[0]
    chosen.own_sizes = True
    assert radius_on(thing)[0] == pytest.approx(share, rel=1e-5)
    assert chosen.plate_width == pytest.approx(2.5 * share, rel=1e-5)


def test_a_file_from_before_keeps_the_lengths_that_it_sets(chosen, tmp_path):
    for name, length in (("set", 0.013), ("unset", None)):
        chosen = bpy.data.scenes[0].palpate
        chosen.property_unset("tip_radius")
        if length is not None:
            chosen.tip_radius = length
        chosen.property_unset("own_sizes")
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / f"{name}.blend"), copy=True)
    for name, own in (("set", True), ("unset", False)):
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / f"{name}.blend"))
        assert bpy.context.scene.palpate.own_sizes == own, name
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "set.blend"))
    assert bpy.context.scene.palpate.tip_radius == pytest.approx(0.013)


def test_a_simulated_hand_lets_go_of_all_of_the_surface_between_its_presses(
    chosen, tmp_path, monkeypatch
):
    """Also between the ears of the mouse, or it could never touch anew."""
    copy = tmp_path / "mouse.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    thing, scene = select(bpy.data.objects["Mouse"]), bpy.context.scene
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    tip = part("operators.tool.finger_tip").chosen_tip(scene, thing, drawn.size)
    source = part("operators.device.device_source")
    monkeypatch.setattr(source, "SimulatedDevice", lambda options, **_: options)
    frame = source.DeviceFrame(np.eye(3), np.zeros(3), 1.0)
    hand = source.start_simulated(drawn, frame, tip=tip)
    clear = np.linalg.norm(drawn.surface_nodes - np.array(hand.at), axis=1).min()
    assert clear > tip.tool.radius
    deepest = np.linalg.norm(drawn.surface_nodes - np.array(hand.at) - hand.by, axis=1).min()
    assert deepest < 0.8 * tip.tool.radius
