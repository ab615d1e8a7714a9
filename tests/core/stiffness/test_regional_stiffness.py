"""Regions painted on a surface, carried into its tetrahedra: bone in flesh."""

import numpy as np
import pytest
import trimesh

from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.read_mesh import read_tets
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.mesh.tetrahedralize import tetrahedralize
from palpate.core.mesh.winding_volume import is_inside
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.regions import StiffRegion, TetScale, young_scale
from palpate.core.stiffness.surface_parts import nested_parts

FLESH, BONE = 0.05, 0.02


def ball(radius, centre=(0, 0, 0)):
    made = trimesh.creation.icosphere(subdivisions=2, radius=radius)
    made.apply_translation(centre)
    return made


def surface_of(*meshes):
    joined = trimesh.util.concatenate(meshes)
    return Surface.checked(joined.vertices, joined.faces)


def weights_of(*parts):
    """One weight for all vertices of each part, given as (mesh, weight)."""
    return np.concatenate([np.full(len(mesh.vertices), float(weight)) for mesh, weight in parts])


@pytest.fixture(scope="module")
def bone_in_flesh(tmp_path_factory):
    """A ball with a smaller one inside, filled by fTetWild, and the weights that mark the bone."""
    outer, inner = ball(FLESH), ball(BONE)
    surface = surface_of(outer, inner)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("ftetwild"))  # it writes into the working directory
        mesh = tetrahedralize(surface, 0.1, 0.004)
    return mesh, surface, weights_of((outer, 0), (inner, 1))


@pytest.fixture(scope="module")
def solid_cube():
    """The paper's cube and its own surface, 1 m."""
    mesh, fixed = paper_cube(edge=1.0)
    return mesh, Surface(mesh.nodes, mesh.surface_triangles), fixed


def test_a_bone_stiffens_what_it_encloses_and_nothing_else(bone_in_flesh):
    mesh, surface, weights = bone_in_flesh
    scale = young_scale(StiffRegion(weights, 1000.0), mesh, surface)
    assert set(np.round(scale, 9)) == {1.0, 1000.0}
    bone = ball(BONE)
    assert mesh.tet_volumes[scale > 1].sum() == pytest.approx(bone.volume, rel=0.03)
    centres = mesh.nodes[mesh.tets].mean(axis=1)
    inside = is_inside(centres, Surface(bone.vertices, np.asarray(bone.faces)))
    np.testing.assert_array_equal(scale > 1, inside)


def test_tetrahedra_respect_the_bones_surface(bone_in_flesh):
    """None reaches to both sides by more than the envelope and the facets of the ball allow."""
    mesh, surface, _ = bone_in_flesh
    height = np.linalg.norm(mesh.nodes, axis=1)[mesh.tets] - BONE
    margin = 0.004 * surface.diagonal + 0.04 * BONE
    assert not ((height > margin).any(axis=1) & (height < -margin).any(axis=1)).any()


def test_flesh_over_bone_is_felt_firmer(bone_in_flesh):
    mesh, surface, weights = bone_in_flesh
    fixed = mesh.surface_nodes[mesh.nodes[mesh.surface_nodes, 2] < -0.8 * FLESH]
    scale = young_scale(StiffRegion(weights, 1000.0), mesh, surface)
    for formulation in ("linear", "smoothed"):
        soft, boned = (
            surface_compliance(
                mesh, assemble(mesh, 0.45, formulation=formulation, young_scale=chosen), fixed
            ).diagonal()
            for chosen in (None, scale)
        )
        ratio = np.trace(boned, axis1=1, axis2=2) / np.trace(soft, axis1=1, axis2=2)
        assert (ratio < 1).all()
        assert ratio.mean() < 0.97


def test_a_painted_gradient_is_even_in_ratio(solid_cube):
    mesh, surface, _ = solid_cube
    weights = surface.vertices[:, 0]  # 0 at x = 0, 1 at x = 1 m
    scale = young_scale(StiffRegion(weights, 16.0), mesh, surface)
    x = mesh.nodes[mesh.tets].mean(axis=1)
    # Where the nearest place is on a side along x, its weight is x itself.
    margin = np.minimum(x, 1 - x)
    along = margin[:, 0] > margin[:, 1:].min(axis=1) + 1e-9
    assert along.sum() > 100
    np.testing.assert_allclose(np.log2(scale[along]) / 4, x[along, 0], atol=1e-12)


@pytest.mark.parametrize(("weight", "factor"), [(0.0, 1000.0), (1.0, 7.0), (0.5, 4.0)])
def test_an_even_weight_scales_the_whole_body(solid_cube, weight, factor):
    mesh, surface, _ = solid_cube
    even = StiffRegion(np.full(len(surface.vertices), weight), factor)
    np.testing.assert_allclose(young_scale(even, mesh, surface), factor**weight, rtol=1e-12)


def test_parts_inside_parts_are_told_from_parts_beside_them():
    marrow, bone, flesh, other = ball(0.01), ball(BONE), ball(FLESH), ball(0.04, (0.2, 0, 0))
    surface = surface_of(flesh, marrow, other, bone)
    parts = nested_parts(surface)
    assert [len(part.triangles) for part in parts.inner] == [len(marrow.faces), len(bone.faces)]
    assert len(parts.outer) == len(flesh.faces) + len(other.faces)
    places = np.array([[0, 0, 0], [0.015, 0, 0], [0.03, 0, 0], [0.2, 0, 0]])
    assert parts.inner[0].encloses(places).tolist() == [True, False, False, False]
    assert parts.inner[1].encloses(places).tolist() == [True, True, False, False]


def test_the_tightest_part_around_a_place_decides():
    marrow, bone, flesh = ball(0.01), ball(BONE), ball(FLESH)
    surface = surface_of(flesh, bone, marrow)
    weights = weights_of((flesh, 0), (bone, 1), (marrow, 0.5))
    nodes = np.concatenate(
        [[[x, 0, 0], [x + 1e-3, 0, 0], [x, 1e-3, 0], [x, 0, 1e-3]] for x in (0, 0.015, 0.03)]
    )
    mesh = TetMesh.checked(nodes, np.arange(12).reshape(3, 4))
    scale = young_scale(StiffRegion(weights, 100.0), mesh, surface)
    np.testing.assert_allclose(scale, [10.0, 100.0, 1.0], rtol=1e-12)


def test_a_seam_does_not_cut_a_part_in_two():
    bone, flesh = ball(BONE), ball(FLESH)
    # Every triangle with vertices of its own, as files with normals or UVs have them.
    bone = trimesh.Trimesh(
        bone.vertices[bone.faces].reshape(-1, 3),
        np.arange(3 * len(bone.faces)).reshape(-1, 3),
        process=False,
    )
    parts = nested_parts(surface_of(flesh, bone))
    assert [len(part.triangles) for part in parts.inner] == [len(bone.faces)]


def test_factors_given_for_tetrahedra_are_taken_as_they_are(solid_cube, rng):
    mesh, _, _ = solid_cube
    values = rng.uniform(0.5, 2, len(mesh.tets))
    np.testing.assert_array_equal(young_scale(TetScale(values), mesh, None), values)
    with pytest.raises(PalpateError, match="shape"):
        young_scale(TetScale(values[1:]), mesh, None)


@pytest.mark.parametrize("factor", [0.0, -1.0, np.nan, np.inf, 1e7])
def test_impossible_factors_of_a_region_are_refused(solid_cube, factor):
    mesh, surface, _ = solid_cube
    with pytest.raises(PalpateError, match="factor"):
        young_scale(StiffRegion(np.ones(len(surface.vertices)), factor), mesh, surface)


def test_weights_must_fit_the_surface(solid_cube):
    mesh, surface, _ = solid_cube
    count = len(surface.vertices)
    with pytest.raises(PalpateError, match="one weight per vertex"):
        young_scale(StiffRegion(np.ones(count - 1), 2.0), mesh, surface)
    with pytest.raises(PalpateError, match="one weight per vertex"):
        young_scale(StiffRegion(np.ones(count), 2.0), mesh, None)
    for wrong in (1.5, -0.1, np.nan):
        with pytest.raises(PalpateError, match="between 0 and 1"):
            young_scale(StiffRegion(np.r_[np.ones(count - 1), wrong], 2.0), mesh, surface)


def test_files_of_tetrahedra_bring_their_factors(tmp_path, solid_cube, rng):
    mesh, _, fixed = solid_cube
    values = rng.uniform(0.5, 2, len(mesh.tets))
    np.savez(tmp_path / "with.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed, young_scale=values)
    read = read_tets(tmp_path / "with.npz")
    np.testing.assert_array_equal(read.young_scale, values)
    np.testing.assert_array_equal(read.fixed, fixed)
    np.savez(tmp_path / "without.npz", X=mesh.nodes, T=mesh.tets)
    assert read_tets(tmp_path / "without.npz").young_scale is None
    np.savez(tmp_path / "short.npz", X=mesh.nodes, T=mesh.tets, young_scale=values[1:])
    with pytest.raises(PalpateError, match=r"short\.npz: young_scale"):
        read_tets(tmp_path / "short.npz")
