"""`palpate servo` has a device press the first body of a scene, and refuses what it cannot lay."""

import json

import pytest
from bodies.free_shapes import free_block

from palpate.core.body import body_file

SCENE = {
    "bodies": [
        {"name": "upper", "file": "cube.npz", "position": [0, 0, 0.0501]},
        {"name": "lower", "file": "cube.npz"},
    ],
    "supports": [{"floor": 0}],
    "tools": [{"tool": "sphere:0.012", "position": [0.025, 0.025, 0.2]}],
}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scene")
    body_file.save(
        free_block((0.05, 0.05, 0.05), (2, 2, 2), young_modulus=10_000.0), folder / "cube.npz"
    )
    file = folder / "scene.json"
    file.write_text(json.dumps(SCENE))
    return file


def test_a_device_presses_a_body_that_lies_on_another(scene, figures_of):
    figures = figures_of("servo", scene, "--simulate", "--seconds", 4)
    assert figures["peak_contact_force_n"] > 0.05
    assert figures["faults"]["nan"] == 0


@pytest.mark.parametrize(
    ("change", "said"),
    [({"tools": []}, "0 tools for 1 devices"), ({"bodies": SCENE["bodies"][:1] * 5}, "taken")],
)
def test_what_cannot_be_laid_is_refused(scene, palpate, change, said):
    other = scene.with_name("other.json")
    other.write_text(json.dumps({**SCENE, **change}))
    code, _, told = palpate("servo", other, "--simulate", "--seconds", 1)
    assert code == 2
    assert said in told
