"""What is one body has one key, and bodies from before this was so are still read."""

import hashlib
from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_key import body_key, is_key_of
from palpate.core.mesh.tet_mesh import TetMesh

# Of the paper's cube, as first released.
CUBE_KEY = "acd1757aa607f98f2d54b0e8c9aa9b0306671bd61eddb1e179dd8f7c003bb070"


def with_minus_zeros(mesh):
    return TetMesh.checked(np.where(mesh.nodes == 0.0, -0.0, mesh.nodes), mesh.tets)


def digest_of_bytes(body):
    """The key as it was first defined."""
    digest = hashlib.sha256(b"palpate-body 1")
    for array, kind in (
        (body.mesh.nodes, "<f8"),
        (body.mesh.tets, "<i8"),
        (body.fixed, "<i8"),
        (np.float64(body.poisson_ratio), "<f8"),
    ):
        digest.update(array.astype(kind).tobytes())
    if body.formulation != "linear":
        digest.update(f"formulation {body.formulation}".encode())
    if body.young_scale is not None:
        digest.update(b"young scale" + body.young_scale.astype("<f8").tobytes())
    return digest.hexdigest()


def test_keys_stay_what_they_were(cube_mesh):
    mesh, fixed = cube_mesh
    assert body_key(mesh, fixed, 0.49) == CUBE_KEY


def test_minus_zero_is_zero(cube_mesh):
    mesh, fixed = cube_mesh
    other = with_minus_zeros(mesh)
    assert np.signbit(other.nodes).any()
    assert body_key(other, fixed, 0.49) == body_key(mesh, fixed, 0.49)


def test_a_factor_of_one_everywhere_is_none(cube_mesh):
    mesh, fixed = cube_mesh
    ones = np.ones(len(mesh.tets))
    assert body_key(mesh, fixed, 0.49, young_scale=ones) == body_key(mesh, fixed, 0.49)
    ones[3] = 2.0
    assert body_key(mesh, fixed, 0.49, young_scale=ones) != body_key(mesh, fixed, 0.49)


def test_another_body_has_another_key(cube_mesh):
    mesh, fixed = cube_mesh
    key = body_key(mesh, fixed, 0.49)
    assert is_key_of(key, mesh, fixed, 0.49)
    assert not is_key_of(key, mesh, fixed, 0.48)
    assert not is_key_of(key, mesh, fixed[1:], 0.49)


@pytest.mark.parametrize("ones", [False, True])
def test_files_with_the_older_key_are_read_and_keep_it(cube, tmp_path, ones):
    mesh = with_minus_zeros(cube.mesh)
    scale = np.ones(len(mesh.tets)) if ones else None
    body = replace(cube, mesh=mesh, young_scale=scale)
    # As such a file was written: the key of the bytes as they are.
    older = digest_of_bytes(body)
    assert older != body.key
    body_file.save(replace(body, older_key=older), tmp_path / "old.npz")
    read = body_file.load(tmp_path / "old.npz")
    assert read.key == older
    body_file.save(read, tmp_path / "again.npz")
    assert body_file.load(tmp_path / "again.npz").key == older
    assert body_file.load(tmp_path / "old.npz").mesh.nodes.tobytes() == mesh.nodes.tobytes()
