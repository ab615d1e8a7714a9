"""From pointer, pen and keyboard to what a stroke asks of the body."""

from __future__ import annotations

import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from soft_scene import part

RIGHT, UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def dragged(motion, by=(0.0, 0.0), sign=1.0, **more):
    drags, view = part("operators.stroke.stroke_drag"), part("operators.scene.probe_drag").View
    kind = part("operators.stroke.answer.motion").Motion[motion]
    start = drags.StrokeDrag(
        kind, sign, view(RIGHT, UP, 1e-4), 0.01, 0.1, 1.0, (100.0, 50.0), (100.0, 50.0), **more
    )
    return start.dragged((100.0 + by[0], 50.0 + by[1]), more.get("pressure", 0.0))


@pytest.mark.parametrize("turn", np.linspace(0.0, 2.0 * math.pi, 9)[:-1])
@pytest.mark.parametrize("motion", ["PUSH", "TWIST", "PINCH"])
def test_a_drag_goes_on_in_every_direction(palpate, motion, turn):
    way = 50.0 * np.array([math.cos(turn), math.sin(turn)])
    near, far = (dragged(motion, share * way).asked(np.eye(3)).amount for share in (0.5, 1.0))
    assert 0.0 < near < far
    assert dragged(motion, way, sign=-1.0).asked(np.eye(3)).amount == -far


def test_a_push_is_as_deep_as_the_pointer_went(palpate):
    assert dragged("PUSH", (30.0, 40.0)).asked(np.eye(3)).amount == pytest.approx(0.005)


def test_a_click_asks_nothing_and_a_pen_pushes_by_its_pressure_alone(palpate):
    assert dragged("PUSH").asked(np.eye(3)).nothing
    assert dragged("GRAB").asked(np.eye(3)).nothing
    assert dragged("PUSH", pressure=1.0).asked(np.eye(3)).amount == pytest.approx(0.01)


def test_a_grab_follows_the_pointer_in_the_plane_of_the_view_and_turns_back_to_rest(palpate):
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    asked = dragged("GRAB", (10.0, 20.0)).asked(turn)
    assert np.allclose(turn @ asked.by, 1e-3 * RIGHT + 2e-3 * UP)


def test_what_is_typed_counts_instead_of_the_drag(palpate):
    typed = dragged("PUSH", (30.0, 40.0), sign=-1.0, typed=0.02)
    assert typed.asked(np.eye(3)).amount == -0.02
    way = dragged("GRAB", (30.0, 40.0), typed=0.02).asked(np.eye(3)).by
    assert np.allclose(way, 0.02 * (0.6 * RIGHT + 0.8 * UP))


@pytest.mark.parametrize(
    ("motion", "keys", "expected"),
    [
        ("PUSH", ["5", "m", "m"], 0.005),
        ("PUSH", ["TWO", "PERIOD", "FIVE"], 2.5),
        ("PUSH", ["-", "3", "c", "m", "BACK_SPACE", "m"], -0.03),
        ("TWIST", ["9", "0"], math.pi / 2),
        ("PINCH", ["5", "0"], 0.5),
        ("PUSH", ["-"], None),
        ("PUSH", ["5", "/", "0"], None),
        ("PUSH", [*"0.3+2cm"], 0.32),
        ("PUSH", [*"-(1+2)*2mm"], -0.006),
        ("PUSH", [*"1'6\""], 0.4572),
        ("PUSH", [*"6cm/4"], 0.015),
        ("TWIST", [*"90/2"], math.pi / 4),
    ],
)
def test_keys_become_a_number_in_the_units_of_the_scene(palpate, motion, keys, expected):
    typed = part("operators.stroke.typed_amount").TypedAmount(
        part("operators.stroke.answer.motion").Motion[motion]
    )
    for key in keys:
        typed = typed.after(_key(key))
    value = typed.value(bpy.context.scene)
    assert value == (None if expected is None else pytest.approx(expected))


@pytest.mark.parametrize(
    "text", ["-", "-()", "(", "3)", "1(2)", "1 2", "3,", "9**9**9", "5cmm", "//"]
)
@pytest.mark.parametrize("motion", ["PUSH", "TWIST"])
def test_what_is_no_number_yet_is_none_and_nothing_is_printed(palpate, capfd, motion, text):
    typed = part("operators.stroke.typed_amount").TypedAmount(
        part("operators.stroke.answer.motion").Motion[motion], text
    )
    assert (typed.value(bpy.context.scene) is None) == (text != "3,")
    assert capfd.readouterr() == ("", "")


def test_a_bare_number_is_in_the_unit_that_the_scene_shows(palpate):
    units = bpy.context.scene.unit_settings
    amount = part("operators.stroke.typed_amount").TypedAmount
    push = part("operators.stroke.answer.motion").Motion.PUSH
    for system, unit, metres in (
        ("METRIC", "MILLIMETERS", 0.006),
        ("METRIC", "ADAPTIVE", 6.0),
        ("IMPERIAL", "INCHES", 0.1524),
        ("IMPERIAL", "ADAPTIVE", 1.8288),
        ("NONE", "METERS", 6.0),
    ):
        units.system = system
        if system != "NONE":
            units.length_unit = unit
        assert amount(push, "2*3").value(bpy.context.scene) == pytest.approx(metres), (system, unit)


def _key(name: str) -> SimpleNamespace:
    character = name if len(name) == 1 else ""
    return SimpleNamespace(
        type=name, unicode=character, value="PRESS", ctrl=False, alt=False, oskey=False
    )
