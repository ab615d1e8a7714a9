"""The same press by headless Blender, by the command line and by the running servo: one force.

By the material's own law, as by default.
"""

from __future__ import annotations

import argparse
import json
import shutil
import time
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import part, select

SCENES = Path(__file__).resolve().parents[3] / "sample_scenes"
OBJECTS = {"cube": "Cube", "mouse": "Mouse", "large": "Hare"}
# Beside the body's middle by so much of its box: what is nearest is pressed, so deep, metres.
ABOVE, BESIDE = (0.02, -0.03, 0.3), (-0.2, 0.05, 0.3)
LEFT, RIGHT = (0.0, -0.5, -0.05), (0.0, 0.5, -0.05)
ASIDE = 0.0015
SAME = 1e-6
STEPS = 8
# Tip, where, how deep (m), friction. A plate's edges that are in by more than they are rounded may
# come to rest in more than one way; which, the way there decides.
PRESSES = {
    "point": ("POINT", [ABOVE], 0.002, 0.0),
    "two points": ("POINT", [ABOVE, BESIDE], 0.002, 0.0),
    "sphere": ("SPHERE", [ABOVE], 0.002, 0.0),
    "plate": ("PLATE", [ABOVE], 0.0005, 0.0),
    "two spheres pinching": ("SPHERE", [LEFT, RIGHT], 0.002, 0.0),
    "sphere with friction": ("SPHERE", [ABOVE], 0.002, 0.4),
}


@pytest.fixture(
    params=[
        "cube",
        pytest.param("mouse", marks=pytest.mark.at_length),
        pytest.param("large", marks=pytest.mark.at_length),
    ]
)
def thing(request, palpate, tmp_path):
    copy = tmp_path / f"{request.param}.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    thing = bpy.data.objects[OBJECTS[request.param]]
    # Blender lays a plate along the world's x axis, the command line along the body's.
    thing.rotation_euler = (0.0, 0.0, 0.0)
    return select(thing)


# What one point and a sphere with friction show, two and one without show again.
AGAIN = ("two points", "sphere")


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.at_length] if name in AGAIN else [])
        for name in PRESSES
    ],
)
def test_one_press_three_ways(thing, name, tmp_path, capsys):
    tip, where, depth, friction = PRESSES[name]
    scene = bpy.context.scene
    chosen = scene.palpate
    chosen.tip, chosen.tip_turn = tip, "SURFACE"
    chosen.tip_radius, chosen.plate_width, chosen.plate_depth = 0.008, 0.016, 0.012
    thing.palpate.static_friction = friction
    thing.palpate.shape = "ROTATION_STRAIN"
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    body = drawn.body
    places = [place_beside(body, one) for one in where]
    bys = [depth * place.axis + friction * ASIDE * across(place.axis) for place in places]
    blender = headless(thing, scene, drawn, places, bys)
    assert np.abs([touch.force for touch in blender]).max() > 1e-5
    words = tool_words(scene) + (["--friction", repr(friction_of(thing))] if friction else [])
    file = tmp_path / "body.npz"
    part("core.body.body_file").save(body, file)
    line = command_line(file, thing, places, bys, words, capsys)
    assert_same([touch.force for touch in blender], line)
    if not friction:  # With friction the way counts, and the running servo's is its own.
        assert_same(*by_servo(drawn, thing, blender, places, bys))


def place_beside(body, share):
    size = np.ptp(body.mesh.nodes, axis=0)
    middle = body.mesh.nodes.mean(axis=0)
    return part("core.contact.place").nearest_place(body, middle + np.array(share) * size)


def across(axis):
    return np.linalg.svd(axis[None])[2][1]


def friction_of(thing):
    return float(thing.palpate.static_friction)


def headless(thing, scene, drawn, places, bys):
    frame = drawn.frame
    pressed = part("operators.press.press_once").press_several(
        thing,
        scene,
        [frame.world_from_body(place.position) for place in places],
        [frame.turn_to_world(by) / frame.metres_per_unit for by in bys],
        keep=False,
    )
    return [finger.made for finger in pressed.fingers]


def tool_words(scene):
    chosen = scene.palpate
    metres = part("operators.scene.drawn_surface").metres_per_unit(scene)
    match chosen.tip:
        case "SPHERE":
            return ["--tool", f"sphere:{metres * chosen.tip_radius!r}"]
        case "PLATE":
            sizes = (metres * chosen.plate_width, metres * chosen.plate_depth)
            return ["--tool", "plate:{!r}:{!r}".format(*sizes)]
    return []


def command_line(file, thing, places, bys, words, capsys):
    pairs = [
        word
        for place, by in zip(places, bys, strict=True)
        for word in ("--at", *as_words(place.position), "--by", *as_words(by))
    ]
    capsys.readouterr()
    young = repr(thing.palpate.young_modulus)
    command, parser = part("cli.press.press"), argparse.ArgumentParser()
    command.add_options(parser)
    parser.set_defaults(json=True)
    assert command.run(parser.parse_args([str(file), *pairs, *words, "--young", young])) == 0
    figures = json.loads(capsys.readouterr().out)
    return [contact["force"] for contact in figures.get("contacts", [figures])]


def as_words(vector):
    return [f"{part:.17f}" for part in vector]


def by_servo(drawn, thing, blender, places, bys):
    """Forces of the running servo at rest, and of the press at the places that it found."""
    session, body = part("core.servo.session"), drawn.body
    tools = [getattr(touch, "tool", None) for touch in blender]
    ends = [
        place.position + by if tool is None else touch.pose.position
        for place, by, tool, touch in zip(places, bys, tools, blender, strict=True)
    ]
    starts = [end - 2.0 * by for end, by in zip(ends, bys, strict=True)]
    turns = [np.eye(3) if tools[0] is None else touch.pose.rotation for touch in blender]
    settings = part("core.servo.settings").Settings(thing.palpate.young_modulus, orientations=turns)
    native = session.native_body(body, whole=True)
    young = thing.palpate.young_modulus
    real = part("core.shape.shapes").shape(body, "real")
    real.wait_for(np.zeros(0, dtype=np.int64))
    with session.servo_on(native, settings) as servo:
        for start in starts[1:]:
            servo.add(session.Pointer(start))
        servo.start(session.Pointer(starts[0]))
        for finger, tool in enumerate(tools):
            if tool is not None:
                servo.set_tool(session.native_tool(body, native, tool), finger=finger)
        for step in np.linspace(0.0, 1.0, STEPS + 1):
            here = [start + step * (end - start) for start, end in zip(starts, ends, strict=True)]
            for finger, place in enumerate(here):
                servo.set_target(place, finger=finger)
            rested(servo, here)
        firming = part("core.servo.firming").Firming(servo, body, tools[0])
        shots = firm(servo, firming, real, young)
    if tools[0] is not None:
        return [shot.contact_force for shot in shots], [touch.force for touch in blender]
    # The god object may have gone to a place that is nearer.
    touches = part("core.contact.single_press").press_points(
        body,
        [shot.proxy for shot in shots],
        [shot.probe - shot.proxy for shot in shots],
        part("core.contact.press").ContactSettings(young),
    )
    touches = part("core.shape.felt").felt(real, touches, young).touches
    return [shot.contact_force for shot in shots], [touch.force for touch in touches]


def rested(servo, ends):
    """The fingers once they have been for a while where they were led to."""
    deadline = time.monotonic() + 20.0
    while not all(
        np.allclose(shot.probe, end, rtol=0, atol=1e-12)
        for shot, end in zip(servo.snapshot().fingers, ends, strict=True)
    ):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    time.sleep(0.15)


def firm(servo, firming, real, young):
    """The fingers once they press as firmly as the body does."""
    deadline, before = time.monotonic() + 20.0, 1.0
    while firming.looks or before == 1.0 or servo.snapshot().firmness != before:
        assert time.monotonic() < deadline
        before = servo.snapshot().firmness
        firming.follow(servo.snapshot(), real, young)
        time.sleep(0.1)
    firming.close()
    return servo.snapshot().fingers


def assert_same(forces, expected):
    scale = np.abs(expected).max()
    np.testing.assert_allclose(forces, expected, rtol=0, atol=SAME * scale)
