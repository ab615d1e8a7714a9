"""What the compliance of a surface takes, beside sparse solvers that get it column by column.

    python benchmarks/bake/precompute.py [--quick] [--bodies NAME ...]

For ``mouse-1.7k``, a body of 5,000 nodes and ``mouse-20k``, in the same run:

- scipy's SuperLU with its best settings for this (symmetric mode, minimum degree, no pivoting for
  size), right-hand sides in blocks;
- CHOLMOD by its wheel cholespy, likewise;
- the multifrontal elimination, with one thread of BLAS as the others and with all cores; the share
  it reaches of the machine's matrix product; its peak memory, measured and predicted; and the
  largest error of a column against iteratively refined solves.

Where an opponent would take minutes, only a sample of its columns is solved and the rest is
estimated from it; the table says so. ``--quick`` leaves out ``mouse-20k``.
"""

from __future__ import annotations

import argparse
import importlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import SuperLU, splu

from palpate.benchmarks.measuring.bodies import MeasuredBody, made_body, stored_body
from palpate.benchmarks.measuring.memory import in_fresh_process
from palpate.benchmarks.measuring.timing import times_seconds
from palpate.core.compliance.elimination.plan import plan_surface_inverse
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.machine.blas_threads import blas_threads
from palpate.core.machine.machine_speed import dgemm_rate
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.freedoms import freedoms

# Right-hand sides solved in one go; SuperLU and CHOLMOD are at their best around here.
BLOCK = 96

# An opponent's columns are solved until this much time has passed, and the rest is estimated.
SECONDS_OF_SAMPLE = 20.0

# At least so many times faster than SuperLU and than CHOLMOD, at least this share of the machine's
# matrix product, and at most so many times the memory of a dense float64 result.
WANTED = {"mouse-1.7k": (2.0, 1.0), "made-5k": (6.0, 4.0), "mouse-20k": (20.0, 7.0)}
WANTED_RATE, LARGEST_MEMORY = 0.45, 3.5

POISSON_RATIOS = (0.3, 0.49)
CHECKED_NODES = 8
REFINEMENTS = 3


@dataclass(frozen=True)
class Columns:
    """Time of an opponent: factoring, and all columns at the pace of those solved."""

    factor: float
    solve: float
    solved_share: float

    @property
    def seconds(self) -> float:
        """Of the whole job."""
        return self.factor + self.solve

    def __str__(self) -> str:
        estimated = "" if self.solved_share == 1.0 else f" (from {self.solved_share:.1%} of it)"
        return f"{self.seconds:9.2f} s{estimated}"


class Problem:
    """The stiffness between free nodes of a body, and which of its freedoms are asked for."""

    def __init__(self, body: MeasuredBody, poisson_ratio: float) -> None:
        free = np.setdiff1d(np.arange(len(body.mesh.nodes)), body.fixed)
        surface = np.setdiff1d(body.mesh.surface_nodes, body.fixed)
        of_free = freedoms(free)
        stiffness = assemble(body.mesh, poisson_ratio)
        self.matrix: csc_array = stiffness[of_free][:, of_free].tocsc()
        self.wanted = freedoms(np.searchsorted(free, surface))

    def loads(self, columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Unit loads on some of the wanted freedoms, (rows, k), Fortran order."""
        loads = np.zeros((self.matrix.shape[0], len(columns)), order="F")
        loads[self.wanted[columns], np.arange(len(columns))] = 1.0
        return loads

    def superlu(self) -> SuperLU:
        """SuperLU's factor, its best settings for a symmetric positive definite matrix."""
        return splu(
            self.matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def cholmod(self) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
        """CHOLMOD's factor as a function that solves, (rows, k) to (rows, k)."""
        module = cholespy_module()
        solver = module.CholeskySolverD(
            self.matrix.shape[0],
            self.matrix.indptr.astype(np.int32),
            self.matrix.indices.astype(np.int32),
            self.matrix.data,
            module.MatrixType.CSC,
        )

        def solve(loads: NDArray[np.float64]) -> NDArray[np.float64]:
            right = np.ascontiguousarray(loads)
            solution = np.empty_like(right)
            solver.solve(right, solution)
            return solution

        return solve

    def timed(
        self, factored: Callable[[], Callable[[NDArray[np.float64]], NDArray[np.float64]]]
    ) -> Columns:
        """Time to factor and to solve for the wanted columns, or for a sample of them."""
        start = time.perf_counter()
        solve = factored()
        factor = time.perf_counter() - start
        count, solved, spent = len(self.wanted), 0, 0.0
        # In random order, since columns near one another would be alike.
        shuffled = np.random.default_rng(1).permutation(count)
        while solved < count and spent < SECONDS_OF_SAMPLE:
            start = time.perf_counter()
            part = shuffled[solved : solved + BLOCK]
            _ = solve(self.loads(part))[self.wanted]
            spent += time.perf_counter() - start
            solved += len(part)
        return Columns(factor, spent * count / solved, solved / count)

    def true_columns(self, columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Columns at the wanted rows, refined until they are as good as float64 allows."""
        solve = self.cholmod() if cholespy_module() else self.superlu().solve
        loads = self.loads(columns)
        solution = solve(loads)
        for _ in range(REFINEMENTS):
            solution += solve(loads - self.matrix @ solution)
        return solution[self.wanted]


def cholespy_module() -> ModuleType | None:
    """CHOLMOD's wheel for Python, if it is installed (``pip install palpate[bench]``)."""
    try:
        return importlib.import_module("cholespy")
    except ImportError:
        return None


def largest_column_errors(body: MeasuredBody, poisson_ratio: float) -> tuple[float, float]:
    """Of some columns as computed and as stored in float32, relative, 2-norm."""
    problem = Problem(body, poisson_ratio)
    count = len(problem.wanted)
    nodes = np.random.default_rng(2).choice(count // 3, CHECKED_NODES, replace=False)
    true = problem.true_columns(freedoms(nodes))
    stiffness = assemble(body.mesh, poisson_ratio)
    errors = []
    for dtype in (np.float64, np.float32):
        compliance = surface_compliance(body.mesh, stiffness, body.fixed, dtype=dtype)
        wrong = np.linalg.norm(compliance.columns(nodes) - true, axis=0)
        errors.append(float((wrong / np.linalg.norm(true, axis=0)).max()))
    return errors[0], errors[1]


def _computed(body: MeasuredBody, stiffness: csr_array) -> int:
    """For a process of its own: the compliance's bytes; what it takes meanwhile is measured."""
    return surface_compliance(body.mesh, stiffness, body.fixed).nbytes


def at_least(value: float, limit: float) -> str:
    """A figure beside the least that is wanted."""
    return f"{value:.2f} (at least {limit:g}: {'holds' if value >= limit else 'MISSED'})"


def at_most(value: float, limit: float) -> str:
    """A figure beside the most that is wanted."""
    return f"{value:.2f} (at most {limit:g}: {'holds' if value <= limit else 'MISSED'})"


def report(body: MeasuredBody) -> None:
    """Measure one body and print it."""
    problem = Problem(body, POISSON_RATIOS[0])
    nodes, count = len(body.mesh.nodes), len(problem.wanted)
    print(f"\n{body.name}: {nodes} nodes, {count // 3} of the free surface, {count} columns")
    stiffness = assemble(body.mesh, POISSON_RATIOS[0])
    ours = partial(surface_compliance, body.mesh, stiffness, body.fixed)
    repeats = 5 if nodes < 10_000 else 2
    with blas_threads(1):
        plan = plan_surface_inverse(body.mesh, stiffness, body.fixed)
        rate = dgemm_rate(1)
        seconds = float(np.median(times_seconds(ours, repeats)))
        superlu = problem.timed(lambda: problem.superlu().solve)
        cholmod = problem.timed(problem.cholmod) if cholespy_module() else None
    with blas_threads() as threads:
        rate_of_all = dgemm_rate(threads)
        seconds_of_all = float(np.median(times_seconds(ours, repeats)))

    over_superlu, over_cholmod = WANTED.get(body.name, (1.0, 1.0))
    print(f"  SuperLU, column by column        {superlu}")
    print(f"  CHOLMOD, column by column        {cholmod or 'not installed: palpate[bench]'}")
    print(f"  multifrontal, one thread         {seconds:9.2f} s")
    print(f"  multifrontal, {threads} threads          {seconds_of_all:9.2f} s")
    print(f"  times faster than SuperLU        {at_least(superlu.seconds / seconds, over_superlu)}")
    if cholmod:
        gain = cholmod.seconds / seconds
        print(f"  times faster than CHOLMOD        {at_least(gain, over_cholmod)}")
    share = plan.flops / seconds / rate
    print(
        f"  {plan.flops / 1e9:.1f} Gflop at {plan.flops / seconds / 1e9:.1f} Gflop/s, of DGEMM's "
        f"{rate / 1e9:.1f} {at_least(share, WANTED_RATE) if nodes > 10_000 else f'{share:.2f}'}; "
        f"with {threads} threads {plan.flops / seconds_of_all / rate_of_all:.2f} of "
        f"{rate_of_all / 1e9:.1f}"
    )
    dense = 8 * count**2
    _, grown = in_fresh_process(_computed, body, stiffness)
    print(
        f"  memory {grown / 1e6:.0f} MB (predicted {plan.peak_bytes / 1e6:.0f}), times a dense "
        f"float64 result {at_most(grown / dense, LARGEST_MEMORY)}"
    )
    for poisson_ratio in POISSON_RATIOS:
        double, single = largest_column_errors(body, poisson_ratio)
        print(
            f"  largest column error at Poisson's ratio {poisson_ratio}: {double:.1e} computed, "
            f"{single:.1e} stored"
        )


def main() -> None:
    """Measure the bodies that are asked for."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--quick", action="store_true", help="leave out mouse-20k")
    options.add_argument("--bodies", nargs="+", choices=list(WANTED), help="only these")
    chosen = options.parse_args()
    names = chosen.bodies or [name for name in WANTED if not (chosen.quick and "20k" in name)]
    for name in names:
        report(made_body(5000) if name == "made-5k" else stored_body(name))


if __name__ == "__main__":
    main()
