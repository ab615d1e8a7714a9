"""What a touch costs after the bake, beside what the same touch costs otherwise.

    python benchmarks/touch_cost.py [--quick]

For ``mouse-1.7k`` and ``mouse-20k``, in the same run and on random triangles all over the body, so
that no column is in the cache before it is wanted:

- the deformation (15), nine columns of L, in both forms;
- a copy of those nine columns from the table to another place: what reading the memory costs;
- CHOLMOD's solve of the whole body under the same forces, factored beforehand (cholespy);
- a whole frame in its parts: deform, carry to 100,000 drawn vertices, write into Blender's mesh.

``--quick`` leaves out ``mouse-20k``.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from functools import partial

import numpy as np
from measuring.bodies import MeasuredBody, stored_body
from measuring.drawn_frame import (
    DRAWN_VERTICES,
    Load,
    blender_write_seconds,
    drawn_coordinates,
    hung_vertices,
    in_turn,
    random_loads,
)
from measuring.prefactored import PrefactoredSolve, cholespy_module
from measuring.timing import median_seconds
from numpy.typing import NDArray

from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.servo.session import native_body
from palpate.core.stiffness.pins import PinNodes

TOUCHES = 400
ROUNDS = 5
TOLERANCE = 1e-3

# At most so many times a copy of the same memory, and at least so many times faster than CHOLMOD.
LARGEST_COPIES = 2.0
SMALLEST_GAIN = {"mouse-1.7k": 20.0, "mouse-20k": 500.0}


def copy_seconds(body: SoftBody, table: NDArray[np.floating], loads: list[Load]) -> float:
    """Median time of copying a load's nine columns to a place that is there already."""
    wanted = iter([body.free_index(load.triangle) for load in 2 * loads])
    place = np.empty((3, *table.shape[1:]), table.dtype)
    return median_seconds(
        lambda: np.take(table, next(wanted), axis=0, out=place, mode="clip"), TOUCHES
    )


def apply_seconds(body: SoftBody, loads: list[Load]) -> float:
    """Median time of the product alone, without finding the columns and dividing by E."""
    wanted = iter([(load.nodal_forces, body.free_index(load.triangle)) for load in 2 * loads])
    return median_seconds(lambda: body.compliance.apply(*next(wanted)), TOUCHES)


def deform_seconds(body: SoftBody, loads: list[Load]) -> float:
    """Median time of a deformation."""
    return median_seconds(
        in_turn(loads, lambda load: body.deform(load.triangle, load.nodal_forces)), TOUCHES
    )


def cholmod_seconds(body: SoftBody, load: Load) -> float | None:
    """Median time of CHOLMOD's solve, after comparing its answer with ours; None without it."""
    cholespy = cholespy_module()
    if cholespy is None:
        return None
    forces = np.zeros_like(body.mesh.nodes)
    forces[load.triangle] = load.nodal_forces
    solve = PrefactoredSolve(body, cholespy).under(forces)
    truth, ours = solve(), body.deform(load.triangle, load.nodal_forces)
    difference = float(np.linalg.norm(ours - truth) / np.linalg.norm(truth))
    print(f"  the two deformations differ by {difference:.1e}")
    return median_seconds(solve, 10)


def dense_and_compressed(measured: MeasuredBody) -> tuple[SoftBody, SoftBody]:
    """The same body twice."""
    settings = BakeSettings(0.3, 1000.0, PinNodes(measured.fixed), form="dense")
    dense, _ = bake(measured.mesh, settings)
    positions = dense.mesh.nodes[dense.compliance.free_surface]
    compressed = compress(dense.compliance, positions, TOLERANCE)
    return dense, replace(dense, compliance=compressed)


def measure_touch(measured: MeasuredBody) -> tuple[SoftBody, SoftBody]:
    """Print what a touch costs; returns the bodies."""
    dense, compressed = dense_and_compressed(measured)
    table = dense.compliance
    if not isinstance(table, DenseCompliance):
        raise TypeError(f"a dense body was baked in the form {table.form}")
    print(f"\n{measured.name}: {table.node_count} free surface nodes")
    loads = random_loads(dense, TOUCHES)
    # In turns, so that what else the machine does meets all of them alike.
    rounds = [
        (
            copy_seconds(dense, table.table, loads),
            deform_seconds(dense, loads),
            deform_seconds(compressed, loads),
            apply_seconds(dense, loads),
        )
        for _ in range(ROUNDS)
    ]
    copying, of_dense, of_compressed, product = np.median(rounds, axis=0).tolist()
    times = {"dense": of_dense, "compressed": of_compressed}
    native = native_body(dense)
    triangle, alpha, u = 10, np.array([0.2, 0.3, 0.5]), np.array([0.0, 0.0, -0.003])
    force = median_seconds(lambda: native.contact(triangle, alpha, u, 1000.0), 2000)
    print(f"  force on the finger, native, (11) to (14)  {1e6 * force:9.1f} us")
    print(f"  copy of nine columns of the table          {1e6 * copying:9.1f} us")
    print(f"  product with them, dense                   {1e6 * product:9.1f} us")
    for form, seconds in times.items():
        print(f"  deformation, {form:<10} (15)               {1e6 * seconds:9.1f} us")
    opponent = cholmod_seconds(dense, loads[0])
    print(f"  deformation against the copy               {times['dense'] / copying:9.2f}", end="")
    print(f"     (at most {LARGEST_COPIES:g})")
    print(
        f"  compressed against dense                   {times['compressed'] / times['dense']:9.2f}"
    )
    if opponent is None:
        print("  CHOLMOD is not here to compare with: pip install palpate[bench]")
        return dense, compressed
    print(f"  CHOLMOD's solve, factored beforehand       {1e6 * opponent:9.1f} us")
    for form, seconds in times.items():
        wanted = SMALLEST_GAIN.get(measured.name)
        least = f"     (at least {wanted:g})" if form == "dense" and wanted else ""
        print(f"  times faster, {form:<10}                    {opponent / seconds:9.0f}{least}")
    return dense, compressed


def measure_frame(name: str, bodies: tuple[SoftBody, SoftBody], write: float | None) -> None:
    """Print a frame in its parts, for both forms."""
    hung = hung_vertices(bodies[0])
    rest = np.random.default_rng(1).normal(size=3 * DRAWN_VERTICES).astype(np.float32)
    for body in bodies:
        loads = random_loads(body, TOUCHES)
        moved = body.deform(loads[0].triangle, loads[0].nodal_forces)
        far = hung.displacements(moved)
        deform = deform_seconds(body, loads)
        carry = median_seconds(partial(hung.displacements, moved), 30)
        place = median_seconds(partial(drawn_coordinates, rest, far), 30)
        parts = [deform, carry, place, *([] if write is None else [write])]
        print(
            f"{name:<12}{body.compliance.form:<12}"
            + "".join(f"{1e3 * part:>10.3f}" for part in parts)
            + f"{1e3 * sum(parts):>10.3f}"
        )


def main() -> None:
    """Print touches, then frames."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="leave out mouse-20k")
    names = ["mouse-1.7k"] if parser.parse_args().quick else ["mouse-1.7k", "mouse-20k"]
    bodies = {}
    for name in names:
        measured = stored_body(name)
        bodies[measured.name] = measure_touch(measured)
    write = blender_write_seconds()
    print(f"\na frame in its parts, ms, {DRAWN_VERTICES} drawn vertices")
    columns = ["deform", "carry", "place", *([] if write is None else ["write"]), "frame"]
    print(f"{'':<24}" + "".join(f"{column:>10}" for column in columns))
    for name, pair in bodies.items():
        measure_frame(name, pair, write)
    if write is None:
        print("what Blender's write takes is not known: there is no .venv-bpy-* (make setup)")


if __name__ == "__main__":
    main()
