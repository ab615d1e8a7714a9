"""Where the simulated hand goes."""

import json
import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from palpate.core.errors import PalpateError
from palpate.simulated.hand.hand_script import (
    HandScript,
    TurnScript,
    minimum_jerk,
    press_script,
    read_script,
    tilt_script,
)

REST, AT, BY = (0.0, 0.0, 0.05), (0.0, 0.0, 0.03), (0.0, 0.0, -0.01)
DEEP = (0.0, 0.0, 0.02)


def test_minimum_jerk_begins_and_ends_at_rest():
    assert [minimum_jerk(s) for s in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]
    step = 1e-4
    for end in (0.0, 1.0):
        inside = abs(end - step)
        assert abs(minimum_jerk(inside) - minimum_jerk(end)) < 20 * step**3


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_minimum_jerk_never_goes_back(a, b):
    low, high = sorted((a, b))
    # Between neighbouring numbers rounding may go either way, by far less than a micrometre.
    assert minimum_jerk(low) <= minimum_jerk(high) + 1e-12


def test_a_press_goes_from_rest_to_the_surface_in_out_and_in_again():
    script = press_script(REST, AT, BY, approach=1.0, period=2.0, hold=0.0)
    assert script.at(-1.0) == script.at(0.0) == REST
    for time, where in ((1.0, AT), (2.0, DEEP), (3.0, AT), (4.0, DEEP), (12.0, DEEP), (13.0, AT)):
        assert script.at(time) == pytest.approx(where, abs=1e-12)


def test_a_press_stays_at_the_deepest_point_for_as_long_as_it_shall():
    script = press_script(REST, AT, BY, approach=1.0, period=2.0, hold=1.0)
    for time in (1.5, 2.0, 2.5, 3.5, 4.5):
        assert script.at(time) == pytest.approx(DEEP)
    assert script.at(3.0) == pytest.approx(AT)
    for_good = press_script(REST, AT, BY, approach=1.0, period=2.0, hold=math.inf)
    assert for_good.at(2.0) == for_good.at(1e6) == pytest.approx(DEEP)


def test_the_hand_never_jumps():
    script = press_script(REST, AT, BY, approach=1.0, period=2.0, hold=0.5)
    heights = [script.at(tick * 1e-3)[2] for tick in range(8000)]
    steps = [abs(b - a) for a, b in pairwise(heights)]
    assert max(steps) < 1.9 * 0.02 / 1.0 * 1e-3


@pytest.mark.parametrize(
    "text",
    [
        "t,x,y,z\n0,0,0,0.05\n1,0,0,0.03\n2,0,0,0.02\n",
        json.dumps({"keyframes": [[0, 0, 0, 0.05], [1, 0, 0, 0.03], [2, 0, 0, 0.02]]}),
    ],
)
def test_scripts_are_read_as_csv_and_json(tmp_path, text):
    path = tmp_path / "script"
    path.write_text(text)
    assert read_script(path) == HandScript((0.0, 1.0, 2.0), (REST, AT, DEEP))


def test_a_json_script_may_repeat(tmp_path):
    path = tmp_path / "script.json"
    path.write_text(json.dumps({"keyframes": [[0, 0, 0, 0], [1, 1, 0, 0]], "repeat_from": 0}))
    assert read_script(path).at(7.5)[0] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("0,0,0\n", "not a script"),
        ("0,0,0,x\n", "not a script"),
        ("", "at least one"),
        ("0,0,0,nan\n", "no number"),
        ("1,0,0,0\n1,0,0,0\n", "do not rise"),
        ("0,0,0,0,1,0,0\n", "not a script"),
        ("0,0,0,0,0,0,0,0\n", "length must be more than 0"),
        ("0,0,0,0,1,0,0,0\n1,0,0,0\n", "not a script"),
        ("0,0,0,0,nan,0,0,0\n", "length must be more than 0"),
        ('{"frames": []}', "not a script"),
        ('{"keyframes": [[0, 0, 0, 0]], "repeat_from": 0}', "after its end"),
        ('{"keyframes": 3}', "not a script"),
        ('{"keyframes"', "not a script"),
        ('{"keyframes": ' + "[" * 100_000, "nested too deeply"),
        ('{"keyframes": [[0, 0, 0, 1' + "0" * 400 + "]]}", "not a script"),
        ('{"keyframes": [[0, 0, 0, Infinity]]}', "no number"),
        ('{"keyframes": [[]]}', "not a script"),
        ("0," * 200_000, "not a script"),
        ('"' + "0" * 200_000, "not a script"),
        ("\n" * 10_000_001, "larger than 10 MB"),
    ],
)
def test_scripts_that_make_no_sense_are_refused_with_the_reason(tmp_path, text, reason):
    path = tmp_path / "script"
    path.write_text(text)
    with pytest.raises(PalpateError, match=reason) as told:
        read_script(path)
    assert str(told.value).startswith(f"{path}: ")


def test_a_tilt_goes_there_and_back_about_its_axis():
    script = tilt_script((0.0, 2.0, 0.0), 60.0, period=4.0)
    upright, tilted = (1.0, 0.0, 0.0, 0.0), (math.cos(math.pi / 6), 0.0, 0.5, 0.0)
    for time, expected in ((0.0, upright), (2.0, tilted), (4.0, upright), (6.0, tilted)):
        assert script.at(time) == pytest.approx(expected)
    half_way = (math.cos(math.pi / 12), 0.0, math.sin(math.pi / 12), 0.0)
    assert script.at(1.0) == script.at(7.0) == pytest.approx(half_way)


@given(st.floats(0.0, 3.0))
def test_a_turn_takes_the_shorter_way_evenly_and_stays_a_rotation(time):
    """-q is the same rotation: from 170 degrees to 190, not back by 340."""
    begin, end = math.radians(85.0), math.radians(95.0)
    rotations = (
        (math.cos(begin), math.sin(begin), 0.0, 0.0),
        (-math.cos(end), -math.sin(end), 0.0, 0.0),
    )
    w, x, *rest = TurnScript((1.0, 2.0), rotations).at(time)
    assert rest == [0.0, 0.0]
    assert math.hypot(w, x) == pytest.approx(1.0, abs=1e-15)
    expected = begin + minimum_jerk(time - 1.0) * (end - begin)
    assert math.atan2(x, w) % math.pi == pytest.approx(expected)


def test_a_script_may_turn_the_stylus_too(tmp_path):
    path = tmp_path / "script"
    path.write_text("t,x,y,z,qw,qx,qy,qz\n0,0,0,0.05,2,0,0,0\n1,0,0,0.03,0,0,3,-4\n")
    rotations = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.6, -0.8))
    turns = TurnScript((0.0, 1.0), rotations)
    assert read_script(path) == HandScript((0.0, 1.0), (REST, AT), turns=turns)


def test_a_script_that_is_not_there_is_named(tmp_path):
    with pytest.raises(PalpateError, match=r"nowhere\.csv: cannot be read"):
        read_script(tmp_path / "nowhere.csv")


@pytest.mark.parametrize("hold", [2.0, 3.0, -1.0])
def test_a_hold_longer_than_the_press_is_refused(hold):
    with pytest.raises(PalpateError):
        press_script(REST, AT, BY, approach=1.0, period=2.0, hold=hold)


@pytest.mark.parametrize(
    ("axis", "degrees", "period"),
    [((0.0, 0.0, 0.0), 10.0, 1.0), ((1.0, 0.0, 0.0), 180.0, 1.0), ((1.0, 0.0, 0.0), 10.0, 0.0)],
)
def test_a_tilt_that_makes_no_sense_is_refused(axis, degrees, period):
    with pytest.raises(PalpateError, match="turn"):
        tilt_script(axis, degrees, period)


def test_quaternions_that_are_none_are_refused():
    with pytest.raises(PalpateError, match="not of length 1"):
        TurnScript((0.0,), ((1.0, 1.0, 0.0, 0.0),))
