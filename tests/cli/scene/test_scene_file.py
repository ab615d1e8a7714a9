"""Several bodies of one scene file settle and are pressed, and strange files are refused."""

import json
import sys

import numpy as np
import pytest
from bodies.free_shapes import free_block

from palpate.core.body import body_file
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.pile.pile import Pile
from palpate.core.rest.support import Floor
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.shapes import shape

WEIGHT = 0.125 * 9.81
UPPER = {"name": "upper", "file": "cube.npz", "position": [0, 0, 0.0505]}
STACK = {
    "bodies": [{"name": "lower", "file": "cube.npz"}, UPPER],
    "supports": [{"floor": 0}],
}
FINGER = {
    "name": "finger",
    "tool": "sphere:0.012",
    "position": [0.025, 0.025, 0.1135],
    "by": [0, 0, -0.004],
}


@pytest.fixture(scope="module")
def cube():
    return free_block((0.05, 0.05, 0.05), (2, 2, 2))


@pytest.fixture(scope="module")
def folder(tmp_path_factory, cube):
    made = tmp_path_factory.mktemp("scene")
    body_file.save(cube, made / "cube.npz")
    return made


@pytest.fixture
def scene(folder):
    """Writes a scene beside the cube; the file."""

    def write(told, **more):
        file = folder / "scene.json"
        file.write_text(told if isinstance(told, str) else json.dumps({**told, **more}))
        return file

    return write


def forces(body):
    return {one["name"]: np.array(one["force"]) for one in body["touched_by"]}


def test_each_body_of_a_stack_bears_what_lies_on_it(scene, figures_of, tmp_path):
    out = tmp_path / "surfaces.npz"
    lower, upper = figures_of("settle", scene(STACK), "--surface", out)["bodies"]
    assert forces(upper)["lower"][2] == pytest.approx(WEIGHT, rel=1e-6)
    assert forces(lower)["upper"][2] == pytest.approx(-WEIGHT, rel=1e-6)
    assert forces(lower)["floor 1"][2] == pytest.approx(2 * WEIGHT, rel=1e-6)
    with np.load(out) as surfaces:
        assert sorted(surfaces) == ["lower", "upper"]
        assert surfaces["lower"][:, 2].min() == pytest.approx(0.0, abs=2e-4)
        assert surfaces["upper"][:, 2].max() == pytest.approx(0.1, abs=1e-3)


def test_its_own_tool_presses_it_as_a_pile_in_python_is_pressed(
    scene, figures_of, palpate, cube, tmp_path
):
    out = tmp_path / "displacements.npz"
    file = scene(STACK, tools=[FINGER])
    figures = figures_of("press", file, "--displacements", out)
    at = Pose.at(FINGER["position"])
    laid = [(cube, Pose.at([0, 0, 0])), (cube, Pose.at([0, 0, 0.0505]))]
    pile = Pile(laid, [Floor()], [(sphere(0.012), at)])
    shapes = [shape(cube, "real")] * 2
    settle_firmly(pile, shapes)
    pile.lead([Pose.at([0.025, 0.025, 0.1095])])
    lower, upper = settle_firmly(pile, shapes)
    (finger,) = figures["tools"]
    np.testing.assert_allclose(finger["force"], upper.tools[0].force, rtol=1e-6)
    floor = forces(figures["bodies"][0])["floor 1"]
    assert floor[2] == pytest.approx(2 * WEIGHT + finger["force"][2], rel=1e-6)
    assert finger["force"][2] > 0.2
    with np.load(out) as moved:
        np.testing.assert_allclose(moved["lower"], lower.displacements(), atol=1e-8)
    assert "touched by finger: force" in palpate("press", file)[1]


def test_a_tool_is_set_down_on_the_body_that_is_nearest(scene, figures_of):
    words = ("--tool", "sphere:0.012", "--at", 0.025, 0.025, 0.12, "--by", 0, 0, "-2e-3")
    lower, upper = figures_of("press", scene(STACK), *words)["bodies"]
    assert forces(upper)["--tool 1"][2] < -0.2
    assert "--tool 1" not in forces(lower)


def test_what_settle_prints_is_where_a_scene_goes_on(scene, figures_of):
    turned = {**UPPER, "rotation": [0, 0, 20]}
    first = figures_of("settle", scene(STACK, bodies=[turned], supports=[{"floor": 0.05}]))
    (lying,) = first["bodies"]
    again = {**turned, **{key: lying[key] for key in ("position", "rotation")}}
    (second,) = figures_of("settle", scene(STACK, bodies=[again], supports=[{"floor": 0.05}]))[
        "bodies"
    ]
    assert lying["rotation"][2] == pytest.approx(20.0, abs=0.5)
    np.testing.assert_allclose(second["position"], lying["position"], atol=3e-4)


BODY = '"bodies": [{"file": "cube.npz"}]'


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ("[]", "this is no object"),
        ("{", "no scene file"),
        ("[" * 100_000, "no scene file"),
        (f'{{{BODY}, "gravity": [0, 0, NaN]}}', "NaN is no number"),
        (f'{{{BODY}, "gravity": [0, 0, 1e400]}}', "'gravity' is [0, 0, Infinity]"),
        (f'{{{BODY}, "gravity": [0, 0, 1{"0" * 400}]}}', "'gravity'"),
        (f'{{{BODY}, "gravity": [0, true, 0]}}', "three numbers"),
        (f'{{{BODY}, "friction": -1}}', "coefficient"),
        (f"{{{BODY}, {BODY}}}", "given twice"),
        (f'{{{BODY}, "colour": 1}}', "'colour' is unknown"),
        ('{"bodies": []}', "list of 1 to 16"),
        ('{"bodies": [{}]}', "'file' is missing"),
        ('{"bodies": [{"file": "/etc/passwd"}]}', "no file beside"),
        ('{"bodies": [{"file": "C:cube.npz"}]}', "no file beside"),
        ('{"bodies": [{"file": "../x/cube.npz"}]}', "leads out of the folder"),
        ('{"bodies": [{"file": "none.npz"}]}', "there is no file"),
        ('{"bodies": [{"file": "scene.json"}]}', "scene.json"),
        ('{"bodies": [{"file": "cube.npz", "name": "../x"}]}', "letters, digits"),
        (f'{{{BODY}, "tools": [{{"tool": "sphere:nan"}}]}}', "tools number 1"),
        (f'{{{BODY}, "tools": [{{"tool": "convex:/etc/x.stl"}}]}}', "no file beside"),
        (f'{{{BODY}, "supports": [{{"friction": 1}}]}}', "either a floor or a tool"),
        (
            f'{{{BODY}, "supports": [{{"floor": 0, "rotation": [0, 9, 0]}}]}}',
            "leave 'rotation' out",
        ),
        (f'{{{BODY}, "supports": [{{"floor": 0, "name": "body 1"}}]}}', "taken already"),
    ],
)
def test_a_strange_scene_is_refused_by_its_entry(scene, refusal, told, said):
    assert said in refusal("settle", scene(told))


def test_a_large_file_is_not_read(scene, refusal):
    assert "larger than" in refusal("settle", scene(" " * 1_000_001))


@pytest.mark.skipif(sys.platform == "win32", reason="a link needs a privilege there")
def test_a_link_out_of_the_folder_is_refused(scene, refusal, folder, tmp_path):
    body_file.save(body_file.load(folder / "cube.npz"), tmp_path / "other.npz")
    (folder / "link.npz").symlink_to(tmp_path / "other.npz")
    assert "leads out" in refusal("settle", scene({"bodies": [{"file": "link.npz"}]}))


def test_a_tool_that_begins_within_a_body_is_refused(scene, refusal):
    inside = {**FINGER, "position": [0.025, 0.025, 0.025]}
    assert "within 'lower'" in refusal("press", scene(STACK, tools=[inside]))


@pytest.mark.parametrize("option", ["--floor", "--gravity", "--young", "--friction"])
def test_options_about_one_body_are_refused_with_a_scene(scene, refusal, option):
    assert option in refusal("press", scene(STACK), option, 1)


def test_a_scene_without_tools_needs_one(scene, refusal):
    assert "no tools that press" in refusal("press", scene(STACK))
    assert "--at" in refusal("press", scene(STACK).with_name("cube.npz"), "--by", 0, 0, 0)
