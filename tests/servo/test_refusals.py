"""What the compiled module refuses is told with its name, its value and what it must be."""

import numpy as np
import pytest
from palpate_servo import (
    Compliance,
    CubicPlaces,
    HaplyDevice,
    LinkDevice,
    Pointer,
    Servo,
    Tool,
    closest_points,
    device_coupling,
    nearest_polygon,
    polygons_on_line,
)

from palpate.core.servo.settings import Coupling, Settings

SKEWED = [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
PLACES = np.eye(3, dtype=np.float32)
CORNERS, STARTS = np.array([0, 1, 2], np.int32), np.array([0, 3], np.int32)


def servo(cube, **given):
    return Servo(cube.native, Settings(1.0), **given)


def with_settings(cube, **given):
    return servo(cube).set(Settings(1.0, **given))


class Skewed:
    rotation, translation, scale = np.array(SKEWED), np.zeros(3), 1.0


class Nowhere:
    rotation, translation, scale = np.eye(3), np.array([0.0, np.nan, 0.0]), 1.0


REFUSALS = {
    "rate": (lambda c: servo(c, rate_hz=99), r"rate_hz is 99; it must be from 100 to 8000"),
    "force": (
        lambda c: servo(c, max_force=-1.0),
        r"max_force is -1; it must be finite",
    ),
    "ramp": (lambda c: servo(c, ramp_seconds=0.0), r"is 0; it must be from 0\.05 to 3600 seconds"),
    "kept": (lambda c: servo(c, record_seconds=3600.0), r"is 3600; .* 0 to 60: .*start_recording"),
    "recording": (lambda c: servo(c).start_recording(3601.0), r"seconds is 3601; .* 0 to 3600"),
    "stiffness": (
        lambda c: with_settings(c, coupling=Coupling(0.0, 1.0, True)),
        r"stiffness is 0; it must be more than 0 N/m",
    ),
    "damping": (
        lambda c: with_settings(c, coupling=Coupling(1.0, -2.0, True)),
        r"damping is -2; it must be finite and at least 0",
    ),
    "friction": (
        lambda c: with_settings(c, static_friction=0.3, dynamic_friction=0.4),
        r"static_friction is 0\.3 and dynamic_friction 0\.4; they must be finite",
    ),
    "frame": (lambda c: with_settings(c, frames=(Skewed(),)), r"rotation is .*0\.5.*orthonormal"),
    "place": (lambda c: with_settings(c, frames=(Nowhere(),)), r"translation is .*NaN.* finite"),
    "turn": (
        lambda c: with_settings(c, orientations=[SKEWED]),
        r"orientation is .*0\.5.*no rotation; give orthogonal",
    ),
    "finger": (lambda c: servo(c).set_tool(None, finger=9), r"finger is 9; a servo has fingers 0"),
    "angles": (
        lambda c: servo(c).start(HaplyDevice("/nowhere", angles=(10.0, 400.0))),
        r"angles has 400; each must be from -360 to 360",
    ),
    "baud": (lambda c: servo(c).start(LinkDevice("/nowhere", baud=7)), r"baud is 7; .* from "),
    "target": (
        lambda c: servo(c).start(Pointer((np.inf, 0.0, 0.0))),
        r"position is .*inf.*finite",
    ),
    "encoders": (lambda _: device_coupling(encoder_step=-1.0), r"encoder_step is -1; it must be"),
    "radius": (lambda _: Tool(np.zeros((1, 3)), -1.0), r"radius is -1; it must be finite"),
    "core": (lambda _: Tool([[0, 0, np.nan]], 1.0), r"core point 0 is .*NaN.* must be finite"),
    "columns": (lambda _: Tool(np.zeros((1, 2)), 1.0), r"core has the shape \[1, 2\]; .*\(n, 3\)"),
    "table": (
        lambda _: Compliance.dense(np.zeros((2, 3, 5), np.float32)),
        r"table has the shape \[2, 3, 5\]; it must be \(n, 3, 3n\)",
    ),
    "kind": (
        lambda _: Compliance.dense(np.zeros((1, 3, 3), np.int32)),
        r"no array of f64 but of int32; give it as the body file has it",
    ),
    "relaxation": (
        lambda c: with_settings(c, relaxation=((-1.0, 2.0),)),
        r"relaxation is \[\(-1\.0, 2\.0\)\]; give at most 3 pairs",
    ),
    "points": (
        lambda c: closest_points(c.nodes, c.triangles, [[0.0, np.nan, 0.0]]),
        r"points has .*NaN.* in row 0; each coordinate must be finite",
    ),
    "triangle": (
        lambda c: closest_points(c.nodes[:3], [[0, 1, 3]], np.zeros((1, 3))),
        r"names the node 3, and there are 3; they are numbered from 0",
    ),
    "direction": (
        lambda _: polygons_on_line(PLACES, CORNERS, STARTS, (0, 0, 0), (0, 0, 0)),
        r"direction is \[0, 0, 0\]; give one with a length",
    ),
    "polygons": (
        lambda _: nearest_polygon(PLACES, CORNERS, STARTS[::-1].copy(), (0, 0, 0)),
        r"places \[3, 3\], corners \[3\] and starts \[2\] make no polygons; places must be",
    ),
    "patch": (
        lambda _: CubicPlaces([4], [[1.0, 0.0, 0.0]], 4),
        r"beyond the 4 that there are; they are numbered from 0",
    ),
}


@pytest.mark.parametrize("name", REFUSALS)
def test_a_refusal_names_the_thing_its_value_and_the_remedy(cube, name):
    call, told = REFUSALS[name]
    with pytest.raises((ValueError, TypeError), match=told):
        call(cube)


def test_an_array_that_is_missing_is_asked_for():
    with pytest.raises(KeyError, match="compressed_places is missing; give all arrays"):
        Compliance.compressed({})
