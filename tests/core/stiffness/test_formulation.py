"""The smoothed formulation beside the linear one: the same laws, and no locking."""

import numpy as np
import pytest
import skfem
from scipy.sparse import block_array, kron
from scipy.sparse.linalg import eigsh, splu
from scipy.spatial import Delaunay
from skfem.helpers import ddot, div, dot, sym_grad
from skfem.models.elasticity import linear_elasticity

from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh, signed_volumes
from palpate.core.stiffness.assembly import assemble, lame_parameters, shape_gradients
from palpate.core.stiffness.formulation import FORMULATIONS

POISSON_RATIOS = [-0.9, -0.3, 0.0, 0.3, 0.49, 0.4999]

both_formulations = pytest.mark.parametrize("formulation", FORMULATIONS)


def jumbled(grid):
    """Nodes of a grid moved a little, within the faces they lie on, and joined anew."""
    nodes, highest = grid.nodes.copy(), grid.nodes.max(axis=0)
    shifts = np.random.default_rng(4).uniform(-0.25, 0.25, nodes.shape)
    spacing = np.diff(np.unique(nodes[:, 2])).min()
    nodes += np.where((nodes == 0) | (nodes == highest), 0.0, spacing * shifts)
    tets = Delaunay(nodes).simplices
    volumes = signed_volumes(nodes, tets)
    tets = np.where((volumes < 0)[:, None], tets[:, [0, 1, 3, 2]], tets)
    return TetMesh.checked(nodes, tets[np.abs(volumes) > 1e-4 * spacing**3])


@pytest.fixture(scope="module")
def jumbled_mesh():
    """A unit cube of 125 nodes that lie on no grid."""
    return jumbled(paper_cube(edge=1.0)[0])


@pytest.fixture(scope="module")
def beam():
    """A bar of about 3 x 3 x 12 cells, 0.25 x 0.25 x 1 m, held where z = 0."""
    cube, _ = paper_cube(edge=1.0, cells=12)
    inside = (cube.nodes[cube.tets].mean(axis=1)[:, :2] < 0.25).all(axis=1)
    used, renumbered = np.unique(cube.tets[inside], return_inverse=True)
    mesh = jumbled(TetMesh.checked(cube.nodes[used], renumbered.reshape(-1, 4)))
    return mesh, np.flatnonzero(mesh.nodes[:, 2] == 0)


def solved(K, held, force):
    """Displacements of all degrees of freedom, those in the mask ``held`` zero."""
    u = np.zeros(len(held))
    free = np.flatnonzero(~held)
    u[free] = splu(K[free][:, free].tocsc()).solve(force.ravel()[free])
    return u


def energy_by_loops(mesh, poisson_ratio, scale, u):
    """Strain energy straight from the definition of selective smoothing, domain by domain."""
    first_lame, shear = lame_parameters(1.0, poisson_ratio)
    edges, nodes = {}, {}
    for tet, corners in enumerate(mesh.tets):
        for place, a in enumerate(corners):
            nodes.setdefault(a, []).append(tet)
            for b in corners[place + 1 :]:
                edges.setdefault((min(a, b), max(a, b)), []).append(tet)
    gradient = np.einsum("tai,taj->tij", u[mesh.tets], shape_gradients(mesh))

    def total(domains, share, density):
        found = 0.0
        for around in domains.values():
            for modulus in {scale[tet] for tet in around}:
                alike = [tet for tet in around if scale[tet] == modulus]
                volume = mesh.tet_volumes[alike] * share
                mean = np.einsum("t,tij->ij", volume, gradient[alike]) / volume.sum()
                found += volume.sum() * modulus * density(0.5 * (mean + mean.T))
        return found

    def shear_density(strain):
        return shear * (strain**2).sum()

    def volume_density(strain):
        return 0.5 * first_lame * np.trace(strain) ** 2

    volumes_over = (edges, 1 / 6) if first_lame < 0 else (nodes, 1 / 4)
    return total(edges, 1 / 6, shear_density) + total(*volumes_over, volume_density)


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
@pytest.mark.parametrize("with_bone", [False, True])
def test_smoothed_energy_is_that_of_its_definition(jumbled_mesh, poisson_ratio, with_bone, rng):
    scale = np.ones(len(jumbled_mesh.tets))
    if with_bone:
        scale[jumbled_mesh.nodes[jumbled_mesh.tets].mean(axis=1)[:, 0] > 0.5] = 300.0
    K = assemble(jumbled_mesh, poisson_ratio, formulation="smoothed", young_scale=scale)
    for _ in range(3):
        u = rng.normal(size=jumbled_mesh.nodes.shape)
        expected = energy_by_loops(jumbled_mesh, poisson_ratio, scale, u)
        assert 0.5 * u.ravel() @ (K @ u.ravel()) == pytest.approx(expected, rel=1e-11)


@both_formulations
@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
def test_only_the_six_rigid_motions_cost_nothing(jumbled_mesh, formulation, poisson_ratio):
    K = assemble(jumbled_mesh, poisson_ratio, formulation=formulation)
    assert abs(K - K.T).max() == 0
    values = np.linalg.eigvalsh(K.toarray())
    assert np.abs(values[:6]).max() < 1e-12 * values[-1]
    # The softest strain there is changes volume or shape; neither may come for nothing.
    first_lame, shear = lame_parameters(1.0, poisson_ratio)
    assert values[6] > 1e-3 * min(shear, first_lame + 2 * shear / 3)


@both_formulations
@pytest.mark.parametrize("poisson_ratio", [-0.3, 0.3, 0.4999])
def test_uniform_strain_is_exact(jumbled_mesh, formulation, poisson_ratio, rng):
    """Patch test: balance inside, and the energy of the continuum."""
    mesh = jumbled_mesh
    K = assemble(mesh, poisson_ratio, formulation=formulation)
    gradient = rng.normal(size=(3, 3))
    u = mesh.nodes @ gradient.T
    force = (K @ u.ravel()).reshape(-1, 3)
    interior = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    assert np.abs(force[interior]).max() < 1e-12 * np.abs(force).max()
    first_lame, shear = lame_parameters(1.0, poisson_ratio)
    strain = 0.5 * (gradient + gradient.T)
    density = shear * (strain**2).sum() + 0.5 * first_lame * np.trace(strain) ** 2
    assert 0.5 * (u * force).sum() == pytest.approx(mesh.volume * density, rel=1e-11)


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
def test_smoothing_never_stiffens(mouse_mesh, poisson_ratio, rng):
    """The mean of a strain has less energy than the strain."""
    mesh, _ = mouse_mesh
    plain = assemble(mesh, poisson_ratio)
    smoothed = assemble(mesh, poisson_ratio, formulation="smoothed")
    for u in rng.normal(size=(10, plain.shape[0])):
        assert 0 < u @ (smoothed @ u) <= u @ (plain @ u)


def tip_deflection(K, mesh, fixed):
    """Mean sideways deflection of the end of a bar under 1 N spread over it."""
    end = np.flatnonzero(mesh.nodes[:, 2] == mesh.nodes[:, 2].max())
    triangles = mesh.surface_triangles[np.isin(mesh.surface_triangles, end).all(axis=1)]
    corners = mesh.nodes[triangles]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    force = np.zeros(mesh.nodes.shape)
    np.add.at(force[:, 0], triangles.ravel(), np.repeat(areas / areas.sum() / 3, 3))
    held = np.zeros(force.shape, dtype=bool)
    held[fixed] = True
    return float(solved(K, held.ravel(), force) @ force.ravel())


def referee_tip_deflection(mesh, poisson_ratio):
    """The same by scikit-fem with quadratic displacements and a linear pressure (Taylor-Hood)."""
    first_lame, shear = lame_parameters(1.0, poisson_ratio)
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    quadratic = skfem.ElementVector(skfem.ElementTetP2())
    basis = skfem.Basis(tets, quadratic, intorder=3)
    pressures = basis.with_element(skfem.ElementTetP1())
    A = skfem.BilinearForm(lambda u, v, _: 2 * shear * ddot(sym_grad(u), sym_grad(v)))
    B = skfem.BilinearForm(lambda u, q, _: div(u) * q)
    C = skfem.BilinearForm(lambda p, q, _: p * q / first_lame)
    length = mesh.nodes[:, 2].max()
    end = skfem.FacetBasis(
        tets, quadratic, facets=tets.facets_satisfying(lambda x: x[2] > length - 1e-9), intorder=3
    )
    area = mesh.nodes[:, 0].max() * mesh.nodes[:, 1].max()
    force = skfem.LinearForm(lambda v, _: v[0] / area).assemble(end)
    held = basis.get_dofs(lambda x: x[2] < 1e-9).all()
    free = np.setdiff1d(np.arange(basis.N), held)
    coupling = B.assemble(basis, pressures).tocsc()[:, free]
    system = block_array(
        [[A.assemble(basis).tocsc()[free][:, free], coupling.T],
         [coupling, -C.assemble(pressures)]], format="csc",
    )  # fmt: skip
    solution = splu(system).solve(np.concatenate([force[free], np.zeros(pressures.N)]))
    return float(solution[: len(free)] @ force[free])


@pytest.mark.parametrize(
    ("poisson_ratio", "linear_bends_less_than"), [(0.3, 0.75), (0.49, 0.4), (0.4999, 0.1)]
)
def test_a_bar_that_locks_when_linear_bends_when_smoothed(
    beam, poisson_ratio, linear_bends_less_than
):
    truth = referee_tip_deflection(beam[0], poisson_ratio)
    linear = tip_deflection(assemble(beam[0], poisson_ratio), *beam)
    smoothed = tip_deflection(assemble(beam[0], poisson_ratio, formulation="smoothed"), *beam)
    assert linear < linear_bends_less_than * truth
    assert smoothed == pytest.approx(truth, rel=0.12)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.49])
def test_smoothing_adds_no_soft_vibration(jumbled_mesh, poisson_ratio):
    """Vibrations of a held body are those that quadratic elements have."""
    mesh, fixed = jumbled_mesh, np.flatnonzero(jumbled_mesh.nodes[:, 2] == 0)
    K = assemble(mesh, poisson_ratio, formulation="smoothed")
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    dofs = (3 * free[:, None] + np.arange(3)).ravel()
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    scalar = skfem.Basis(tets, skfem.ElementTetP1(), intorder=2)
    mass = kron(skfem.BilinearForm(lambda u, v, _: u * v).assemble(scalar), np.eye(3), "csr")
    ours = lowest_vibrations(K[dofs][:, dofs], mass[dofs][:, dofs])

    basis = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP2()), intorder=4)
    pinned = np.isin(np.arange(len(mesh.nodes)), fixed)
    held = [basis.nodal_dofs[:, pinned], basis.edge_dofs[:, pinned[tets.edges].all(axis=0)]]
    kept = np.setdiff1d(np.arange(basis.N), np.concatenate([part.ravel() for part in held]))
    quadratic = linear_elasticity(*lame_parameters(1.0, poisson_ratio)).assemble(basis)
    mass = skfem.BilinearForm(lambda u, v, _: dot(u, v)).assemble(basis)
    theirs = lowest_vibrations(quadratic[kept][:, kept], mass[kept][:, kept])
    assert (ours / theirs > 0.99).all()
    assert (ours / theirs < 1.1).all()


def lowest_vibrations(K, M):
    """The twelve smallest eigenvalues."""
    start = np.ones(K.shape[0])
    found = eigsh(K.tocsc(), 12, M.tocsc(), sigma=0, v0=start, return_eigenvectors=False)
    return np.sort(found)


def layers(mesh, axis, stiff):
    """Factors on Young's modulus: ``stiff`` beyond the middle along the axis, else 1."""
    middle = 0.5 * mesh.nodes[:, axis].max()
    return np.where(mesh.nodes[mesh.tets].mean(axis=1)[:, axis] > middle, stiff, 1.0)


@both_formulations
@pytest.mark.parametrize("stiff", [5.0, 1000.0])
def test_layers_one_after_another_add_their_compliances(formulation, stiff):
    """A laterally confined column: each half compresses by its own modulus, exactly."""
    mesh, fixed = paper_cube(edge=1.0)
    scale = layers(mesh, 2, stiff)
    K = assemble(mesh, 0.49, formulation=formulation, young_scale=scale)
    top = mesh.nodes[:, 2] == 1
    held = np.ones(mesh.nodes.shape, dtype=bool)
    held[:, 2] = np.isin(np.arange(len(mesh.nodes)), fixed)
    first_lame, shear = lame_parameters(1.0, 0.49)
    confined = first_lame + 2 * shear
    z = mesh.nodes[:, 2]
    expected = (np.minimum(z, 0.5) + np.maximum(z - 0.5, 0) / stiff) / confined
    # The force that such a column carries, from the end's own share of the matrix.
    u = np.zeros(mesh.nodes.shape)
    u[:, 2] = expected
    force = (K @ u.ravel()).reshape(-1, 3)
    assert force[top, 2].sum() == pytest.approx(1.0, rel=1e-10)
    between = (z > 0) & (z < 1)
    assert np.abs(force[between, 2]).max() < 1e-10
    np.testing.assert_allclose(solved(K, held.ravel(), force), u.ravel(), atol=1e-10)


@both_formulations
@pytest.mark.parametrize("stiff", [5.0, 1000.0])
def test_layers_side_by_side_add_their_stiffnesses(formulation, stiff):
    """Stretched together, with the same Poisson's ratio: one uniform strain, two stresses."""
    mesh, _ = paper_cube(edge=1.0)
    K = assemble(mesh, 0.49, formulation=formulation, young_scale=layers(mesh, 0, stiff))
    u = mesh.nodes * [-0.49, -0.49, 1.0]
    force = (K @ u.ravel()).reshape(-1, 3)
    top, bottom = mesh.nodes[:, 2] == 1, mesh.nodes[:, 2] == 0
    assert force[top, 2].sum() == pytest.approx(0.5 * (1 + stiff), rel=1e-10)
    assert np.abs(force[~(top | bottom)]).max() < 1e-10 * stiff


@both_formulations
@pytest.mark.parametrize("poisson_ratio", [-0.9, 0.4999, 0.49999])
@pytest.mark.parametrize("stiff", [1e-6, 1.0, 1e6])
def test_the_compliance_stays_accurate_in_extreme_materials(
    jumbled_mesh, formulation, poisson_ratio, stiff
):
    """Against a sparse solve that is refined until nothing changes."""
    mesh = jumbled_mesh
    fixed = np.flatnonzero(mesh.nodes[:, 2] == 0)
    scale = layers(mesh, 0, stiff)
    K = assemble(mesh, poisson_ratio, formulation=formulation, young_scale=scale)
    ours = surface_compliance(mesh, K, fixed, dtype=np.float64)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    dofs = (3 * free[:, None] + np.arange(3)).ravel()
    inner = K[dofs][:, dofs].tocsc()
    loaded = np.array([0, ours.node_count // 2, ours.node_count - 1])
    places = np.searchsorted(free, ours.free_surface)
    rows = (3 * places[:, None] + np.arange(3)).ravel()
    loads = np.zeros((len(dofs), 9))
    loads[(3 * places[loaded][:, None] + np.arange(3)).ravel(), np.arange(9)] = 1.0
    factor = splu(inner)
    truth = factor.solve(loads)
    for _ in range(3):
        truth += factor.solve(loads - inner @ truth)
    errors = np.linalg.norm(ours.columns(loaded) - truth[rows], axis=0)
    assert (errors < 1e-7 * np.linalg.norm(truth[rows], axis=0)).all()


def test_unknown_formulations_are_refused(cube_mesh):
    with pytest.raises(PalpateError, match="'quadratic'; choose smoothed or linear"):
        assemble(cube_mesh[0], 0.3, formulation="quadratic")
