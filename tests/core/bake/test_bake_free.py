"""Bakes without pins."""

from dataclasses import replace

import numpy as np
import pytest

from palpate.core.bake.request import BakeRequest
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body import body_file
from palpate.core.compliance.free_body.density import DEFAULT_DENSITY
from palpate.core.errors import PalpateError
from palpate.core.stiffness.pins import NoPins, PinNodes

FREE = BakeSettings(poisson_ratio=0.45, young_modulus=5e3, pins=NoPins(), density=1_200.0)


@pytest.fixture(scope="module")
def free_cube(cube_mesh):
    return bake(cube_mesh[0], FREE)[0]


def test_a_free_body_has_no_pins_and_a_mass(free_cube):
    assert free_cube.is_free
    assert free_cube.compliance.node_count == len(free_cube.mesh.surface_nodes) == 98
    assert free_cube.mass == pytest.approx(1_200.0 * 0.05**3, rel=1e-12)
    np.testing.assert_allclose(free_cube.inertia.centre, 0.025, rtol=1e-12)


def test_its_file_gives_it_back(free_cube, tmp_path):
    body_file.save(free_cube, tmp_path / "free.npz")
    for mapped_from in (None, 0):
        found = body_file.load(tmp_path / "free.npz", mapped_from_bytes=mapped_from)
        assert (found.key, found.density, found.is_free) == (free_cube.key, 1_200.0, True)
        np.testing.assert_array_equal(found.compliance.table, free_cube.compliance.table)


def test_density_is_no_part_of_the_key(free_cube, cube_mesh):
    body, _ = bake(cube_mesh[0], replace(FREE, density=None))
    assert body.density == DEFAULT_DENSITY
    assert body.key == free_cube.key
    np.testing.assert_array_equal(body.compliance.table, free_cube.compliance.table)


def test_a_pinned_body_may_have_a_density_and_needs_none(cube_mesh, tmp_path):
    mesh, fixed = cube_mesh
    for density in (None, 40.0):
        body, _ = bake(mesh, BakeSettings(pins=PinNodes(fixed), density=density))
        body_file.save(body, tmp_path / "pinned.npz")
        assert body_file.load(tmp_path / "pinned.npz").density == body.density == density
    with pytest.raises(PalpateError, match="no density"):
        _ = replace(body, density=None).mass


def test_a_rule_that_pins_nothing_makes_no_free_body(cube_mesh):
    with pytest.raises(PalpateError, match="could move away"):
        bake(cube_mesh[0], BakeSettings(pins=PinNodes(np.empty(0, dtype=np.int64))))


@pytest.mark.parametrize("density", [0.0, -1.0, np.nan, np.inf, 1e6])
def test_a_density_that_no_solid_has_is_refused(density):
    with pytest.raises(PalpateError, match="density is"):
        replace(FREE, density=density).checked()


def test_a_request_for_no_pins_comes_back(cube_mesh, tmp_path):
    BakeRequest(cube_mesh[0], FREE).write(tmp_path)
    assert BakeRequest.read(tmp_path).settings == FREE


def planted(body, path, **arrays):
    """The body's file with other arrays, its checksum made to fit."""
    body_file.save(body, path)
    with np.load(path) as file:
        stored = {name: file[name] for name in file.files}
    stored |= {
        name: value if value is None else np.asarray(value) for name, value in arrays.items()
    }
    stored = {name: array for name, array in stored.items() if array is not None}
    stored["checksum"] = np.array(body_file._checksum(stored))
    np.savez(path, **stored)
    return path


@pytest.mark.parametrize(
    ("density", "said"),
    [(None, "density missing"), (np.array(np.nan), "density is nan"),
     (np.array(-3.0), "density is -3"), (np.array([1.0, 2.0]), "'density' is"),
     (np.array("much"), "'density' is")],
)  # fmt: skip
def test_a_free_body_from_a_file_needs_a_density_that_is_one(free_cube, tmp_path, density, said):
    path = planted(free_cube, tmp_path / "planted.npz", density=density)
    with pytest.raises(body_file.BodyFileError, match=said):
        body_file.load(path)


def test_a_pinned_bodys_compliance_does_not_pass_for_a_free_ones(cube, tmp_path):
    path = planted(cube, tmp_path / "planted.npz", fixed=np.empty(0, np.int64), density=1e3)
    with pytest.raises(body_file.BodyFileError, match="does not belong"):
        body_file.load(path)
