"""The drumstick: meat with a bone through it, and the stored tetrahedra that fill both."""

from pathlib import Path

import numpy as np
import pytest
from drumstick_shape import Part, bone, bone_vertices, drumstick, top_of_meat
from mouse_shape import QuadMesh

from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.regions import StiffRegion, young_scale

SCENES = Path(__file__).resolve().parents[2] / "sample_scenes"


@pytest.fixture(scope="module")
def shape() -> QuadMesh:
    return drumstick()


def surface_of(shape: QuadMesh, quads: np.ndarray) -> Surface:
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Surface.checked(shape.vertices, triangles)


def test_meat_and_bone_are_closed_and_wound_outward(shape: QuadMesh) -> None:
    for part in Part:
        surface = surface_of(shape, shape.quads[shape.part == part])
        assert surface.is_closed
        assert surface.signed_volume > 0


def test_the_bone_is_near_the_skin_where_the_meat_tapers_and_deep_where_it_is_thick() -> None:
    near, deep = bone(1e3 * np.array([top_of_meat(0.048), top_of_meat(-0.02)]))
    assert 4.0 < near < 8.0
    assert deep > 18.0


@pytest.mark.at_length
def test_the_bone_takes_up_its_volume_of_the_stored_tetrahedra(shape: QuadMesh) -> None:
    with np.load(SCENES / "drumstick-tets.npz", allow_pickle=False) as file:
        mesh, fixed = TetMesh.checked(file["X"], file["T"]), file["fixed"]
    assert mesh.nodes[fixed, 2].max() < 0.003
    weights = np.zeros(len(shape.vertices))
    weights[bone_vertices(shape)] = 1.0
    scale = young_scale(StiffRegion(weights, 1000.0), mesh, surface_of(shape, shape.quads))
    bone_volume = surface_of(shape, shape.quads[shape.part == Part.BONE]).signed_volume
    stiff = mesh.tet_volumes[scale > 500].sum()
    assert stiff == pytest.approx(bone_volume, rel=0.25)
