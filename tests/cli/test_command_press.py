"""The command press as a user runs it, from the body file to the figures."""

import json

import numpy as np
import pytest

from palpate.cli.body.tool_option import tool_from
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_points, touch_nearest
from palpate.core.contact.tool.tools import plate, rod
from palpate.core.shape.meeting import settled
from palpate.core.shape.rotation_strain.finger_load import FingerLoad
from palpate.core.shape.shapes import MAKERS, shape


@pytest.mark.parametrize("mode", ["paper", "consistent"])
def test_press_reads_the_force_and_writes_displacements(
    mode, cube_file, tmp_path, figures_of, cube
):
    out = tmp_path / "u.npy"
    words = ["--by", 0, "1e-3", "-5e-3", "--young", 10000, "--mode", mode, "--displacements", out]
    words += ["--shape", "linear"]
    figures = figures_of("press", cube_file, "--at", 0.021, 0.024, 0.06, *words)
    settings = ContactSettings(10000, mode=mode)
    touch = touch_nearest(cube, [0.021, 0.024, 0.06], [0, 1e-3, -5e-3], settings)
    np.testing.assert_allclose(figures["force"], touch.force, rtol=1e-9)
    np.testing.assert_allclose(figures["nodal_forces"], touch.nodal_forces, rtol=1e-9)
    assert figures["mode"] == mode
    assert figures["triangle"] == touch.triangle.tolist()
    assert sum(figures["alpha"]) == pytest.approx(1)
    np.testing.assert_allclose(-np.sum(figures["nodal_forces"], axis=0), figures["force"])
    displacements = np.load(out)
    assert displacements.shape == (73, 3)
    assert displacements.dtype == np.float64
    largest = np.linalg.norm(displacements, axis=1).max()
    assert figures["max_displacement"] == pytest.approx(largest)


def test_press_is_consistent_unless_told_otherwise(cube_file, figures_of):
    words = ["press", cube_file, "--at", 0.02, 0.024, 0.05, "--by", 0, 0, "-5e-3"]
    figures = figures_of(*words)
    assert (figures["mode"], figures["shape"]) == ("consistent", "real")
    np.testing.assert_allclose(figures["contact_displacement"], [0, 0, -5e-3], atol=5e-5)
    papers = figures_of(*words, "--mode", "paper")
    assert papers["force"] != figures["force"]
    assert papers["shape"] == "linear"


def test_press_takes_several_fingers_in_order(cube_file, tmp_path, palpate, figures_of, cube):
    at, by = [[0, 0.025, 0.03], [0.05, 0.02, 0.03]], [[0.004, 0, 0], [-0.003, 0, 0]]
    pairs = ["--at", *at[0], "--by", *by[0], "--at", *at[1], "--by", *by[1]]
    out = tmp_path / "u.npy"
    words = ["press", cube_file, *pairs, "--young", 1000, "--displacements", out]
    words += ["--shape", "linear"]
    figures = figures_of(*words)
    touches = press_points(cube, at, by, ContactSettings(1000))
    assert len(figures["contacts"]) == 2
    for contact, touch in zip(figures["contacts"], touches, strict=True):
        np.testing.assert_allclose(contact["force"], touch.force, rtol=1e-9)
        np.testing.assert_allclose(contact["nodal_forces"], touch.nodal_forces, rtol=1e-9)
        np.testing.assert_allclose(contact["contact_displacement"], touch.displacement, atol=1e-7)
    forces = -np.array([contact["force"] for contact in figures["contacts"]])
    moved = np.einsum("pqij,qj->pi", figures["coupling"], forces)
    np.testing.assert_allclose(moved, by, atol=1e-9)
    largest = np.linalg.norm(np.load(out), axis=1).max()
    assert figures["max_displacement"] == pytest.approx(largest)
    status, printed, _ = palpate(*words)
    assert status == 0
    assert [line for line in printed.splitlines() if not line.startswith(" ")] == [
        "contact 1",
        "contact 2",
        "coupling, m/N (how far each contact moves per newton on each)",
        f"max displacement  {figures['max_displacement']:.6g}",
        "young modulus     1000",
        "shape             linear",
        "mode              consistent",
    ]


@pytest.mark.parametrize("tool", ["sphere:0.015", "convex"])
def test_press_takes_a_tool_instead_of_a_point(
    tool, cube_file, tmp_path, palpate, figures_of, cube
):
    (tmp_path / "tip.obj").write_text(
        "v -.01 -.01 .02\nv .01 -.01 .02\nv .01 .01 .02\nv -.01 .01 .02\nv 0 0 0\n"
        "f 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n"
    )
    named = f"convex:{tmp_path / 'tip.obj'}" if tool == "convex" else tool
    out = tmp_path / "u.npy"
    words = [
        "press", cube_file, "--at", 0.025, 0.02, 0.06, "--by", 0, 0, "-3e-3",
        "--tool", named, "--displacements", out, "--shape", "linear",
    ]  # fmt: skip
    figures = figures_of(*words)
    assert figures["exact"] is True
    assert figures["force"][2] > 0
    np.testing.assert_allclose(
        -np.sum(figures["nodal_forces"], axis=0), figures["force"], atol=1e-12
    )
    nodes, forces = np.array(figures["nodes"]), np.array(figures["nodal_forces"])
    moved = cube.deform(nodes, forces, figures["young_modulus"])
    largest = np.abs(moved).max()
    np.testing.assert_allclose(np.load(out), moved, rtol=0, atol=1e-6 * largest)
    places = np.array(figures["points"]) + figures["point_displacements"]
    assert len(figures["pressures"]) == len(places)
    if tool.startswith("sphere"):
        # The pressed points have gone to the tool's surface.
        in_tool = (places - figures["position"]) @ np.array(figures["rotation"])
        np.testing.assert_allclose(tool_from(named).distance(in_tool)[0], 0, atol=1e-6)
        printed = palpate(*words)[1]
        assert f"tool                   {named}" in printed.splitlines()
        assert f"pressed points         {len(places)}" in printed.splitlines()


def test_tools_are_named_by_kind_and_lengths():
    for words, expected in (
        ("rod:0.01:0.02", rod(0.01, 0.02)),
        ("plate:0.04:0.03", plate(0.04, 0.03)),
    ):
        tool = tool_from(words)
        assert tool.name == words
        np.testing.assert_array_equal(tool.core, expected.core)
        assert tool.radius == expected.radius


def test_press_takes_several_tools_and_friction(cube_file, palpate, figures_of):
    tool = ["--tool", "sphere:0.015"]
    left, right = ([x, 0.025, 0.03] for x in (0, 0.05))
    one = ["press", cube_file, "--at", *left, "--by", "2e-3", "1e-3", 0]
    both = [*one, "--at", *right, "--by", "-2e-3", "1e-3", 0]
    status, printed, _ = palpate(*both, *tool, "--json")
    assert status == 0
    pinch = [contact["force"] for contact in json.loads(printed)["contacts"]]
    alone = figures_of(*one, *tool)["force"]
    assert pinch[0][0] < 1.02 * alone[0] < 0 < pinch[1][0]  # They press against each other.
    rubbed = figures_of(*one, *tool, "--friction", 0.5)["force"]
    assert rubbed[1] < alone[1] - 0.05 * abs(alone[0])  # Held back by the surface.


@pytest.mark.parametrize("name", MAKERS)
def test_press_writes_the_shape_that_is_asked_for(name, cube_file, tmp_path, palpate, cube):
    out = tmp_path / "u.npy"
    words = ["press", cube_file, "--at", 0.021, 0.024, 0.06, "--by", 0, 0, "-5e-3", "--json"]
    status, printed, _ = palpate(*words, "--shape", name, "--displacements", out)
    assert status == 0
    assert json.loads(printed)["shape"] == name
    touch = touch_nearest(cube, [0.021, 0.024, 0.06], [0, 0, -5e-3])
    made = shape(cube, name)
    loads = [FingerLoad(touch.triangle, touch.nodal_forces, sticks=True)]
    wanted = settled(cube, made, loads, cube.young_modulus).displacements
    made.close()
    np.testing.assert_allclose(np.load(out), wanted, atol=1e-6 * np.abs(wanted).max())


@pytest.mark.parametrize("tip", [(), ("--tool", "sphere:0.012")], ids=["point", "sphere"])
def test_real_is_felt_and_seen(tip, cube_file, figures_of):
    words = ["press", cube_file, "--at", 0.025, 0.025, 0.05, "--by", 0, 0, "-12e-3", *tip]
    linear, real = (figures_of(*words, "--shape", name) for name in ("linear", "real"))
    assert real["shape"] == figures_of(*words, "--shape", "rotation-strain")["shape"] == "real"
    ratio = np.linalg.norm(real["force"]) / np.linalg.norm(linear["force"])
    assert 0.01 < abs(ratio - 1.0) < 1.0
    np.testing.assert_allclose(
        np.sum(real["nodal_forces"], axis=0), -np.array(real["force"]), atol=1e-9
    )
    shallow = [*words[:6], "--by", 0, 0, "-1e-6", *tip]
    one, other = (figures_of(*shallow, "--shape", name)["force"] for name in ("linear", "real"))
    np.testing.assert_allclose(other, one, rtol=5e-3, atol=1e-9)


def test_the_papers_contact_stays_as_published(cube_file, figures_of):
    words = ["press", cube_file, "--at", 0.025, 0.025, 0.05, "--by", 0, 0, "-12e-3"]
    words += ["--mode", "paper", "--shape"]
    assert figures_of(*words, "real")["force"] == figures_of(*words, "linear")["force"]
