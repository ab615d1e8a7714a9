"""The way of a tool with friction by the command line and by the servo's ticks: one force.

What has no friction is compared, in headless Blender too, in tests/addon/press/.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers

from palpate.cli.body.tool_option import tool_from
from palpate.cli.main import main
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
ABOVE = (0.02, -0.03, 0.3)
DEPTH, ASIDE = 0.002, 0.0015
SPHERE, FRICTION = "sphere:0.008", 0.4
TICKS_TO_REST = 400
SAME = 1e-6


def stored_body(name):
    if name == "cube":
        mesh, fixed = paper_cube()
    else:
        with np.load(SAMPLES / f"{name}-tets.npz") as stored:
            mesh, fixed = TetMesh.checked(stored["X"], stored["T"]), stored["fixed"]
    return bake(mesh, BakeSettings(0.3, 5_000.0, PinNodes(fixed)))[0]


@pytest.mark.parametrize(
    "name",
    ["cube", *(pytest.param(name, marks=pytest.mark.at_length) for name in ("mouse", "hare"))],
)
def test_a_sphere_led_aside(name, tmp_path, capsys):
    body = stored_body(name)
    file = tmp_path / "body.npz"
    body_file.save(body, file)
    size = np.ptp(body.mesh.nodes, axis=0)
    place = nearest_place(body, body.mesh.nodes.mean(axis=0) + np.array(ABOVE) * size)
    by = DEPTH * place.axis + ASIDE * np.linalg.svd(place.axis[None])[2][1]
    words = ["--at", *map(repr, place.position.tolist()), "--by", *map("{:.17f}".format, by)]
    words += ["--tool", SPHERE, "--friction", repr(FRICTION), "--json", "--shape", "linear"]
    assert main(["press", str(file), *words]) == 0
    told = json.loads(capsys.readouterr().out)

    native = native_body(body, whole=True)
    way = np.linspace(1.0, 0.0, STEPS_WITH_FRICTION + 1)[:, None, None]
    path = np.array(told["position"]) - way * by
    settings = Settings(body.young_modulus, static_friction=FRICTION, dynamic_friction=FRICTION)
    servo = SteppedFingers(native, path[0], settings)
    servo.set_tool(native_tool(body, native, tool_from(SPHERE)), np.array(told["rotation"]), 0)
    for places in path:
        forces, _ = servo.follow(np.tile(places, (TICKS_TO_REST, 1, 1)))
    assert np.abs(told["force"]).max() > 1e-4
    np.testing.assert_allclose(
        forces[-1][0], told["force"], atol=SAME * np.abs(told["force"]).max()
    )
