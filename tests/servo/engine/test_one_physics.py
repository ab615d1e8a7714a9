"""The same press by the command line and by the servo's ticks gives the same forces."""

import json
from pathlib import Path

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers

from palpate.cli.main import main
from palpate.cli.press.tool_option import tool_from
from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body import body_file
from palpate.core.contact.place import nearest_place
from palpate.core.contact.single_press import STEPS_WITH_FRICTION
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

SAMPLES = Path(__file__).resolve().parents[3] / "sample_scenes"
# Where it is touched, and how deep, metres.
ABOVE, BESIDE = (0.02, -0.03, 0.3), (-0.2, 0.05, 0.3)
DEPTH, ASIDE = 0.002, 0.0015
TICKS_TO_REST = 400
SAME = 1e-6


@pytest.fixture(scope="module", params=["cube", "mouse", "hare"])
def file(request, tmp_path_factory):
    """A stored body."""
    if request.param == "cube":
        mesh, fixed = paper_cube()
    else:
        with np.load(SAMPLES / f"{request.param}-tets.npz") as stored:
            mesh, fixed = TetMesh.checked(stored["X"], stored["T"]), stored["fixed"]
    body, _ = bake(mesh, BakeSettings(0.3, 5_000.0, PinNodes(fixed)))
    path = tmp_path_factory.mktemp("body") / f"{request.param}.npz"
    body_file.save(body, path)
    return path


@pytest.fixture(scope="module")
def body(file):
    return body_file.load(file)


@pytest.fixture(scope="module")
def native(body):
    return native_body(body, whole=True)


def place_on(body, aside):
    """The surface above the middle of the body, beside it by a share of its box; metres."""
    size = np.ptp(body.mesh.nodes, axis=0)
    return nearest_place(body, body.mesh.nodes.mean(axis=0) + np.array(aside) * size)


def pressed(capsys, file, ats, bys, *words):
    """What the command line tells of each contact."""
    pairs = [
        word
        for at, by in zip(ats, bys, strict=True)
        for word in ("--at", *map(repr, at.tolist()), "--by", *map("{:.17f}".format, by))
    ]
    capsys.readouterr()
    assert main(["press", str(file), *pairs, *words, "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    return figures.get("contacts", [figures])


def at_rest(native, path, settings, tools=()):
    """Forces of fingers led through the places of ``path`` (t, m, 3), each until all rests."""
    fingers = SteppedFingers(native, path[0], settings)
    for finger, (tool, rotation) in enumerate(tools):
        fingers.set_tool(tool, rotation, finger)
    for places in path:
        forces, _ = fingers.follow(np.tile(places, (TICKS_TO_REST, 1, 1)))
    return forces[-1], fingers.snapshot().fingers


def assert_same(forces, contacts):
    told = np.array([contact["force"] for contact in contacts])
    assert np.abs(told).max() > 1e-4
    np.testing.assert_allclose(forces, told, atol=SAME * np.abs(told).max())


@pytest.mark.parametrize("shares", [[ABOVE], [ABOVE, BESIDE]], ids=["point", "two points"])
def test_points(capsys, file, body, native, shares):
    places = [place_on(body, share) for share in shares]
    goals = np.array([place.position + DEPTH * place.axis for place in places])
    above = np.array([place.position - DEPTH * place.axis for place in places])
    settings = Settings(body.young_modulus)
    forces, fingers = at_rest(native, np.array([above, goals]), settings)
    # The god object may have gone to a place that is nearer: that is where it presses.
    ats = [finger.proxy for finger in fingers]
    bys = [finger.probe - finger.proxy for finger in fingers]
    assert_same(forces, pressed(capsys, file, ats, bys))


@pytest.mark.parametrize(
    ("words", "friction"),
    [("sphere:0.008", 0.0), ("plate:0.016:0.012", 0.0), ("sphere:0.008", 0.4)],
    ids=["sphere", "plate", "sphere with friction"],
)
def test_a_tool(capsys, file, body, native, words, friction):
    place = place_on(body, ABOVE)
    aside = np.linalg.svd(place.axis[None])[2][1]
    by = DEPTH * place.axis + (ASIDE * aside if friction else 0.0)
    options = ["--tool", words, "--friction", repr(friction)]
    contacts = pressed(capsys, file, [place.position], [by], *options)
    end, rotation = (np.array(contacts[0][name]) for name in ("position", "rotation"))
    steps = STEPS_WITH_FRICTION if friction else 4
    path = end - np.linspace(1.0, 0.0, steps + 1)[:, None, None] * by
    settings = Settings(body.young_modulus, static_friction=friction, dynamic_friction=friction)
    tool = native_tool(body, native, tool_from(words))
    forces, _ = at_rest(native, path, settings, [(tool, rotation)])
    assert_same(forces, contacts)


def test_two_spheres_that_pinch(capsys, file, body, native):
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    middle = low + [0.5, 0.5, 0.45] * (high - low)
    places = [
        nearest_place(body, middle + side * 0.5 * (high - low)[1] * np.array([0.0, 1.0, 0.0]))
        for side in (-1.0, 1.0)
    ]
    bys = [DEPTH * place.axis for place in places]
    options = ["--tool", "sphere:0.008"]
    contacts = pressed(capsys, file, [place.position for place in places], bys, *options)
    ends = np.array([contact["position"] for contact in contacts])
    path = ends - np.linspace(1.0, 0.0, 5)[:, None, None] * np.array(bys)
    tool = native_tool(body, native, tool_from("sphere:0.008"))
    tools = [(tool, np.array(contact["rotation"])) for contact in contacts]
    forces, _ = at_rest(native, path, Settings(body.young_modulus), tools)
    assert_same(forces, contacts)
