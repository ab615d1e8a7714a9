"""What touching costs the servo's thread, in CPU time of the thread: points, fingertips, tools.

    python benchmarks/servo/tick_cost.py [--quick] [--tool NAME]

One and two point fingers are whole ticks of the servo, in both modes. Tools are ticks of the
contact itself on the paper's cube, with and without friction: sliding under changing pressure, then
set down and lifted. "Long" is a tick over 700 us. Time is the thread's own
(CLOCK_THREAD_CPUTIME_ID), which on a shared or virtual machine counts what others took, too. Two
things tell these apart:

* a tick over 500 us is gone through again from a state 20 ticks or more before (that it computes
  the same is checked) until it takes less, ten times at most: the least time is its computing;
* as taken are all ticks but those, one in 200, before which that state was copied: that leaves
  little else in the caches, and such a tick takes a quarter to a half longer;
* after every fourth tick a loop of fixed work runs, of about 100 us: what is long there is the
  machine alone. The table has how many long ticks that makes expect among as much computing.

Exit code 1 where a claim fails:

* consistent mode at most 1 us more than paper mode, two coupled contacts at most 3 us more than
  two alone (for an idle machine: medians);
* a fingertip of 12 points at most 50 us, of 40 points at most 300 us (the same);
* at most one tick in 100,000 of any tool computes for longer than 700 us;
* four fingertips of 40 points together at most 650 us, 900 with friction, two plates 3 mm deep 600
  and 700 (the same);
* pressed down at 50 mm/s and held still, a tool without friction has its force, to a millionth,
  within 20 ticks.

"Found" is how many ticks ended with the equilibrium found while the tool moved: the bound on the
work ends those of many points before.

``--quick`` takes a tenth of the ticks. Three to four minutes else.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers, ToolContact, tool_costs

from palpate.benchmarks.servo.several_tools import print_several
from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

if TYPE_CHECKING:
    # Types only: the module itself does not have them.
    from palpate_servo import ContactMode

TOP = 0.05
# With friction and without together a tool makes over 100,000.
TICKS = 50_500
ROUNDS = 5
LONGEST = 700e-6
REPLAYED = 500e-6
CONTROL = 100e-6
FRICTIONS = (0.0, 0.4)
# Median us a tick, for how many pressed points.
FINGERTIP_CLAIMS = {12: 50.0, 40: 300.0}
CONSISTENT_CLAIM = 1.0
COUPLING_CLAIM = 3.0
SETTLING = 20
SETTLED = 1e-6

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Slide:
    """A tool on the cube: depth in m, and the height of its reference above its lowest point."""

    name: str
    tool: Tool
    height: float
    depth: float

    def path(self, ticks: int) -> Floats:
        """Places (ticks, 3): around at up to 30 mm/s, up and down about the depth; in the last
        fifth it is set down and lifted thrice a second.
        """
        seconds = np.arange(ticks) * 1e-3
        pressed = 0.7 + 0.3 * np.sin(9.0 * seconds)
        landing = np.sin(6.0 * np.pi * seconds)
        share = np.where(np.arange(ticks) < 0.8 * ticks, pressed, landing)
        return np.column_stack(
            [
                0.025 + 0.006 * np.sin(2.0 * seconds),
                0.025 + 0.006 * np.sin(2.6 * seconds),
                TOP + self.height - self.depth * share,
            ]
        )


def slides() -> Iterator[Slide]:
    """Fingertips of about 12 and 40 points, and the other tools; two reach the most points that a
    tick looks at, one the most corners that a tool may have.
    """
    yield Slide("fingertip, 12", sphere(0.008), 0.008, 0.0013)
    yield Slide("fingertip, 40", sphere(0.008), 0.008, 0.005)
    yield Slide("rod", rod(0.006, 0.012), 0.006, 0.0015)
    yield Slide("long rod", rod(0.005, 0.03), 0.005, 0.0015)
    yield Slide("plate", plate(0.016, 0.016), 0.0, 0.001)
    yield Slide("plate, 3 mm deep", plate(0.016, 0.016), 0.0, 0.003)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.009
    yield Slide("box", convex(corners, 0.003), 0.009, 0.001)
    directions = np.random.default_rng(1).normal(size=(300, 3))
    round_ = 0.009 * directions / np.linalg.norm(directions, axis=1)[:, None]
    yield Slide("64 corners", convex(round_, 0.001), 0.009, 0.002)


def point_paths(ticks: int, fingers: int) -> Floats:
    """Fingers (ticks, fingers, 3) that stroke the top of the cube, from above it on."""
    seconds = np.arange(ticks) * 1e-3
    down = np.minimum(seconds, 0.006)
    paths = [
        np.column_stack(
            [
                0.025 + 0.015 * np.sin(1.3 * seconds + 2.0 * finger),
                0.025 + 0.015 * np.sin(1.7 * seconds + 4.0 * finger),
                TOP + 0.003 - down,
            ]
        )
        for finger in range(fingers)
    ]
    return np.stack(paths, axis=1)


def median_tick(body: Body, fingers: int, mode: ContactMode, ticks: int) -> float:
    """Median us of a whole tick while touching, the quickest of some rounds."""
    paths = point_paths(ticks, fingers)
    costs = [
        np.median(
            SteppedFingers(body, paths[0], Settings(1e4, mode=mode)).costs(paths)[ticks // 5 :]
        )
        for _ in range(ROUNDS)
    ]
    return float(min(costs)) * 1e6


def print_points(body: Body, ticks: int) -> bool:
    """Ticks with point fingers; whether the claims hold."""
    paper = median_tick(body, 1, "paper", ticks)
    consistent = median_tick(body, 1, "consistent", ticks)
    both = median_tick(body, 2, "consistent", ticks)
    print("whole ticks with point fingers, us of CPU, median")
    print(f"  one finger, paper        {paper:7.2f}")
    print(f"  one finger, consistent   {consistent:7.2f}   {consistent - paper:+.2f}")
    coupling = both - 2.0 * consistent
    print(f"  two fingers, consistent  {both:7.2f}   {coupling:+.2f} beside two alone")
    return consistent - paper <= CONSISTENT_CLAIM and coupling <= COUPLING_CLAIM


def slide_costs(
    body: SoftBody, surface: Body, slide: Slide, friction: float, ticks: int
) -> dict[str, NDArray[np.generic]]:
    """What every tick of a tool took."""
    contact = ToolContact(*native_tool(body, surface, slide.tool), friction=friction)
    path = slide.path(ticks)
    way_in = np.linspace(path[0] + [0.0, 0.0, 0.03], path[0], 500)
    upright = np.tile(np.eye(3), (max(ticks, len(way_in)), 1, 1))
    tool_costs(contact, way_in, upright[: len(way_in)], body.young_modulus)
    return tool_costs(
        contact, path, upright[:ticks], body.young_modulus, replay_over=REPLAYED, control=CONTROL
    )


def ticks_to_settle(body: SoftBody, surface: Body, slide: Slide) -> int:
    """Ticks after which the force of a tool that is held still stays what it is in the end."""
    contact = ToolContact(*native_tool(body, surface, slide.tool))
    place = np.array([0.027, 0.024, TOP + slide.height])
    upright = np.eye(3).tolist()
    contact.restart((place + np.array([0.0, 0.0, 0.002])).tolist(), upright)
    ways = np.arange(0.002, -slide.depth, -5e-5)
    forces = []
    for way in [*ways, *[-slide.depth] * 4 * SETTLING]:
        lowered = place + np.array([0.0, 0.0, way])
        contact.follow(lowered.tolist(), upright, body.young_modulus)
        forces.append(contact.force)
    held = np.array(forces[len(ways) :])
    if not held[-1].any():
        return len(held)
    off = np.linalg.norm(held - held[-1], axis=1) > SETTLED * np.linalg.norm(held[-1])
    return int(np.flatnonzero(off).max(initial=-1)) + 1


def expected_by_control(costs: dict[str, NDArray[np.generic]]) -> float:
    """Long ticks that the machine alone makes expect: as many, per second of the control, as its
    rounds were longer by what a usual tick lacks to a long one.
    """
    control, taken = costs["control"], costs["taken"]
    lacking = LONGEST - float(np.median(costs["computing"]))
    longer = (control - np.median(control) > lacking).sum()
    return float(longer * taken[~costs["copied"]].sum() / control.sum())


def print_tools(body: SoftBody, surface: Body, ticks: int, only: str | None) -> bool:
    """Ticks of each tool; whether the claims hold."""
    print("\nticks of a tool's contact, us of CPU")
    print(
        f"{'':<18}{'':>9}{'':>10}{'computing':>9}{'':>8}{'':>9}{'as taken':>10}{'long':>10}"
        f"{'long by':>9}{'long':>11}{'most':>9}{'found':>7}"
    )
    print(
        f"{'tool':<18}{'friction':>9}{'pressed':>10}{'median':>9}{'p99.9':>8}{'longest':>9}"
        f"{'longest':>10}{'as taken':>10}{'control':>9}{'computing':>11}{'1000 mul':>9}{'%':>7}"
    )
    holds = True
    for slide in slides():
        if only and only not in slide.name:
            continue
        over = 0
        for friction in FRICTIONS:
            costs = slide_costs(body, surface, slide, friction, ticks)
            over += int((costs["computing"] > LONGEST).sum())
            print_costs(slide, friction, costs)
            holds &= friction > 0.0 or fingertip_holds(slide, costs, ticks)
        settling = ticks_to_settle(body, surface, slide)
        print(
            f"{'':<18}{'':>9}{'held still':>10}  its force after {settling} ticks, claim {SETTLING}"
        )
        holds &= settling <= SETTLING
        holds &= over <= max(ticks * len(FRICTIONS) // 100_000, 1)
    return holds


def print_costs(slide: Slide, friction: float, costs: dict[str, NDArray[np.generic]]) -> None:
    """One row."""
    computing, pressed = 1e6 * costs["computing"], costs["pressed"]
    taken = 1e6 * costs["taken"][~costs["copied"]]
    middle, higher = np.percentile(computing, [50, 99.9])
    few, many = pressed.min(), pressed.max()
    found = 100.0 * float(costs["exact"].mean())
    print(
        f"{slide.name:<18}{friction:>9g}{f'{few}-{many}':>10}{middle:>9.1f}{higher:>8.1f}"
        f"{computing.max():>9.1f}{taken.max():>10.1f}{(taken > 1e6 * LONGEST).sum():>10}"
        f"{expected_by_control(costs):>9.1f}{(computing > 1e6 * LONGEST).sum():>11}"
        f"{costs['multiplications'].max() / 1000:>9.0f}{found:>7.0f}",
        flush=True,
    )


def fingertip_holds(slide: Slide, costs: dict[str, NDArray[np.generic]], ticks: int) -> bool:
    """Prints the fingertips' medians at so many points beside what is claimed of them."""
    holds = True
    for count, claim in FINGERTIP_CLAIMS.items():
        about = costs["computing"][np.abs(costs["pressed"] - count) <= max(count // 10, 1)]
        if slide.name.startswith("fingertip") and len(about) > ticks // 100:
            median = 1e6 * float(np.median(about))
            print(f"{'':<18}{'':>9}{f'about {count}':>10}{median:>9.1f}   claim {claim:.0f}")
            holds &= median <= claim
    return holds


def main() -> int:
    """Print the tables; 1 where a claim fails."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    arguments.add_argument("--quick", action="store_true", help="a tenth of the ticks")
    arguments.add_argument("--tool", help="only tools with this in their name")
    given = arguments.parse_args()
    ticks = TICKS // 10 if given.quick else TICKS
    mesh, fixed = paper_cube()
    body, _ = bake(mesh, BakeSettings(0.49, 10_000.0, PinNodes(fixed)))
    surface = native_body(body, whole=True)
    holds = print_points(surface, ticks // 2)
    holds &= print_tools(body, surface, ticks, given.tool)
    if not given.tool:
        holds &= print_several(body, surface, ticks // 20)
    if not holds:
        print("a claim does not hold (on an idle machine?)")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
