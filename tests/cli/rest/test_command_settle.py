"""Bodies without pins on the command line: they settle on a floor and are pressed there."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.body import body_file

WEIGHT = 0.125 * 9.81


@pytest.fixture(scope="module")
def free_file(tmp_path_factory, cube_mesh):
    path = tmp_path_factory.mktemp("free") / "cube.npz"
    body_file.save(baked_body(cube_mesh[0], [], 0.45, 1e5, density=1000.0), path)
    return path


def test_a_body_settles_on_a_floor_that_bears_its_weight(free_file, tmp_path, figures_of):
    out = tmp_path / "surface.npy"
    figures = figures_of("settle", free_file, "--floor", -0.01, "--surface", out)
    np.testing.assert_allclose(figures["floor"]["force"], [0, 0, -WEIGHT], atol=1e-5)
    assert figures["mass_kg"] == pytest.approx(0.125)
    # It fell by 10 mm and sags by less than one.
    surface = np.load(out)
    assert surface.shape == (98, 3)
    assert surface[:, 2].min() == pytest.approx(-0.01, abs=2e-4)
    assert 0.049 < np.ptp(surface[:, 2]) < 0.0501


def test_without_gravity_it_stays_where_it_is(free_file, figures_of):
    figures = figures_of("settle", free_file, "--gravity", 0)
    np.testing.assert_allclose(figures["position"], 0.0, atol=1e-9)
    np.testing.assert_allclose(figures["floor"]["force"], 0.0, atol=1e-9)


def test_a_tool_presses_it_against_the_floor(free_file, tmp_path, figures_of, palpate):
    out = tmp_path / "u.npy"
    at = ["--at", 0.025, 0.025, 0.05, "--by", 0, 0, "-2e-3", "--tool", "sphere:0.012"]
    figures = figures_of("press", free_file, *at, "--displacements", out)
    pressed, borne = figures["force"][2], -figures["floor"]["force"][2]
    assert pressed > 0.5
    assert borne == pytest.approx(pressed + WEIGHT, rel=1e-3)
    assert np.load(out).shape == (98, 3)
    assert "pressed points" in palpate("press", free_file, *at)[1]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "pressed by tools only"),
        (["--tool", "sphere:0.012", "--shape", "paper"], "tables are of bodies with pins"),
        (["--tool", "sphere:0.012", "--mode", "paper"], "about points"),
        (["--tool", "sphere:0.012", "--floor-friction", "-1"], "coefficient of friction"),
    ],
)
def test_what_a_body_without_pins_cannot_do_is_refused(free_file, refusal, words, said):
    at = ["--at", 0.025, 0.025, 0.05, "--by", 0, 0, "-2e-3"]
    assert said in refusal("press", free_file, *at, *words)


def test_a_floor_is_for_bodies_without_pins(cube_file, free_file, refusal):
    at = ["--at", 0.025, 0.025, 0.05, "--by", 0, 0, "-2e-3"]
    assert "--floor: the body is pinned" in refusal("press", cube_file, *at, "--floor", 0)
    assert "without pins" in refusal("settle", cube_file)
    assert "no pins" in refusal("curve", free_file, "--at", 0.025, 0.025, 0.05, "--depth", 1e-3)
