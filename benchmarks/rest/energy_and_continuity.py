"""What a closed way gives back, and how far forces jump where a support's points come and go.

    python benchmarks/rest/energy_and_continuity.py [--steps N]

Without friction. A cube in a corner of three floors, and two on each other, are pressed by a
fingertip that goes in by 3 mm and comes out again: what the hand has not got back, as a share of
what it put in, by states at rest, and by the servo's ticks in ever more time. Motion is quasi-
static: what is lost in ticks is drag, and falls with the speed. Claimed: 1e-4 at rest, and of the
cube by the servo in 12 s; less than 0.6 times as much in twice the time.

Then a cube, and the upper of two, are pressed near an edge, so that points of what bears them come
off: by how much a change of the force from tick to tick stands out of those beside it, as a share
of the largest force. Claimed: 2 %. The exit status tells whether all of that holds.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from palpate_servo.harness import SteppedFingers

from palpate.core.body.native_body import native_body
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.servo.session import native_tool
from palpate.core.servo.settings import Settings
from palpate.tests.bodies.free_shapes import free_block
from palpate.tests.bodies.laid import DOWN, INTO_CORNER, TIP, Laid

Array = NDArray[np.float64]
EDGE, SPACING = 0.05, 0.013
MIDDLE = np.array([0.03, 0.027, 0.0])
BESIDE = np.array([0.046, 0.026, 0.0])
DEPTH, TIP_ABOVE = 0.003, TIP.radius + 5e-4
SECONDS = (3.0, 6.0, 12.0, 24.0)
SLOW = 12.0
MOST_LOST, MOST_JUMP = 1e-4, 0.02
# Of what is lost in half the time.
SLOWER = 0.6


def in_and_out(high: float, steps: int) -> Array:
    """Places (steps, 3) on a way down and up again, m."""
    down = DEPTH * np.sin(np.linspace(0.0, np.pi, steps)) ** 2
    return MIDDLE + (high + TIP_ABOVE - down)[:, None] * np.array([0.0, 0.0, 1.0])


def lost(forces: Array, path: Array) -> float:
    """What did not come back, as a share of what was put in."""
    work = -0.5 * np.einsum("ta,ta->t", forces[1:] + forces[:-1], np.diff(path, axis=0))
    return float(work.sum() / work[work > 0.0].sum())


def two(cube: SoftBody, *tools: Pose) -> Pile:
    """The upper cube and the lower one, in a corner of three floors."""
    places = [Pose.at([0.0, 0.0, EDGE + 1e-5]), Pose.at([0.0, 0.0, 0.0])]
    return Pile(
        [(cube, place) for place in places],
        [Floor(friction=0.0, up=tuple(up)) for up in np.eye(3)],
        [(TIP, pose) for pose in tools],
        fingertips=[TIP],
        settings=PileSettings(friction=0.0, gravity=INTO_CORNER, spacing=SPACING),
    )


def at_rest(start: Array, made: Callable[[Pose], Resting | Pile], path: Array) -> Array:
    """Forces on the fingertip at each place, all at rest."""
    laid = made(Pose.at(start))
    forces = []
    for place in path:
        laid.lead([Pose.at(place)])
        rest = laid.settle()
        forces.append((rest if not isinstance(rest, tuple) else rest[0]).tools[0].force)
    return np.array(forces)


def two_in_servo(cube: SoftBody, start: Array) -> SteppedFingers:
    """The upper cube in the servo, with a fingertip."""
    pile = two(cube)
    pile.settle()
    fingers = SteppedFingers(
        pile.native_body, start[None], Settings(cube.young_modulus), prop=pile.laid()
    )
    fingers.set_tool(native_tool(cube, pile.native_body, TIP), np.eye(3))
    return fingers


def stands_out(forces: Array) -> float:
    """By how much a change is larger than both beside it, as a share of the largest force."""
    change = np.linalg.norm(np.diff(forces, axis=0), axis=1)
    most = np.maximum(change[:-2], change[2:])
    return float((change[1:-1] - most).max() / np.linalg.norm(forces, axis=1).max())


def main() -> int:
    """Print the tables; the exit status tells whether the claims hold."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--steps", type=int, default=41, help="states at rest on a way")
    steps = parser.parse_args().steps
    cube = free_block((EDGE, EDGE, EDGE), (4, 4, 4))
    laid = Laid(cube, native_body(cube, whole=True, may_move=True))
    servos: dict[str, tuple[float, Callable[[Array], SteppedFingers]]] = {
        "a cube in a corner": (EDGE, lambda start: laid.servo(start, tip=TIP)),
        "two cubes": (2.0 * EDGE, lambda start: two_in_servo(cube, start)),
    }
    rests: dict[str, Callable[[Pose], Resting | Pile]] = {
        "a cube in a corner": lambda pose: Resting(
            cube, laid.corner(), [(TIP, pose)], settings=laid.settings()
        ),
        "two cubes": lambda pose: two(cube, pose),
    }
    held = True
    for name, (high, servo) in servos.items():
        path = in_and_out(high, steps)
        share = lost(at_rest(path[0], rests[name], path), path)
        held &= abs(share) <= MOST_LOST
        print(f"{name}: at rest {share:.1e} lost", flush=True)
        before = np.inf
        for seconds in SECONDS:
            path = in_and_out(high, int(1e3 * seconds))
            fingers = servo(path[0])
            fingers.follow(np.repeat(path[:1], 500, 0)[:, None])
            share = lost(fingers.follow(path[:, None])[0][:, 0], path)
            held &= high > EDGE or seconds < SLOW or abs(share) <= MOST_LOST
            held &= abs(share) <= SLOWER * before
            before = abs(share)
            print(f"    by the servo in {seconds:4.0f} s {share:.1e}", flush=True)
    for name, (high, _) in servos.items():
        down = np.linspace(0.0, 0.005, 1000)
        start = BESIDE + np.array([0.0, 0.0, high + TIP_ABOVE])
        path = start - down[:, None] * np.array([0.0, 0.0, 1.0])
        if high > EDGE:
            fingers = two_in_servo(cube, start)
        else:
            floors = [Floor(friction=0.0)]
            fingers = laid.servo(start, tip=TIP, floors=floors, gravity=DOWN)
        fingers.follow(np.repeat(path[:1], 300, 0)[:, None])
        jump = stands_out(fingers.follow(path[:, None])[0][:, 0])
        held &= jump <= MOST_JUMP
        print(f"{name.split(' in ')[0]} pressed near an edge: {jump:.2%} of the largest force")
    print("as claimed" if held else "NOT AS CLAIMED")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
