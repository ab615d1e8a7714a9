"""What a touch costs after the bake, beside solving the whole body anew for the same load.

The opponent is a prefactored sparse solve (SuperLU, symmetric mode, minimum degree), which is what
one would use without the inverse stiffness. Run: python benchmarks/touch_cost.py [TETS.npz ...]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from palpate.core.bake import BakeSettings, bake
from palpate.core.closest_point import ClosestPoints
from palpate.core.drawn_map import DrawnMap
from palpate.core.paper_cube import paper_cube
from palpate.core.pins import PinNodes
from palpate.core.servo_session import native_body
from palpate.core.soft_body import SoftBody
from palpate.core.stiffness import assemble
from palpate.core.tet_mesh import TetMesh

MOUSE = Path(__file__).resolve().parents[1] / "tests" / "meshes" / "mouse-1.7k.npz"
DRAWN_VERTICES = 100_000


def median_us(work: Callable[[], object], repeats: int) -> float:
    """Median time of a call in microseconds."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter_ns()
        work()
        times.append(time.perf_counter_ns() - start)
    return float(np.median(times)) / 1000


def prefactored(body: SoftBody, forces: NDArray[np.float64]) -> Callable[[], object]:
    """A solve of the whole body for the same nodal forces (N, 3), factored beforehand."""
    K = assemble(body.mesh, body.poisson_ratio).tocsc()
    free = np.setdiff1d(np.arange(len(body.mesh.nodes)), body.fixed)
    dofs = (3 * free[:, None] + np.arange(3)).ravel()
    factor = splu(
        K[dofs][:, dofs],
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    load = forces.ravel()[dofs]
    return lambda: factor.solve(load)


def measure(name: str, body: SoftBody) -> None:
    """Print one row."""
    triangle, alpha, u = 10, np.array([0.2, 0.3, 0.5]), np.array([0.0, 0.0, -0.003])
    touch = body.touch(triangle, alpha, u)
    native = native_body(body)
    rng = np.random.default_rng(1999)
    chosen = rng.integers(0, len(body.mesh.surface_triangles), DRAWN_VERTICES)
    places = np.einsum(
        "pc,pcx->px",
        rng.dirichlet([1, 1, 1], DRAWN_VERTICES),
        body.mesh.nodes[body.mesh.surface_triangles[chosen]],
    )
    hung = DrawnMap.hang(places, body)
    moved = body.deform(touch.triangle, touch.nodal_forces)
    forces = np.zeros_like(body.mesh.nodes)
    forces[touch.triangle] = touch.nodal_forces
    force_native = median_us(lambda: native.contact(triangle, alpha, u, 1000.0), 2000)
    deform = median_us(lambda: body.deform(touch.triangle, touch.nodal_forces), 300)
    solve = median_us(prefactored(body, forces), 30)
    draw = median_us(lambda: hung.displacements(moved), 30)
    search = ClosestPoints(body.mesh.nodes, body.mesh.surface_triangles)
    nearest = median_us(lambda: search.query(places[:1]), 100)
    print(
        f"{name:12} {body.compliance.node_count:6d} {force_native:12.1f} {deform:12.1f} "
        f"{solve:12.1f} {solve / deform:8.1f} {draw:14.1f} {nearest:12.1f}"
    )


def main(files: list[str]) -> None:
    """Measure the paper's cube, the stored mouse, and any tetrahedra named."""
    print(
        f"{'body':12} {'free':>6} {'force us':>12} {'deform us':>12} {'solve us':>12} {'ratio':>8} "
        f"{'map 100k us':>14} {'nearest us':>12}"
    )
    mesh, fixed = paper_cube()
    measure("cube", bake(mesh, BakeSettings(0.49, 10_000.0, PinNodes(fixed)))[0])
    for file in [str(MOUSE), *files]:
        with np.load(file) as stored:
            mesh, fixed = TetMesh.checked(stored["X"], stored["T"]), stored["fixed"]
        measure(Path(file).stem, bake(mesh, BakeSettings(0.3, 1000.0, PinNodes(fixed)))[0])
    print("force: native, called from Python, (11) to (14); deform: (15); solve: the opponent")


if __name__ == "__main__":
    main(sys.argv[1:])
