"""Force against depth, for a point and for tools, as numbers, table and picture."""

import csv
import io
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from palpate.core.contact.place import nearest_place
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_tool, touch_nearest
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.errors import PalpateError
from palpate.core.softness.curve_picture import curve_svg, ticks
from palpate.core.softness.force_depth import facing_pose, force_depth_curve, usual_depth
from palpate.core.softness.parallel_rays import thickness

MIDDLE = (0.041, 0.0385, 0.05)
# Large ones: their contact points are few.
TOOLS = [sphere(0.016), rod(0.012, 0.02), plate(0.03, 0.02)]
TOP = (0.0265, 0.0235, 0.05)


def test_a_place_looks_straight_into_the_body_and_through_it(coarse_block):
    place = nearest_place(coarse_block, (0.041, 0.0385, 0.06))
    np.testing.assert_allclose(place.position, MIDDLE, atol=1e-12)
    np.testing.assert_allclose(place.axis, [0, 0, -1], atol=1e-12)
    assert thickness(coarse_block, place) == pytest.approx(0.05)


def test_a_point_curve_is_the_touch_made_longer(coarse_block):
    curve = force_depth_curve(coarse_block, MIDDLE, 0.004, steps=4, young_modulus=5e4)
    touch = touch_nearest(coarse_block, MIDDLE, (0, 0, -0.004), ContactSettings(5e4))
    assert curve.depths.tolist() == pytest.approx([0, 0.001, 0.002, 0.003, 0.004])
    assert curve.forces[-1] == pytest.approx(touch.force[2], rel=1e-9)
    np.testing.assert_allclose(curve.stiffness, curve.secant)


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
def test_a_tool_stands_with_its_foremost_point_at_the_depth(coarse_block, tool):
    place = nearest_place(coarse_block, MIDDLE)
    pose = facing_pose(place, tool, 0.002)
    below, above = (
        tool.distance(pose.to_tool((place.position + d * place.axis)[None]))[0][0]
        for d in (0.0021, 0.0019)
    )
    assert below > 0 > above


def test_the_area_below_a_curve_is_the_energy_in_the_body(cube):
    tool = TOOLS[0]
    curve = force_depth_curve(cube, TOP, 0.004, tool=tool, steps=24)
    deepest = facing_pose(nearest_place(cube, TOP), tool, 0.004)
    energy = press_tool(cube, tool, deepest).energy
    below = np.trapezoid(curve.forces, curve.depths)
    assert below == pytest.approx(energy, rel=0.01)
    assert abs(curve.forces[0]) < 1e-9
    grown = np.trapezoid(curve.stiffness, curve.depths)
    assert grown == pytest.approx(curve.forces[-1], rel=0.02)


def test_a_rod_pushes_back_harder_the_deeper_it_is(cube):
    curve = force_depth_curve(cube, TOP, 0.0006, tool=TOOLS[1], steps=2)
    assert curve.tool == "rod"
    assert np.all(np.diff(curve.forces) > 0)
    assert curve.areas[-1] > 0


def test_the_modulus_is_only_a_factor(cube):
    soft, firm = (
        force_depth_curve(cube, TOP, 0.001, tool=TOOLS[0], steps=3, young_modulus=E)
        for E in (1e4, 3e4)
    )
    np.testing.assert_allclose(3 * soft.forces, firm.forces, rtol=1e-6, atol=1e-12)


def test_without_a_depth_it_stays_shallow(coarse_block):
    assert usual_depth(coarse_block, MIDDLE, None) == pytest.approx(0.01)
    assert usual_depth(coarse_block, MIDDLE, TOOLS[0]) == pytest.approx(0.008)


def test_the_table_is_in_the_units_it_names(cube):
    curve = force_depth_curve(cube, TOP, 0.002, tool=TOOLS[0], steps=5)
    rows = list(csv.DictReader(io.StringIO(curve.as_csv())))
    assert len(rows) == 6
    assert float(rows[-1]["depth_mm"]) == pytest.approx(2)
    assert float(rows[-1]["force_n"]) == pytest.approx(curve.forces[-1], rel=1e-5)
    assert float(rows[-1]["stiffness_n_per_mm"]) == pytest.approx(
        curve.stiffness[-1] / 1000, rel=1e-5
    )
    assert float(rows[-1]["contact_area_mm2"]) == pytest.approx(1e6 * curve.areas[-1], rel=1e-5)


def test_the_picture_holds_all_points_within_its_frame(cube):
    curve = force_depth_curve(cube, TOP, 0.002, tool=TOOLS[0], steps=5)
    root = ET.fromstring(curve_svg(curve))  # noqa: S314 -- written a line above
    line = root.find(".//{*}polyline").get("points").split()
    x, y = np.array([point.split(",") for point in line], dtype=float).T
    assert len(line) == 6
    assert np.all(np.diff(x) > 0)
    assert np.all(np.diff(y) < 0)
    assert 0 < x.min() < x.max() < 640
    assert 0 < y.min() < y.max() < 400
    assert any("N/mm at 2 mm" in (text.text or "") for text in root.iter())


@pytest.mark.parametrize(
    ("highest", "expected"),
    [(1.0, [0, 0.2, 0.4, 0.6, 0.8, 1.0]), (0.37, [0, 0.1, 0.2, 0.3, 0.4]), (0.0, [0, 1])],
)
def test_ticks_are_round_numbers(highest, expected):
    assert ticks(highest).tolist() == pytest.approx(expected)


@pytest.mark.parametrize(
    "changed",
    [
        {"depth": 0.0},
        {"depth": float("nan")},
        {"depth": 1.0},
        {"steps": 0},
        {"young_modulus": 0.0},
    ],
)
def test_what_makes_no_curve_is_refused(coarse_block, changed):
    with pytest.raises(PalpateError, match=r"force curve: |Young's modulus is"):
        force_depth_curve(coarse_block, MIDDLE, **{"depth": 0.001, **changed})
