import numpy as np
import pytest

from palpate.core.compliance.compression.clusters import cluster_nodes
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble


def exact_compliance(mesh, fixed, poisson_ratio=0.3):
    stiffness = assemble(mesh, poisson_ratio)
    return surface_compliance(mesh, stiffness, fixed, dtype=np.float64)


def stretched(cells, stretch):
    """A block of the paper's cube, stretched along its axes."""
    mesh, fixed = paper_cube(0.05, cells)
    return TetMesh.checked(mesh.nodes * np.array(stretch), mesh.tets), fixed


def two_pieces():
    mesh, fixed = paper_cube(0.05, 6)
    count = len(mesh.nodes)
    both = TetMesh.checked(
        np.vstack([mesh.nodes, 0.5 * mesh.nodes + np.array([0.06, 0, 0])]),
        np.vstack([mesh.tets, mesh.tets + count]),
    )
    return both, np.concatenate([fixed, fixed + count])


def held_from_below():
    """A pad on a table: forces are felt near by only, and norms differ from node to node."""
    mesh, _ = stretched(9, (1, 1, 0.1))
    return mesh, np.flatnonzero(mesh.nodes[:, 2] == 0.0)


def pinned_here_and_there():
    mesh, _ = stretched(8, (1, 1, 1))
    rng = np.random.default_rng(0)
    return mesh, rng.choice(mesh.surface_nodes, len(mesh.surface_nodes) // 3, replace=False)


def without_pins(stretch):
    mesh, _ = stretched(7, stretch)
    return mesh, np.empty(0, dtype=np.int64)


BODIES = {
    "held from below": held_from_below,
    "pinned here and there": pinned_here_and_there,
    "block": lambda: stretched(7, (1, 1, 1)),
    "bar on its side": lambda: stretched(7, (5, 1, 1)),
    "thin plate": lambda: stretched(7, (1, 1, 0.03)),
    "two pieces": two_pieces,
    "free block": lambda: without_pins((1, 1, 1)),
    "free bar": lambda: without_pins((5, 1, 1)),
    "a few nodes": lambda: stretched(2, (1, 1, 1)),
    "one cell": lambda: stretched(1, (1, 1, 1)),
}


@pytest.fixture(scope="module", params=BODIES)
def any_body(request):
    mesh, fixed = BODIES[request.param]()
    exact = exact_compliance(mesh, fixed)
    return exact, mesh.nodes[exact.free_surface]


@pytest.fixture(scope="module")
def mouse_both(mouse_mesh):
    mesh, fixed = mouse_mesh
    exact = exact_compliance(mesh, fixed)
    return exact, compress(exact, mesh.nodes[exact.free_surface], 1e-3)


def relative_column_errors(compressed, exact):
    everything = np.arange(exact.node_count)
    expected = exact.columns(everything)
    found = compressed.columns(everything)
    return np.linalg.norm(found - expected, axis=0) / np.linalg.norm(expected, axis=0)


@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-3, 3e-4, 1e-4, 1e-6])
def test_no_column_is_off_by_more_than_the_tolerance(any_body, tolerance):
    exact, positions = any_body
    compressed = compress(exact, positions, tolerance)
    worst = relative_column_errors(compressed, exact).max()
    assert worst <= compressed.column_error <= tolerance


@pytest.mark.at_length
def test_near_the_incompressible_limit_the_tolerance_holds_too(mouse_mesh):
    mesh, fixed = mouse_mesh
    exact = exact_compliance(mesh, fixed, 0.49)
    compressed = compress(exact, mesh.nodes[exact.free_surface], 1e-3)
    assert relative_column_errors(compressed, exact).max() <= 1e-3


@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 3e-4, 1e-6])
def test_parts_a_million_times_softer_are_compressed_too(tolerance):
    mesh, fixed = stretched(8, (2, 1, 1))
    soft = mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.05
    stiffness = assemble(mesh, 0.3, young_scale=np.where(soft, 1e-6, 1.0))
    exact = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
    compressed = compress(exact, mesh.nodes[exact.free_surface], tolerance)
    worst = relative_column_errors(compressed, exact).max()
    assert worst <= compressed.column_error <= tolerance
    assert compressed.nbytes < 0.8 * exact.nbytes / 2  # of float32; whole blocks are stored once


@pytest.mark.parametrize("body", ["block", "held from below", "pinned here and there"])
def test_the_first_pass_is_enough(body):
    mesh, fixed = BODIES[body]()
    exact = exact_compliance(mesh, fixed)
    passes = []

    def counting(task, numbers):
        passes.append(task)
        return map(task, numbers)

    compress(exact, mesh.nodes[exact.free_surface], 1e-3, map_clusters=counting)
    assert len(passes) == 1


def test_columns_that_are_not_finite_are_refused():
    mesh, fixed = stretched(3, (1, 1, 1))
    exact = exact_compliance(mesh, fixed)
    exact.table[5, 1, 7] = np.nan
    with pytest.raises(PalpateError, match="not finite"):
        compress(exact, mesh.nodes[exact.free_surface], 1e-3)


def test_columns_equal_a_sparse_solve_within_the_tolerance(mouse, mouse_both, solved_displacements):
    _, compressed = mouse_both
    for node in (3, 500, 980):
        forces = np.zeros_like(mouse.mesh.nodes)
        forces[compressed.free_surface[node]] = mouse.young_modulus * np.array([1, -2, 3])
        expected = solved_displacements(mouse, forces)[compressed.free_surface]
        ours = (compressed.columns(np.array([node])) @ [1, -2, 3]).reshape(-1, 3)
        assert np.linalg.norm(ours - expected) < 3e-3 * np.linalg.norm(expected)


def test_the_mouse_takes_a_tenth_of_its_dense_form(mouse_both):
    exact, compressed = mouse_both
    assert compressed.nbytes < exact.nbytes / 2 / 10  # in float32


def test_a_looser_tolerance_takes_less(any_body):
    exact, positions = any_body
    sizes = [compress(exact, positions, tolerance).nbytes for tolerance in (1e-4, 1e-3, 1e-2)]
    assert sizes == sorted(sizes, reverse=True)


def test_the_columns_of_a_cluster_are_asked_for_once(mouse_both, mouse_mesh):
    exact, _ = mouse_both
    asked = []

    class Counting:
        free_surface = exact.free_surface
        node_count = exact.node_count

        def columns(self, nodes):
            asked.append(nodes)
            return exact.columns(nodes)

        def diagonal(self):
            return exact.diagonal()

    compress(Counting(), mouse_mesh[0].nodes[exact.free_surface], 1e-3)
    sketch, *clusters = asked
    assert len(sketch) == len(clusters)  # one node of each
    assert sorted(np.concatenate(clusters)) == list(range(exact.node_count))


def test_the_clusters_can_be_worked_on_elsewhere(mouse_both, mouse_mesh):
    exact, compressed = mouse_both

    def backwards(task, numbers):
        results = {number: task(number) for number in reversed(numbers)}
        return [results[number] for number in numbers]

    positions = mouse_mesh[0].nodes[exact.free_surface]
    other = compress(exact, positions, 1e-3, map_clusters=backwards)
    for name, array in compressed.arrays().items():
        np.testing.assert_array_equal(other.arrays()[name], array)


def test_progress_only_grows_and_can_cancel(any_body):
    exact, positions = any_body
    shares = []
    compress(exact, positions, 1e-3, shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0

    def stop(_share):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        compress(exact, positions, 1e-3, stop)


@pytest.mark.parametrize("tolerance", [0.0, -1e-3, 1e-7, 0.5, np.nan, np.inf])
def test_a_tolerance_without_sense_is_refused(tolerance):
    mesh, fixed = stretched(1, (1, 1, 1))
    exact = exact_compliance(mesh, fixed)
    with pytest.raises(PalpateError, match="tolerance"):
        compress(exact, mesh.nodes[exact.free_surface], tolerance)


@pytest.mark.parametrize("count", [1, 32, 33, 500])
def test_clusters_are_a_partition_of_equal_parts(rng, count):
    clusters = cluster_nodes(rng.normal(size=(count, 3)))
    assert sorted(np.concatenate(clusters.members)) == list(range(count))
    sizes = [len(nodes) for nodes in clusters.members]
    assert max(sizes) <= 32
    assert max(sizes) - min(sizes) <= 2
    assert clusters.near.diagonal().all()
    assert (clusters.near == clusters.near.T).all()


def test_nodes_in_one_place_can_be_clustered():
    assert cluster_nodes(np.zeros((100, 3))).count == 4
