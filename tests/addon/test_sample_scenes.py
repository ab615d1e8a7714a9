"""Sample scenes open ready to press and feel the same everywhere; the drumstick's bone is felt."""

from __future__ import annotations

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import body_of, key_names, part, rest_places, seen_places, select, status
from without_palpate import without_palpate

SCENES = Path(__file__).resolve().parents[2] / "sample_scenes"
MATERIALS = {
    "cube": "PAPER_CUBE",
    "mouse": "PLUSH",
    "drumstick": "JELLY",
    "large": "PLUSH",
    "dents": "PAPER_CUBE",
}
OBJECTS = {"large": "Hare"}
# Places on top, metres: where the meat tapers over the bone, and where it is thick.
OVER_BONE, OVER_MEAT = (0.048, 0.0, 0.0335), (-0.02, 0.0, 0.068)

# The presses of the demo, where and how far (m): the forces (N) of their tetrahedra on Linux. By
# Real the mouse's differs by 1e-8 there too: its steps end when little changes.
TOP = ((0.0, 0.0, 0.05), (0.0, 0.0, -0.005))
SIDE = ((0.0, -0.025, 0.025), (0.0, 0.005, 0.0))
BACK = ((-0.024, -0.025, 0.047), (0.0, 0.0, -0.006))
MOUSE_FORCE = (-0.004723981588743798, -0.012102297178496216, 0.04855857266497471)
FORCES = [
    ("cube", "LINEAR", TOP, (0.0, 0.0, 0.8909827491051393)),
    ("cube", "LINEAR", SIDE, (0.0, -0.7552396705656844, 0.2767286808193487)),
    ("cube", "ROTATION_STRAIN", TOP, (0.0, 0.0, 0.943328549241)),
    ("cube", "ROTATION_STRAIN", SIDE, (0.0, -0.786332207214529, 0.288121351233123)),
    ("mouse", "LINEAR", BACK, MOUSE_FORCE),
]


def opened(name, folder):
    copy = folder / f"{name}.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    return select(bpy.data.objects[OBJECTS.get(name, name.title())])


def force(thing, at):
    # A needle's tip tells a narrow bone from the meat beside it.
    bpy.context.scene.palpate.tip = "POINT"
    pressed = part("operators.press.press_once").press_once(
        thing, bpy.context.scene, at, (0.0, 0.0, -0.004), keep=False
    )
    return np.linalg.norm(pressed.force)


@pytest.mark.parametrize("name", MATERIALS)
def test_a_sample_scene_only_lacks_its_body_file(palpate, tmp_path, name):
    thing = opened(name, tmp_path)
    found = status(thing)
    assert found.fit.name == "FILE_MISSING"
    assert found.changed == ()
    assert found.pins.fit.name == "SAME"
    assert thing.palpate.material == MATERIALS[name]


@pytest.mark.parametrize(
    ("name", "objects", "frame"),
    [
        ("pinch", ("Nodes", "Triangles"), 1),
        ("dents", ("Dents", "Poke"), 20),
        ("dents", ("Dents", "Poke"), 37),
        ("imprint", ("Clay", "Foam"), 1),
        ("animated", ("Animated",), 30),
        ("lifted", ("Ball",), 36),
        ("stacked", ("Lime",), 1),
        ("table", ("Plush Mouse",), 20),
        ("bowl", ("Teddy",), 1),
        ("materials", ("Rubber", "Foam", "Memory Foam"), 20),
    ],
)
def test_a_scene_plays_without_palpate(palpate, tmp_path, name, objects, frame):
    shutil.copyfile(SCENES / f"{name}.blend", tmp_path / "copy.blend")
    shutil.copytree(SCENES / "palpate", tmp_path / "palpate")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "copy.blend"))
    things = [bpy.data.objects[one] for one in objects]
    layers = part("operators.layer.layers")
    if name == "pinch":
        for thing in things:
            layers.set_strength(thing, layers.layers_of(thing)[0], 1.0)
    bpy.context.scene.frame_set(frame)
    here = {thing.name: seen_places(thing) for thing in things}
    rest = {thing.name: rest_places(thing) for thing in things}
    alone = without_palpate(tmp_path)
    for one in objects:
        assert np.abs(here[one] - rest[one]).max() > 3e-4
        assert np.abs(here[one] - alone[one]).max() <= 1e-6


def test_clay_keeps_what_foam_forgets(palpate, tmp_path):
    shutil.copyfile(SCENES / "imprint.blend", tmp_path / "copy.blend")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "copy.blend"))
    left = {}
    for frame in (1, 13, 60):
        bpy.context.scene.frame_set(frame)
        for name in ("Clay", "Foam"):
            thing = bpy.data.objects[name]
            left[name, frame] = np.abs(seen_places(thing) - rest_places(thing)).max()
    assert left["Clay", 60] == left["Clay", 1] > 4e-3
    # A time constant of half a second, at 24 frames a second.
    assert left["Foam", 13] == pytest.approx(np.exp(-1.0) * left["Foam", 1], rel=1e-3)
    assert left["Foam", 60] < 0.01 * left["Foam", 1]


@pytest.mark.at_length
def test_the_bone_in_the_drumstick_is_felt_and_only_where_it_is(palpate, tmp_path):
    thing = opened("drumstick", tmp_path)
    boned = {place: force(thing, place) for place in (OVER_BONE, OVER_MEAT)}
    thing.palpate.stiff_group = ""
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    boneless = {place: force(thing, place) for place in (OVER_BONE, OVER_MEAT)}
    assert boned[OVER_BONE] > 1.4 * boned[OVER_MEAT]
    assert boneless[OVER_BONE] < boneless[OVER_MEAT]
    assert boned[OVER_BONE] > 2 * boneless[OVER_BONE]
    assert boned[OVER_MEAT] < 1.3 * boneless[OVER_MEAT]


@pytest.fixture
def pinch_file(palpate, tmp_path):
    copy = tmp_path / "pinch.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    return bpy.context.scene


@pytest.mark.parametrize("name", ["Nodes", "Triangles"])
def test_the_pinched_cubes_open_ready_and_undented(pinch_file, name):
    thing = select(bpy.data.objects[name])
    found = status(thing)
    assert found.fit.name == "FILE_MISSING"
    layers = part("operators.layer.layers")
    assert thing.data.shape_keys is None
    assert [(one.name, layers.strength(one)) for one in layers.layers_of(thing)] == [
        ("Pinched", 0.0)
    ]


def test_the_cube_of_figure_5_is_pinched_as_the_paper_s_equation_10_says(pinch_file):
    thing = select(bpy.data.objects["Nodes"])
    left, right = (bpy.data.objects[f"Nodes {side}"] for side in ("Left", "Right"))
    assert pinch_file.palpate.source_empty == left
    assert pinch_file.palpate.second_empty == right
    middle = np.array(thing.location) + np.array([0.0, 0.0, 0.025])
    ways = np.array([[0.008, 0.0, 0.0], [-0.008, 0.0, 0.0]])
    pressed = part("operators.press.press_once").press_several(
        thing, pinch_file, list(middle - 0.025 * np.sign(ways)), list(ways), keep=False
    )
    body = body_of(thing)
    nodes = [
        int(np.argmin(np.linalg.norm(body.mesh.nodes - p, axis=1)))
        for p in ((-0.025, 0.0, 0.025), (0.025, 0.0, 0.025))
    ]
    local = np.searchsorted(body.mesh.surface_nodes, nodes)
    blocks = body.surface_blocks(local, local) / thing.palpate.young_modulus
    by_paper = part("core.contact.equations").two_node_forces(blocks, *ways)
    for finger, force in zip(pressed.fingers, by_paper, strict=True):
        assert np.allclose(finger.force, -force, rtol=1e-5, atol=1e-7)
    # The one on triangles is not symmetric, and not on nodes.
    other = np.concatenate([bpy.data.objects[f"Triangles {s}"].location for s in ("Left", "Right")])
    assert not np.isclose(other[1], -other[4])


def test_the_fingertip_s_animation_presses_the_mouse(palpate, tmp_path):
    copy = tmp_path / "fingertip.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    thing, scene = select(bpy.data.objects["Mouse"]), bpy.context.scene
    assert scene.palpate.tip == "SPHERE"
    # Fewer contact points than the finger of the scene has, for time.
    scene.palpate.tip_radius = 0.016
    assert bpy.ops.palpate.press_frames(frame_start=1, frame_end=21, step=5, keep="KEYS") == {
        "FINISHED"
    }
    names = key_names(thing)[1:]
    assert names == ["Press at 16", "Press at 21"]


@pytest.mark.parametrize(("name", "shape", "press", "stored"), FORCES)
def test_a_scene_feels_the_same_in_every_blender(palpate, tmp_path, name, shape, press, stored):
    thing = opened(name, tmp_path)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    thing.palpate.shape = shape
    bpy.context.scene.palpate.tip = "POINT"
    pressed = part("operators.press.press_once").press_once(
        thing, bpy.context.scene, *press, keep=False
    )
    assert np.abs(np.subtract(pressed.force, stored)).max() <= 1e-9 * np.abs(stored).max()
