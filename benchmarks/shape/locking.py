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
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, csr_array, kron
from scipy.sparse.linalg import eigsh

from palpate.benchmarks.measuring.bodies import MeasuredBody, stored_body
from palpate.benchmarks.measuring.shape.locking_trials import (
    Trial,
    ball_in_ball,
    cantilevers,
    pressed_cubes,
    pressed_mouse,
)
from palpate.benchmarks.measuring.shape.quadratic_reference import QuadraticReference
from palpate.benchmarks.measuring.timing import seconds_of
from palpate.core.compliance.elimination.plan import plan_surface_inverse
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness import strain_smoothing
from palpate.core.stiffness.assembly import assemble, isotropic, lame_parameters, shape_gradients
from palpate.core.stiffness.formulation import FORMULATIONS, LINEAR, SMOOTHED
from palpate.core.stiffness.strain_smoothing import (
    SmoothingDomains,
    edge_domains,
    gradient_products,
    node_domains,
    tet_domains,
)

POISSON_RATIOS = (-0.3, 0.0, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999)
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


LEFT_OUT = {
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
