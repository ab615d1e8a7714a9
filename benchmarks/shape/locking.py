"""How far the formulations are from quadratic elements, and what they cost.

    python benchmarks/shape/locking.py [--quick] [--picture docs/images/locking.png]

A cantilever, the paper's cube pressed on a patch, and the stored mouse pressed in many places, for
Poisson's ratios up to 0.49999, beside quadratic elements by scikit-fem. Then a stiff ball in a soft
one, and time and memory of the bake. Besides the two formulations of the product there are
combinations that were left out, to show why:

- nodal: shear in each tetrahedron, volume averaged around nodes (averaged nodal pressure);
- edges: both averaged around edges;
- nodes: both averaged around nodes.

``--quick`` leaves out the bake of ``mouse-20k``.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, csr_array, kron
from scipy.sparse.linalg import eigsh, splu
from scipy.spatial import Delaunay

from palpate.benchmarks.measuring.bodies import MeasuredBody, stored_body
from palpate.benchmarks.measuring.shape.quadratic_reference import QuadraticReference
from palpate.benchmarks.measuring.timing import seconds_of
from palpate.core.compliance.elimination.plan import plan_surface_inverse
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh, signed_volumes
from palpate.core.stiffness import strain_smoothing
from palpate.core.stiffness.assembly import assemble, isotropic, lame_parameters, shape_gradients
from palpate.core.stiffness.formulation import FORMULATIONS, LINEAR, SMOOTHED
from palpate.core.stiffness.freedoms import freedoms
from palpate.core.stiffness.strain_smoothing import (
    SmoothingDomains,
    edge_domains,
    gradient_products,
    node_domains,
    tet_domains,
)

POISSON_RATIOS = (-0.3, 0.0, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999)
PRESSES = 40
VIBRATIONS = 20


def around_tets(mesh: TetMesh) -> SmoothingDomains:
    """No smoothing."""
    return tet_domains(mesh.tet_volumes, np.ones(len(mesh.tets)))


def around_edges(mesh: TetMesh) -> SmoothingDomains:
    """Smoothing around edges."""
    return edge_domains(mesh.tets, mesh.tet_volumes, np.ones(len(mesh.tets)))


def around_nodes(mesh: TetMesh) -> SmoothingDomains:
    """Smoothing around nodes."""
    return node_domains(mesh.tets, mesh.tet_volumes, np.ones(len(mesh.tets)))


Domains = Callable[[TetMesh], SmoothingDomains]
LEFT_OUT: dict[str, tuple[Domains, Domains]] = {
    "nodal": (around_tets, around_nodes),
    "edges": (around_edges, around_edges),
    "nodes": (around_nodes, around_nodes),
}
COLUMNS = (*FORMULATIONS, *LEFT_OUT)


def stiffness(mesh: TetMesh, poisson_ratio: float, name: str) -> csr_array:
    """K of a formulation of the product or of one that was left out."""
    if name in FORMULATIONS:
        return assemble(mesh, poisson_ratio, formulation=name)
    first_lame, shear = lame_parameters(1.0, poisson_ratio)
    gradients = shape_gradients(mesh)
    of_shear, of_volume = (
        gradient_products(domains(mesh), mesh.tets, gradients) for domains in LEFT_OUT[name]
    )
    return csr_array(isotropic(of_shear, 0.0, shear) + first_lame * of_volume)


def grid_bar(cells: tuple[int, int, int]) -> TetMesh:
    """Bar of unit cells, each cut into six tetrahedra around the same diagonal."""
    corners = np.stack(np.indices([count + 1 for count in cells]), axis=-1)
    strides = np.array([(cells[1] + 1) * (cells[2] + 1), cells[2] + 1, 1])
    first = np.stack(np.indices(cells), axis=-1).reshape(-1, 3) @ strides
    tets = []
    for path in itertools.permutations(strides):
        steps = np.concatenate([[0], np.cumsum(path)])
        tets.append(first[:, None] + steps)
    return wound(corners.reshape(-1, 3).astype(np.float64), np.concatenate(tets))


def jumbled(grid: TetMesh, spacing: float) -> TetMesh:
    """Nodes of a grid moved by up to a quarter of the spacing within their faces, joined anew."""
    nodes, highest = grid.nodes.copy(), grid.nodes.max(axis=0)
    shifts = np.random.default_rng(4).uniform(-0.25, 0.25, nodes.shape)
    nodes += np.where((nodes == 0) | (nodes == highest), 0.0, spacing * shifts)
    tets = Delaunay(nodes).simplices.astype(np.int64)
    return wound(nodes, tets[np.abs(signed_volumes(nodes, tets)) > 1e-4 * spacing**3])


def wound(nodes: NDArray[np.float64], tets: NDArray[np.int64]) -> TetMesh:
    """The same tetrahedra, all positively oriented."""
    inverted = signed_volumes(nodes, tets) < 0
    return TetMesh.checked(nodes, np.where(inverted[:, None], tets[:, [0, 1, 3, 2]], tets))


@dataclass(frozen=True, eq=False)
class Trial:
    """A body, where it is held, and tractions (k, N, 3) on its surface."""

    name: str
    mesh: TetMesh
    held: NDArray[np.int64]
    tractions: NDArray[np.float64]
    refinements: int = 0

    @property
    def free(self) -> NDArray[np.int64]:
        """Nodes that may move."""
        return np.setdiff1d(np.arange(len(self.mesh.nodes)), self.held)

    @property
    def dofs(self) -> NDArray[np.int64]:
        """Their degrees of freedom."""
        return freedoms(self.free)

    def solved(self, K: csr_array, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (k, N, 3) under nodal forces (k, N, 3)."""
        moved = np.zeros((len(self.held) * 3 + len(self.dofs), len(forces)))
        moved[self.dofs] = self.factor(K).solve(forces.reshape(len(forces), -1).T[self.dofs])
        return moved.T.reshape(forces.shape)

    def factor(self, K: csr_array) -> object:
        """SuperLU's factor of the stiffness of the free nodes."""
        return splu(
            csc_array(K[self.dofs][:, self.dofs]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )


def cantilevers() -> list[Trial]:
    """Three cells thick and five times as long, pulled sideways at the end."""
    bar = grid_bar((3, 3, 15))
    trials = []
    for name, mesh in (("cantilever, grid", bar), ("cantilever, Delaunay", jumbled(bar, 1.0))):
        sideways = np.zeros((1, len(mesh.nodes), 3))
        sideways[0, mesh.nodes[:, 2] == 15.0, 0] = 1.0
        # Between the last nodes of the sides and the end itself the traction fades; both take it.
        trials.append(Trial(name, mesh, np.flatnonzero(mesh.nodes[:, 2] == 0), sideways))
    return trials


def pressed_cubes() -> list[Trial]:
    """The paper's cube under a smooth load on a patch of 40 mm across in the middle of its top."""
    paper, finer = paper_cube()[0], paper_cube(cells=8)[0]
    cubes = (
        ("cube of the paper", paper, 1),
        ("cube, 8 cells", finer, 0),
        ("cube, Delaunay", jumbled(paper, 0.0125), 1),
    )
    trials = []
    for name, mesh, refinements in cubes:
        away = np.hypot(*(mesh.nodes[:, :2].T - 0.025)) / 0.02
        pressure = np.where(mesh.nodes[:, 2] == 0.05, np.maximum(0.0, 1 - away**2) ** 2, 0.0)
        down = pressure[None, :, None] * np.array([0.0, 0.0, -1.0])
        held = np.flatnonzero(mesh.nodes[:, 2] == 0)
        trials.append(Trial(name, mesh, held, down, refinements))
    return trials


def pressed_mouse() -> Trial:
    """The stored mouse, pressed inward at scattered nodes by loads that fade to the next ones."""
    body = stored_body("mouse-1.7k")
    normals = np.zeros(body.mesh.nodes.shape)
    i, j, k = (body.mesh.nodes[body.mesh.surface_triangles[:, corner]] for corner in range(3))
    np.add.at(normals, body.mesh.surface_triangles, np.cross(j - i, k - i)[:, None])
    free_surface = np.setdiff1d(body.mesh.surface_nodes, body.fixed)
    pressed = np.random.default_rng(0).choice(free_surface, PRESSES, replace=False)
    tractions = np.zeros((PRESSES, *normals.shape))
    inward = -normals[pressed] / np.linalg.norm(normals[pressed], axis=1, keepdims=True)
    tractions[np.arange(PRESSES), pressed] = inward
    return Trial(body.name, body.mesh, body.fixed, tractions)


@dataclass(frozen=True)
class Closeness:
    """Against quadratic elements: displacement of the loaded place, error of the whole surface."""

    give: float
    error: float


def closeness(
    trial: Trial, reference: QuadraticReference, matrices: dict[str, csr_array]
) -> dict[str, Closeness]:
    """Medians over the trial's loads, for each stiffness matrix."""
    truth, true_work = reference.under(trial.tractions)
    forces = reference.loads(trial.tractions)
    surface = np.intersect1d(trial.mesh.surface_nodes, trial.free)
    found = {}
    for name, K in matrices.items():
        moved = trial.solved(K, forces)
        work = np.einsum("knx,knx->k", moved, forces)
        off = np.linalg.norm((moved - truth)[:, surface], axis=(1, 2))
        size = np.linalg.norm(truth[:, surface], axis=(1, 2))
        found[name] = Closeness(float(np.median(work / true_work)), float(np.median(off / size)))
    return found


def print_locking(trial: Trial) -> dict[float, dict[str, Closeness]]:
    """One row a Poisson's ratio."""
    print(f"\n{trial.name}, {len(trial.mesh.nodes)} nodes")
    print("  how far the loaded place gives, quadratic = 1; error of the surface, %")
    print("  Poisson" + "".join(f"{name:>16}" for name in COLUMNS))
    found = {}
    for poisson_ratio in POISSON_RATIOS:
        reference = QuadraticReference(
            trial.mesh, trial.held, poisson_ratio, refinements=trial.refinements
        )
        matrices = {name: stiffness(trial.mesh, poisson_ratio, name) for name in COLUMNS}
        found[poisson_ratio] = closeness(trial, reference, matrices)
        cells = (
            f"{one.give:8.3f}{100 * one.error:6.1f} %" for one in found[poisson_ratio].values()
        )
        print(f"  {poisson_ratio:7g}" + "".join(cells), flush=True)
    return found


def print_soundness(trial: Trial) -> None:
    """Vibrations beside quadratic ones, and how far single nodes give, which is what is felt."""
    print(f"\n{trial.name}: is anything softer than the body itself, is there a checkerboard")
    print("  slowest: least of the first vibrations' stiffness, quadratic = 1")
    print("  node:    how far a single loaded node gives, linear = 1")
    print("  uneven:  scatter of that about the neighbours' (size of patch removed)")
    for poisson_ratio in (0.3, 0.49):
        reference = QuadraticReference(trial.mesh, trial.held, poisson_ratio)
        truth = lowest_vibrations(reference.stiffness, reference.mass)
        print(f"  Poisson's ratio {poisson_ratio}")
        of_linear = node_gives(trial, stiffness(trial.mesh, poisson_ratio, LINEAR))
        for name in COLUMNS:
            K = stiffness(trial.mesh, poisson_ratio, name)
            ours = lowest_vibrations(csc_array(K[trial.dofs][:, trial.dofs]), linear_mass(trial))
            gives = node_gives(trial, K)
            print(
                f"    {name:<10} slowest {(ours / truth).min():6.3f}   "
                f"node {np.median(gives / of_linear):5.2f}   "
                f"uneven {100 * unevenness(trial, gives):5.1f} %",
                flush=True,
            )


def linear_mass(trial: Trial) -> csc_array:
    """The consistent mass matrix of linear elements, free degrees of freedom, unit density."""
    tets, count = trial.mesh.tets, len(trial.mesh.nodes)
    shares = np.einsum("t,ab->tab", trial.mesh.tet_volumes, (1 + np.eye(4)) / 20)
    rows, columns = np.repeat(tets, 4, axis=1), np.tile(tets, (1, 4))
    nodal = coo_array((shares.ravel(), (rows.ravel(), columns.ravel())), shape=(count, count))
    return csc_array(kron(nodal, np.eye(3), "csr")[trial.dofs][:, trial.dofs])


def lowest_vibrations(K: csc_array, M: csc_array) -> NDArray[np.float64]:
    """The smallest eigenvalues."""
    start = np.ones(K.shape[0])
    found = eigsh(K, VIBRATIONS, M, sigma=0, v0=start, return_eigenvectors=False)
    return np.sort(found)


def node_gives(trial: Trial, K: csr_array) -> NDArray[np.float64]:
    """Trace of L_aa for each free surface node."""
    compliance = surface_compliance(trial.mesh, K, trial.held)
    return np.trace(compliance.diagonal(), axis1=1, axis2=2)


def unevenness(trial: Trial, gives: NDArray[np.float64]) -> float:
    """Standard deviation of log(give x size of a node's patch) about its neighbours' mean."""
    triangles = trial.mesh.surface_triangles
    i, j, k = (trial.mesh.nodes[triangles[:, corner]] for corner in range(3))
    areas = np.linalg.norm(np.cross(j - i, k - i), axis=1) / 6
    patch = np.bincount(triangles.ravel(), np.repeat(areas, 3), len(trial.mesh.nodes))
    free = np.intersect1d(trial.mesh.surface_nodes, trial.free)
    height = np.log(gives * np.sqrt(patch[free]))
    ends = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    links = coo_array((np.ones(len(ends)), ends.T), shape=(len(patch),) * 2)
    neighbours = csr_array(links + links.T)[free][:, free]
    return float(np.std(height - (neighbours @ height) / neighbours.sum(axis=1)))


def print_bone() -> None:
    """A ball a thousand times stiffer inside a soft one, meshed so that tetrahedra keep to it."""
    mesh = ball_in_ball()
    middle = np.linalg.norm(mesh.nodes[mesh.tets].mean(axis=1), axis=1)
    bone = np.where(middle < 0.4, 1000.0, 1.0)
    graded = 1000.0 ** (0.5 + 0.5 * mesh.nodes[mesh.tets].mean(axis=1)[:, 0])
    held = mesh.surface_nodes[mesh.nodes[mesh.surface_nodes, 2] < -0.7]
    pressed = np.setdiff1d(mesh.surface_nodes, held)[::12]
    tractions = np.zeros((len(pressed), *mesh.nodes.shape))
    tractions[np.arange(len(pressed)), pressed] = -mesh.nodes[pressed]
    trial = Trial("ball in ball", mesh, held, tractions)
    print(f"\n{trial.name}, {len(mesh.nodes)} nodes: give and error as above")
    apart = strain_smoothing.LARGEST_SPREAD
    for what, scale in (
        ("1000 times stiffer inside", bone),
        ("1 to 1000 from side to side", graded),
    ):
        for poisson_ratio in (0.3, 0.49):
            reference = QuadraticReference(mesh, held, poisson_ratio, scale)
            matrices = {
                name: assemble(mesh, poisson_ratio, formulation=name, young_scale=scale)
                for name in FORMULATIONS
            }
            strain_smoothing.LARGEST_SPREAD = np.inf
            matrices["smeared"] = assemble(
                mesh, poisson_ratio, formulation=SMOOTHED, young_scale=scale
            )
            strain_smoothing.LARGEST_SPREAD = apart
            found = closeness(trial, reference, matrices)
            cells = (
                f"   {name} {one.give:.3f} {100 * one.error:4.1f} %" for name, one in found.items()
            )
            print(f"  {what:<28} {poisson_ratio}" + "".join(cells), flush=True)


def ball_in_ball() -> TetMesh:
    """Unit ball of scattered nodes, with shells of nodes at 0.4 that no tetrahedron crosses."""
    golden = np.pi * (3 - np.sqrt(5))
    shells = [np.zeros((1, 3))]
    for radius, count in ((0.2, 14), (0.4, 60), (0.6, 130), (0.8, 230), (1.0, 360)):
        height = 1 - (2 * np.arange(count) + 1) / count
        turn = golden * np.arange(count)
        across = np.sqrt(1 - height**2)
        on_unit = np.column_stack([across * np.cos(turn), across * np.sin(turn), height])
        shells.append(radius * on_unit)
    nodes = np.concatenate(shells)
    tets = Delaunay(nodes).simplices.astype(np.int64)
    return wound(nodes, tets[np.abs(signed_volumes(nodes, tets)) > 1e-6])


def print_cost(bodies: list[MeasuredBody]) -> None:
    """Size of the matrix, work and memory of the elimination, time of assembly and elimination."""
    print("\ncost at a Poisson's ratio of 0.49")
    print(f"  {'':<22}{'entries':>12}{'Gflop':>9}{'peak MB':>9}{'assembly s':>12}{'inverse s':>11}")
    for body in bodies:
        times = {name: print_cost_of(body, name) for name in FORMULATIONS}
        print(f"  {'':<12}smoothed takes {times[SMOOTHED] / times[LINEAR]:.1f} times as long")


def print_cost_of(body: MeasuredBody, formulation: str) -> float:
    """One row; returns the seconds from tetrahedra to compliance."""
    K = assemble(body.mesh, 0.49, formulation=formulation)
    assembly = seconds_of(lambda: assemble(body.mesh, 0.49, formulation=formulation))
    plan = plan_surface_inverse(body.mesh, K, body.fixed)
    inverse = seconds_of(lambda: surface_compliance(body.mesh, K, body.fixed))
    print(
        f"  {body.name:<12}{formulation:<10}{K.nnz:12,}{plan.flops / 1e9:9.1f}"
        f"{plan.peak_bytes / 1e6:9.0f}{assembly:12.2f}{inverse:11.2f}",
        flush=True,
    )
    return assembly + inverse


def draw(
    cantilever: dict[float, dict[str, Closeness]],
    mouse: dict[float, dict[str, Closeness]],
    file: Path,
) -> None:
    """The give of the cantilever and the error of the mouse's dents against Poisson's ratio."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    shown = [ratio for ratio in POISSON_RATIOS if ratio >= 0]
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.2), layout="constrained")
    for name, colour in ((LINEAR, "#b5482a"), (SMOOTHED, "#2a6fb5")):
        left.plot(
            [100 * cantilever[ratio][name].give for ratio in shown], "o-", color=colour, label=name
        )
        right.plot([100 * mouse[ratio][name].error for ratio in shown], "o-", color=colour)
    left.axhline(100, color="#777777", linewidth=0.8)
    left.set_title("Cantilever: deflection, % of the true one", fontsize=9)
    right.set_title("Pressed mouse: error of the surface, %", fontsize=9)
    left.legend(frameon=False, fontsize=9)
    for axes in (left, right):
        axes.set_xticks(range(len(shown)), [f"{ratio:g}" for ratio in shown], fontsize=7)
        axes.set_xlabel("Poisson's ratio", fontsize=9)
        axes.set_ylim(bottom=0)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=150)
    print(f"\ndrawn: {file}")


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--picture", type=Path, metavar="FILE.png")
    arguments = parser.parse_args()
    trials = [*cantilevers(), *pressed_cubes(), pressed_mouse()]
    found = {trial.name: print_locking(trial) for trial in trials}
    print_soundness(trials[-1])
    print_bone()
    names = ["mouse-1.7k"] if arguments.quick else ["mouse-1.7k", "mouse-20k"]
    print_cost([stored_body(name) for name in names])
    if arguments.picture is not None:
        draw(found["cantilever, grid"], found["mouse-1.7k"], arguments.picture)


if __name__ == "__main__":
    main()
