"""Work on closed paths, and the fingers' coupling matrix, by the compiled servo's own ticks.

    python benchmarks/contact/closed_paths.py

Work done going round without friction, as a share of the energy that goes in and out on the way:
zero for an elastic body. By the trapezoidal rule over the ticks, on the paper's cube. A point that
sticks to its place is led round in space; two fingers go in and out one after the other; a
fingertip is led round through changing patches. ``settling`` is the number of ticks at each place:
with one the tool's law is a tick late and takes energy, in proportion to the step. Last the matrix
-dF/dx of two fingers that stick, by finite differences. Exit status 1 where a claim does not hold.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray
from palpate_servo.harness import SteppedFingers

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

Vectors = NDArray[np.float64]

YOUNG_MODULUS = 10_000.0
# Places on the top of the cube at a depth of 4 mm and 3 mm, metres.
FIRST, SECOND = np.array([0.021, 0.026, 0.046]), np.array([0.045, 0.025, 0.047])
WAY_DOWN = 60
STICKING = {"static_friction": 9.0, "dynamic_friction": 9.0}
RADIUS = 0.012
# Ticks after which a tool's displacements no longer change, whatever its bounds on a tick's work.
SETTLED = 12
ROUNDING, QUASI_STATIC, SYMMETRY = 1e-12, 1e-6, 1e-9


def around(count: int) -> Vectors:
    """A closed path in space from the origin, millimetres wide, (count + 1, 3)."""
    t = np.linspace(0.0, 2.0 * np.pi, count + 1)
    back = 1.0 - np.cos(t)
    return 1e-3 * np.column_stack([0.8 * back, 0.8 * np.sin(t), np.sin(2.0 * t) + 0.3 * back])


def one_after_the_other(count: int) -> Vectors:
    """Depths of two fingers, (4 count + 1, 2, 3): one in, the other in, one out, the other out."""
    share = np.linspace(0.0, 1.0, count + 1)[1:]
    none, all_ = np.zeros(count), np.ones(count)
    depths = np.column_stack(
        [
            np.concatenate([[0.0], share, all_, 1.0 - share, none]),
            np.concatenate([[0.0], none, share, all_, 1.0 - share]),
        ]
    )
    return -1e-3 * depths[:, :, None] * np.array([0.0, 0.0, 1.0])


def descent(end: Vectors) -> Vectors:
    """From above to places (m, 3), (WAY_DOWN, m, 3)."""
    heights = np.linspace(0.006, 0.0, WAY_DOWN)
    return end + heights[:, None, None] * np.array([0.0, 0.0, 1.0])


def share_of_work(fingers: SteppedFingers, path: Vectors, settling: int = 1) -> float:
    """Work of the forces on a closed path (ticks, m, 3), over half of what went in and out."""
    fingers.follow(descent(path[0]))
    fingers.follow(np.repeat(path[:1], 40, axis=0))
    forces = fingers.follow(np.repeat(path, settling, axis=0))[0][settling - 1 :: settling]
    middle = 0.5 * (forces[1:] + forces[:-1])
    work = np.einsum("tmx,tmx->t", middle, np.diff(path, axis=0))
    return float(work.sum() / (0.5 * np.abs(work).sum()))


def main() -> int:
    """Print the figures; 1 if one is worse than claimed."""
    mesh, fixed = paper_cube()
    body = bake(mesh, BakeSettings(0.49, YOUNG_MODULUS, PinNodes(fixed)))[0]
    native = native_body(body, whole=True)
    contact = native_tool(body, native, sphere(RADIUS))
    misses = 0

    def fingers(start: Vectors, **feel: float) -> SteppedFingers:
        above = descent(start)[0]
        return SteppedFingers(native, above, Settings(YOUNG_MODULUS, **feel))

    def told(what: str, value: float, claim: float | None) -> None:
        nonlocal misses
        holds = claim is None or abs(value) <= claim
        misses += not holds
        beside = "" if claim is None else f"   at most {claim:g}"
        print(f"{what:56}{value:12.1e}{beside}{'' if holds else '   VIOLATED'}", flush=True)

    for count in (100, 400, 1600):
        path = FIRST + around(count)[:, None]
        told(
            f"one finger sticking, {count} steps",
            share_of_work(fingers(path[0], **STICKING), path),
            ROUNDING,
        )
        pair = np.stack([FIRST, SECOND]) + one_after_the_other(count // 4)
        told(f"two fingers in turn, {count} steps", share_of_work(fingers(pair[0]), pair), ROUNDING)
    for settling in (1, SETTLED):
        for count in (100, 400, 1600, 6400):
            path = FIRST + [0.0, 0.0, RADIUS] + 3.0 * around(count)[:, None]
            tool = fingers(path[0])
            tool.set_tool(contact, np.eye(3))
            finest = settling > 1 and count == 6400
            told(
                f"fingertip, {count} steps, settling {settling}",
                share_of_work(tool, path, settling),
                QUASI_STATIC if finest else None,
            )

    def felt(moved: Vectors) -> Vectors:
        places = np.stack([FIRST, SECOND])
        pair = fingers(places, **STICKING)
        pair.follow(descent(places))
        pair.follow(np.repeat(places[None], 40, axis=0))
        forces: Vectors = pair.follow((places + moved)[None])[0][-1].ravel()
        return forces

    step = 1e-6
    moves = step * np.eye(6).reshape(6, 2, 3)
    matrix = np.array([felt(-move) - felt(move) for move in moves]).T / (2.0 * step)
    skew = float(np.abs(matrix - matrix.T).max() / np.abs(matrix).max())
    told("two fingers: coupling matrix less its transpose", skew, SYMMETRY)
    least, most = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[[0, -1]]
    misses += not least > 0.0
    print(f"two fingers: principal stiffnesses {least:.1f} to {most:.1f} N/m")
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
