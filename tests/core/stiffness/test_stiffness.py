import numpy as np
import pytest
import skfem
from skfem.models.elasticity import lame_parameters as referee_lame
from skfem.models.elasticity import linear_elasticity

from palpate.core.errors import PalpateError
from palpate.core.stiffness.assembly import assemble, shape_gradients


def referee_stiffness(mesh, poisson_ratio, young_modulus):
    """K by scikit-fem, its degrees of freedom renumbered to 3 * node + axis."""
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    basis = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=1)
    matrix = linear_elasticity(*referee_lame(young_modulus, poisson_ratio)).assemble(basis)
    order = basis.nodal_dofs.T.ravel()
    return matrix.tocsr()[order][:, order]


@pytest.mark.parametrize("name", ["cube_mesh", "mouse_mesh"])
@pytest.mark.parametrize(("poisson_ratio", "young_modulus"), [(0.3, 1.0), (0.49, 1e4), (0.0, 1e6)])
def test_stiffness_equals_an_independent_assembly(name, poisson_ratio, young_modulus, request):
    mesh, _ = request.getfixturevalue(name)
    ours = assemble(mesh, poisson_ratio, young_modulus)
    theirs = referee_stiffness(mesh, poisson_ratio, young_modulus)
    assert abs(ours - theirs).max() <= 1e-12 * abs(theirs).max()


def test_shape_functions_sum_to_one_everywhere(mouse_mesh):
    gradients = shape_gradients(mouse_mesh[0])
    assert np.abs(gradients.sum(axis=1)).max() < 1e-9 * np.abs(gradients).max()


@pytest.mark.parametrize(
    ("young_modulus", "poisson_ratio", "said"),
    [(0, 0.3, "Young"), (-1, 0.3, "Young"), (np.nan, 0.3, "Young"), (np.inf, 0.3, "Young"),
     (1, 0.5, "Poisson"), (1, -1, "Poisson"), (1, np.nan, "Poisson")],
)  # fmt: skip
def test_impossible_materials_are_refused(cube_mesh, young_modulus, poisson_ratio, said):
    with pytest.raises(PalpateError, match=said):
        assemble(cube_mesh[0], poisson_ratio, young_modulus)


def test_tetrahedra_of_different_moduli_add_up(mouse_mesh, rng):
    """By scikit-fem: Young's modulus as a field that is constant in each tetrahedron."""
    mesh, _ = mouse_mesh
    scale = 10.0 ** rng.uniform(-2, 2, len(mesh.tets))
    unit = referee_lame(1.0, 0.45)
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    basis = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=1)
    field = basis.with_element(skfem.ElementTetP0()).interpolate(scale)
    referee = skfem.BilinearForm(
        lambda u, v, w: w.modulus * linear_elasticity(*unit).form(u, v, w)
    ).assemble(basis, modulus=field)
    order = basis.nodal_dofs.T.ravel()
    theirs = referee.tocsr()[order][:, order]
    ours = assemble(mesh, 0.45, young_scale=scale)
    assert abs(ours - theirs).max() <= 1e-12 * abs(theirs).max()


@pytest.mark.parametrize(
    ("scale", "said"),
    [([1.0], "one real number for each"), (np.ones((320, 1)), "one real number for each"),
     (np.array(["1"] * 320), "one real number for each"), (np.zeros(320), "first: tetrahedron 0"),
     (np.r_[np.ones(319), np.nan], "tetrahedron 319 with nan"),
     (np.r_[np.ones(319), np.inf], "tetrahedron 319 with inf"),
     (np.r_[np.ones(319), -1.0], "tetrahedron 319 with -1"), (np.full(320, 1e7), "1e\\+06")],
)  # fmt: skip
def test_impossible_factors_on_the_modulus_are_refused(cube_mesh, scale, said):
    with pytest.raises(PalpateError, match=said):
        assemble(cube_mesh[0], 0.3, young_scale=scale)
