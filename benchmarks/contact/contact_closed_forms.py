"""Tools on a large block against closed forms, and the work that tools do on closed paths.

    python benchmarks/contact/contact_closed_forms.py [--core N]

*Hertz*: a sphere of a hundred elements' radius pressed on a block, force against depth, beside
4/3 E* sqrt(R) d^1.5; claimed within 5 % for contact radii of four elements and more, with the
exponent within 3 %. *Small contacts*: the same for contact radii from half an element on, at a
node, on an edge, in a triangle, with points between the nodes, a third of the contact radius apart,
as a fingertip's own are from a third of its radius deep; claimed within 5 %. *Flat punch*: a round
face of five elements' radius, beside 2 E* a d; claimed within 5 %. The block is no half-space, it
ends and its outer elements are large; by how much less it gives way is read off between nodes far
apart, and taken from the depths. *Closed paths*: the work of a tool that goes round and comes back,
without friction, as a share of the most energy it had in the body on the way; claimed below 1e-6.
The exit status tells whether all claims hold.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.press import Press
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.contact.touches import ToolTouch
from palpate.core.mesh.paper_cube import paper_cube
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.bodies.graded_block import (
    graded_block,
    lift,
    nodes_as_points,
)
from palpate.tests.referees.closed_forms import (
    ELEMENT,
    SMALL_PLACES,
    hertz,
    punch,
    small_contacts,
)

POISSON_RATIOS = (0.3, 0.45)
LARGEST_FORCE_ERROR = 0.05
LARGEST_EXPONENT_ERROR = 0.03
SMALLEST_CLAIMED_RADIUS = 4.0
SMALL_RADII = (0.5, 1.0, 1.5, 2.0, 3.0)
LARGEST_WORK = 1e-6
FIRST_STEPS = 60
CHANGE_BY_HALVING = 1e-8
SHORTEST_STEP = 2e-6


def main() -> int:
    """Print the tables; the exit status tells whether the claims hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--core", type=int, default=7, help="elements from the middle to the edge")
    core = parser.parse_args().core
    held = True
    for nu in POISSON_RATIOS:
        body = graded_block(ELEMENT, core, nu)
        points = nodes_as_points(body, core * ELEMENT)
        shift = lift(body, points, ELEMENT)
        near = near_correction(body, points)
        for name, correction in (("elements alone", None), ("with near field", near)):
            print(f"\nHertz, nu = {nu}, {name}\n  a / element   force / Hertz   exponent")
            for radius, force, exponent in hertz(body, points, correction, shift, core):
                claimed = radius >= SMALLEST_CLAIMED_RADIUS
                held &= not claimed or (
                    abs(force - 1) <= LARGEST_FORCE_ERROR
                    and abs(exponent / 1.5 - 1) <= LARGEST_EXPONENT_ERROR
                )
                print(f"  {radius:11.2f}   {force:13.3f}   {exponent:8.3f}")
            if correction is not None:
                print("Small contacts: a / element, force / Hertz at " + ", ".join(SMALL_PLACES))
                for elements in SMALL_RADII:
                    forces = small_contacts(near.field, shift, elements)
                    held &= bool((np.abs(np.array(forces) - 1) <= LARGEST_FORCE_ERROR).all())
                    print(f"  {elements:11.2f}   " + "   ".join(f"{one:.3f}" for one in forces))
            force = punch(body, points, correction, shift)
            held &= abs(force - 1) <= LARGEST_FORCE_ERROR
            print(f"Flat punch of 5 elements' radius: force / closed form {force:.3f}")
    print("\nWork on closed paths / most energy on the way")
    cube = baked_body(*paper_cube(), dtype=np.float64)
    for name, (tool, path) in closed_paths().items():
        share = work_round(cube, tool, path)
        held &= share <= LARGEST_WORK
        print(f"  {name:34s} {share:.1e}")
    print("\nall claims hold" if held else "\nA CLAIM DOES NOT HOLD")
    return 0 if held else 1


Path = Callable[[float], Pose]


def closed_paths() -> dict[str, tuple[Tool, Path]]:
    """Ways round on the cube of 50 mm, as poses over the share of the way, 0 to 1."""

    def round_and_round(t: float) -> tuple[float, float]:
        return float(np.cos(2 * np.pi * t)), float(np.sin(2 * np.pi * t))

    def sphere_deep(t: float) -> Pose:
        c, s = round_and_round(t)
        return Pose.at([0.025 + 0.004 * s, 0.025 + 0.003 * s * c, 0.058 + 0.006 * c])

    def sphere_over_edge(t: float) -> Pose:
        c, s = round_and_round(t)
        return Pose.at([0.045 + 0.008 * c, 0.025 + 0.006 * s, 0.0605 + 0.001 * s])

    def rod_turning(t: float) -> Pose:
        c, s = round_and_round(t)
        turn = Rotation.from_rotvec([0.1 * s, 0.15 * c, 0.5 * s]).as_matrix()
        return Pose.at([0.025 + 0.003 * c, 0.025 + 0.002 * s, 0.0585 + 0.001 * s], turn)

    def plate_rocking(t: float) -> Pose:
        c, s = round_and_round(t)
        turn = Rotation.from_rotvec([0.03 * s, 0.04 * c, 0.0]).as_matrix()
        return Pose.at([0.025, 0.025, 0.0485 + 0.0005 * s], turn)

    return {
        "sphere, pressed to 0.86 of its radius": (sphere(0.014), sphere_deep),
        "sphere, over an edge and back": (sphere(0.014), sphere_over_edge),
        "rod, pressed, turned and rolled": (rod(0.012, 0.02), rod_turning),
        "plate, larger than the face, rocking": (plate(0.08, 0.08), plate_rocking),
    }


def work_round(body: SoftBody, tool: Tool, path: Path) -> float:
    """|Work| of the tool on a closed path over the most energy on it.

    Steps are halved until the trapezoidal rule changes little by it: where points come and go the
    force has kinks.
    """
    ticks = [step / FIRST_STEPS for step in range(FIRST_STEPS + 1)]
    press = Press(body, [tool])

    def at(tick: float) -> ToolTouch:
        return cast("ToolTouch", press.to([path(tick)])[0])

    touches = [at(tick) for tick in ticks]
    most = max(touch.energy for touch in touches)
    work = 0.0
    left = list(zip(ticks, touches, ticks[1:], touches[1:], strict=False))
    while left:
        start, before, end, after = left.pop()
        middle = 0.5 * (start + end)
        between = at(middle)
        whole = _work(before, after)
        halves = _work(before, between) + _work(between, after)
        if abs(halves - whole) <= CHANGE_BY_HALVING * most or end - start < SHORTEST_STEP:
            work += halves + (halves - whole) / 3.0
        else:
            left += [(start, before, middle, between), (middle, between, end, after)]
    return abs(work) / most


def _work(before: ToolTouch, after: ToolTouch) -> float:
    moved = after.pose.position - before.pose.position
    turned = Rotation.from_matrix(after.pose.rotation @ before.pose.rotation.T).as_rotvec()
    return _along(before.force, after.force, moved) + _along(before.torque, after.torque, turned)


def _along(
    before: NDArray[np.float64], after: NDArray[np.float64], way: NDArray[np.float64]
) -> float:
    return float(0.5 * (before + after) @ way)


if __name__ == "__main__":
    sys.exit(main())
