"""What the compressed compliance saves and costs, beside the dense one in the same run.

    python benchmarks/bake/compressed.py [--quick]

For ``mouse-1.7k`` and ``mouse-20k`` and several tolerances: bytes and their ratio to the dense
form in float32; the largest relative error of any column, against all columns of the elimination in
float64 and, for some, against iteratively refined sparse solves; the time to compress, by columns
that are in memory and by columns that the factored stiffness gives; what memory the latter takes;
a touch of nine columns, each time somewhere else; and the time in which the servo's native code
reads a block. ``--quick`` leaves out ``mouse-20k``.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from numpy.typing import NDArray
from palpate_servo.harness import seconds_per_block
from precompute import Problem, at_least, at_most

from palpate.benchmarks.measuring.bodies import MeasuredBody, stored_body
from palpate.benchmarks.measuring.memory import in_fresh_process
from palpate.benchmarks.measuring.timing import times_seconds
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.compression.compressed_compliance import CompressedCompliance
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.compliance.elimination.surface_columns import factor_for_columns
from palpate.core.compliance.protocol import Compliance
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.servo.session import native_compliance
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.freedoms import freedoms

POISSON_RATIO = 0.3
TOLERANCES = (1e-4, 1e-3, 6e-3)

# For mouse-20k: at least so many times smaller at a tolerance; a touch takes at most so many
# seconds, and at most so many times the dense one.
SMALLER = {1e-3: 8.0, 6e-3: 16.0}
LONGEST_TOUCH, LONGEST_TOUCH_RATIO = 0.5e-3, 10.0

REFINED_NODES = 16
NODES_COMPARED_AT_ONCE = 100
TOUCHES = 300
BLOCKS = 20_000


def column_errors(found: NDArray[np.float64], true: NDArray[np.float64]) -> NDArray[np.float64]:
    """Relative, 2-norm, one a column."""
    return np.linalg.norm(found - true, axis=0) / np.linalg.norm(true, axis=0)


def largest_error(compressed: CompressedCompliance, exact: DenseCompliance) -> float:
    """Of all columns."""
    parts = np.split(
        np.arange(exact.node_count), range(0, exact.node_count, NODES_COMPARED_AT_ONCE)[1:]
    )
    return max(
        float(column_errors(compressed.columns(nodes), exact.columns(nodes)).max())
        for nodes in parts
    )


def touch_seconds(compliance: Compliance, triangles: NDArray[np.int64]) -> float:
    """Median over many touches of nine columns, each somewhere else."""
    rng = np.random.default_rng(3)
    forces, next_triangle = rng.normal(size=(3, 3)), iter(np.resize(triangles, (2 * TOUCHES, 3)))
    times = times_seconds(
        lambda: compliance.apply(forces, next(next_triangle)), TOUCHES, warm_up=20
    )
    return float(np.median(times))


def block_nanoseconds(compliance: Compliance, pairs: NDArray[np.int64]) -> float:
    """Time of one block in native code, the least of five runs."""
    native = native_compliance(compliance)
    listed = [(int(i), int(j)) for i, j in pairs]
    return 1e9 * min(seconds_per_block(native, listed) for _ in range(5))


def compressed_by_factor(
    body: MeasuredBody, tolerance: float
) -> tuple[CompressedCompliance, tuple[float, float]]:
    """Built without a dense table; seconds to factor and to compress. Also for a new process."""
    stiffness = assemble(body.mesh, POISSON_RATIO)
    start = time.perf_counter()
    source = factor_for_columns(body.mesh, stiffness, body.fixed)
    factored = time.perf_counter()
    compressed = compress(source, body.mesh.nodes[source.free_surface], tolerance)
    return compressed, (factored - start, time.perf_counter() - factored)


def report(body: MeasuredBody) -> None:
    """Measure one body and print it."""
    stiffness = assemble(body.mesh, POISSON_RATIO)
    exact = surface_compliance(body.mesh, stiffness, body.fixed, dtype=np.float64)
    dense = DenseCompliance(exact.free_surface, exact.table.astype(np.float32))
    positions = body.mesh.nodes[exact.free_surface]
    count = exact.node_count
    print(
        f"\n{body.name}: {count} free surface nodes, {dense.nbytes / 1e6:.1f} MB dense in float32"
    )

    problem = Problem(body, POISSON_RATIO)
    refined_nodes = np.random.default_rng(2).choice(count, REFINED_NODES, replace=False)
    refined = problem.true_columns(freedoms(refined_nodes))
    corners = body.mesh.surface_triangles
    corners = corners[np.isin(corners, exact.free_surface).all(axis=1)]
    triangles = np.searchsorted(exact.free_surface, corners)
    rng = np.random.default_rng(4)
    touched = triangles[rng.permutation(len(triangles))]
    beside, anywhere = np.resize(touched[:, :2], (BLOCKS, 2)), rng.integers(0, count, (BLOCKS, 2))
    print(
        f"  dense, native: {block_nanoseconds(dense, beside):.0f} ns a block of neighbours, "
        f"{block_nanoseconds(dense, anywhere):.0f} ns of any two nodes"
    )
    for tolerance in TOLERANCES:
        start = time.perf_counter()
        compressed = compress(exact, positions, tolerance)
        seconds = time.perf_counter() - start
        (_, (factor, rest)), grown = in_fresh_process(compressed_by_factor, body, tolerance)
        large = body.name == "mouse-20k"
        ratio = dense.nbytes / compressed.nbytes
        wanted = at_least(ratio, SMALLER[tolerance]) if large and tolerance in SMALLER else None
        print(f"  tolerance {tolerance:g}")
        print(f"    {compressed.nbytes / 1e6:.2f} MB, times smaller {wanted or f'{ratio:.1f}'}")
        sampled = column_errors(compressed.columns(refined_nodes), refined).max()
        print(
            f"    largest column error / tolerance "
            f"{at_most(largest_error(compressed, exact) / tolerance, 1.0)}, promised "
            f"{compressed.column_error / tolerance:.3f}; of {3 * REFINED_NODES} refined columns "
            f"{sampled / tolerance:.3f}"
        )
        print(
            f"    compressed in {seconds:.1f} s from memory, in {factor:.1f} + {rest:.1f} s by the "
            f"factor; that takes {grown / 1e6:.0f} MB ({grown / dense.nbytes:.2f} of dense float32)"
        )
        ours, theirs = touch_seconds(compressed, touched), touch_seconds(dense, touched)
        share, times = f"{ours / LONGEST_TOUCH:.2f}", f"{ours / theirs:.2f}"
        if wanted:
            share = at_most(ours / LONGEST_TOUCH, 1.0)
            times = at_most(ours / theirs, LONGEST_TOUCH_RATIO)
        print(
            f"    nine columns {1e6 * ours:.0f} us, times {LONGEST_TOUCH * 1e6:.0f} us {share}; "
            f"dense {1e6 * theirs:.0f} us, times that {times}"
        )
        print(
            f"    native: {block_nanoseconds(compressed, beside):.0f} ns a block of neighbours, "
            f"{block_nanoseconds(compressed, anywhere):.0f} ns of any two nodes"
        )


def main() -> None:
    """Measure the bodies that are asked for."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--quick", action="store_true", help="leave out mouse-20k")
    names = ["mouse-1.7k"] if options.parse_args().quick else ["mouse-1.7k", "mouse-20k"]
    for name in names:
        report(stored_body(name))


if __name__ == "__main__":
    main()
