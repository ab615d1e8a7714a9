"""Energy that points and tools give on random closed paths without friction; none may.

    python benchmarks/contact/energy_loops.py [--loops N] [--seed S] [--body NAME] [--feel NAME]

Fingers come from the air, go in along a normal, twice round an ellipse in any plane, and out as
they came: over facets, edges, corners and thin parts of the sample bodies, points 0.1 to 4 edges of
the mesh deep and wide, tools 0.1 to 2 of their radii (a plate's counts as a third of its length),
in steps of less than a hundredth of the depth, by the servo's own ticks. Work is that of the forces
as sent, by the trapezoidal rule, of all fingers, as a share of F d / 2 (largest force, depth of the
press). Columns: rounds that touched throughout and ended as they began, the share of them that
gave more than 0.1 and 1 %, the most that one gave, and the mean loss of the others; the same of
whole paths, from air to air. *Motors* have the coupling of a device, *cut off* a force limit of 0.6
of what is asked, *far* of 0.03, *two* are beside each other, led together, and *late* are told
another firmness of the body every hundred ticks (at that depth 0.67 to 7 times a linear one's).
Tools, which take some hundred times as long as points, go a fifth as many loops. ``paper`` is as
published, without a claim. Exit status 1 where another one gave more than 0.1 %.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np
from palpate_servo import Body

from palpate.benchmarks.contact.continuity import BODIES, YOUNG_MODULUS, soft_body
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.servo.session import native_body
from palpate.core.servo.settings import Coupling, Settings
from palpate.tests.referees.energy_loops import (
    Books,
    Loop,
    Span,
    books,
    random_loops,
    random_pairs,
)
from palpate.tests.referees.led_tips import Tip, led, tip_of
from palpate.tests.ways.told_firmness import LINEAR, Told, told

MOST = 1e-3
CUT_OFF = 0.6
FAR_CUT_OFF = 0.03
# Radius of a fingertip, in diagonals of the body: the add-on's default.
FINGERTIP = 0.05
TOOL_SHARE = 5


@dataclass(frozen=True)
class Way:
    """A way to be felt, and by what tips.

    Attributes
    ----------
    tips : of each finger, ``point`` or one of `tools_of`.
    motors : newton, what they bear; None without motors.
    cut_off : the force limit, as a share of the most that is asked for; None without one.
    is_late : the body becomes firmer and softer on the way.
    """

    settings: Settings = field(default_factory=lambda: Settings(YOUNG_MODULUS))
    tips: tuple[str, ...] = ("point",)
    motors: float | None = None
    cut_off: float | None = None
    is_late: bool = False


# Firmness of a body, one after the other: 1 + a s + b s^2, s the depth over that of the press, to
# twice that.
LATE = ((0.0, 0.0), (0.25, 0.25), (-1.0 / 3.0, 0.0), (2.0, 4.0))
REACH = 2.0

COUPLED = Settings(YOUNG_MODULUS, coupling=Coupling(800.0, 4.0, passivity_control=True))
WAYS = {
    "paper": Way(Settings(YOUNG_MODULUS, mode="paper")),
    "consistent": Way(),
    "shaded": Way(Settings(YOUNG_MODULUS, shading=True)),
    "motors": Way(COUPLED, motors=3.0),
    "cut off": Way(cut_off=CUT_OFF),
    "cut off far": Way(cut_off=FAR_CUT_OFF),
    "two": Way(tips=("point", "point")),
    "two, motors": Way(COUPLED, ("point", "point"), motors=3.0),
    "fingertip": Way(tips=("fingertip",)),
    "rod": Way(tips=("rod",)),
    "plate": Way(tips=("plate",)),
    "tip, motors": Way(COUPLED, ("fingertip",), motors=3.0),
    "tip, cut off": Way(tips=("fingertip",), cut_off=CUT_OFF),
    "tip, far": Way(tips=("fingertip",), cut_off=FAR_CUT_OFF),
    "two tips": Way(tips=("fingertip", "fingertip")),
    "tip and point": Way(tips=("fingertip", "point")),
    "late": Way(is_late=True),
    "late, motors": Way(COUPLED, motors=3.0, is_late=True),
    "two, late": Way(tips=("point", "point"), is_late=True),
    "tip, late": Way(tips=("fingertip",), is_late=True),
}


def tools_of(body: SoftBody) -> dict[str, Tool]:
    """Tools as large as a body asks for."""
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    radius = FINGERTIP * float(np.linalg.norm(np.ptp(nodes, axis=0)))
    return {
        "fingertip": sphere(radius),
        "rod": rod(0.7 * radius, 3.0 * radius),
        "plate": plate(3.0 * radius, 2.0 * radius, 0.3 * radius),
    }


def span_of(tool: Tool | None) -> Span:
    """How deep and wide loops of a tip are."""
    if tool is None:
        return Span()
    reach = tool.radius if len(tool.core) <= 2 else float(np.ptp(tool.core, axis=0).max()) / 3.0
    return Span(reach, (0.1, 2.0), (0.1, 2.0))


def books_of(native: Body, way: Way, loops: Sequence[Loop], tips: Sequence[Tip]) -> Books | None:
    """The books of fingers that are led together."""
    motors = way.motors
    if way.cut_off is not None:
        path = np.stack([loop.path for loop in loops], axis=1)
        asked, _ = led(native, way.settings, loops, tips)(path)
        motors = way.cut_off * float(np.linalg.norm(asked, axis=2).max()) or None
    firmnesses = late_on(native, loops, tips) if way.is_late else (LINEAR,)
    if firmnesses is None:
        return None
    return books(loops, led(native, way.settings, loops, tips, motors, firmnesses))


def late_on(native: Body, loops: Sequence[Loop], tips: Sequence[Tip]) -> Sequence[Told] | None:
    """:data:`LATE` as it is told of a press as deep as the loops; None where they press nothing."""
    forces, _ = led(native, Settings(YOUNG_MODULUS), loops, tips)(
        np.stack([loop.press for loop in loops], axis=1)
    )
    pressed = np.linalg.norm(forces[-1], axis=1) @ [loop.depth for loop in loops]
    held = 0.5 * float(pressed) / YOUNG_MODULUS
    if held == 0.0:
        return None
    return [told(late, held, REACH) for late in LATE]


def of_body(body: SoftBody, way: Way, count: int, seed: int) -> list[Books]:
    """The books of random loops."""
    tools = tools_of(body)
    has_tools = any(tip in tools for tip in way.tips)
    native = native_body(body, whole=has_tools or len(way.tips) > 1)
    made = {name: tip_of(body, native, tools[name]) for name in set(way.tips) & set(tools)}
    tips = [made.get(name, Tip()) for name in way.tips]
    mesh = body.mesh
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes = mesh.nodes[mesh.surface_nodes]
    span = span_of(tools.get(way.tips[0]))
    loops = list(random_loops(nodes, mesh.surface_local_triangles, free, count, seed, span))
    together: Iterator[Sequence[Loop]] = iter([(loop,) for loop in loops])
    if len(way.tips) > 1:
        together = islice(random_pairs(loops, seed), count)
    found = (books_of(native, way, each, tips) for each in together)
    return [one for one in found if one is not None]


def row(name: str, feel: str, found: list[Books]) -> bool:
    """Prints a row; whether no more came out than claimed."""
    rounds = np.array([gain for one in found for gain in one.rounds])
    paths = np.array([one.path for one in found])
    if not len(rounds):
        print(
            f"{name:<10} {feel:<14} {len(found):6} no round closed: ask for more --loops",
            flush=True,
        )
        return False
    print(
        f"{name:<10} {feel:<14} {len(found):6} {len(rounds):7} {(rounds > MOST).mean():8.2%} "
        f"{(rounds > 0.01).mean():8.2%} {rounds.max():9.3%} {-rounds[rounds < 0].mean():8.1%}   "
        f"{(paths > MOST).mean():8.2%} {paths.max():9.3%} {-paths[paths < 0].mean():8.1%}",
        flush=True,
    )
    return feel == "paper" or max(rounds.max(), paths.max()) <= MOST


def main() -> int:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    arguments.add_argument("--loops", type=int, default=2500, help="of each body and mode")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--body", choices=BODIES)
    arguments.add_argument("--feel", choices=WAYS)
    chosen = arguments.parse_args()
    print("body       felt            loops  rounds   > 0.1 %    > 1 %  most out     loss")
    print(f"{'':77}   > 0.1 %  most out     loss (from air to air)")
    holds = True
    for name in [chosen.body] if chosen.body else BODIES:
        body = soft_body(name)
        for feel in [chosen.feel] if chosen.feel else WAYS:
            way = WAYS[feel]
            is_slow = any(tip != "point" for tip in way.tips)
            count = chosen.loops // (TOOL_SHARE if is_slow else 1)
            holds &= row(name, feel, of_body(body, way, count, chosen.seed))
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
