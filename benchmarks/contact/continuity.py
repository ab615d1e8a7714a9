"""Jumps of the compiled servo's force, for every mode and tool on every sample body.

    python benchmarks/contact/continuity.py [--body NAME] [--no-tools | --no-points]

Fingers go at 100 mm/s (tools 50 mm/s) on paths on which contact is made and broken and that lead
over facets, edges and nodes, through changing patches, beside and through another finger. Every
path is followed in the servo's own steps and in finer ones. Force is the contact force, before
coupling and safety. Columns: the largest force; the largest change in one tick of 1 kHz; the jump,
which is the change at the finest steps that stands out of those before and after it; that as a
share of the force, beside the share that is claimed; and the exponent with which the largest
change falls with the step (1: continuous, 0: jump). Exit status 1 where a claim does not hold.

The pinch scene's body is the cube, the fingertip scene's the mouse, the large scene's the hare.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.contact.finger_paths import (
    beside,
    moved_to_node,
    passing,
    pinch,
    press,
    slide,
)
from palpate.benchmarks.measuring.contact.jumps import RATES, Jump, jump_of
from palpate.benchmarks.measuring.contact.smooth_places import Facets, Place
from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.native_tool import NativeTip
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

Vectors = NDArray[np.float64]
Follow = Callable[[Vectors, int], Vectors]

# Poisson's ratio of each sample scene's body.
BODIES = {"cube": 0.49, "mouse": 0.49, "drumstick": 0.49, "hare": 0.3}
YOUNG_MODULUS = 10_000.0
TOOL_SPEED = 0.05
TOOL_FRICTION = 0.4
TOOL_RATES = (1000, 2000, 4000)
# For presses of some tenths of a millimetre, which are short, and steep where one point bears all.
SHALLOW_RATES = (1000, 4000, 16000)

# Shares of the force. What is continuous leaves this at the finest steps: the bends of its course.
CONTINUOUS = 0.01
# Steep where two fingers come to one place: 50 times as steep as alone.
STEEP = 0.02
# Facets that turn by more than the contact point's lag takes up (19 degrees in a depth's way).
FACETS = 0.04
# Two fingers drawn through each other where facets turn: the one whose force is on the rim of its
# cone snaps aside.
SNAP = 0.10
# From static to dynamic friction of 0.5 and 0.3, while the finger is as deep as before.
LETTING_GO = 0.25
# Without shading the cone of friction turns with the facet's normal.
TURNED_CONE = 0.25
# Where the largest change falls like this there is no jump, only a course too steep for the steps.
SHRINKING = 0.9
# Of a tool, whose ticks end before the displacements have stopped changing.
UNFINISHED = 0.02
# Of flat tools, whose edges are sharper than the contact points lie apart: a point passes round
# such an edge with a snap, for a plate beyond the most points that a tick looks at. The tip of a
# dull cone is carried by one or two points.
SHARP = 0.10
POINTED = 0.25
POINTED_PRESS = 0.05
# Presses less deep than this share of their depth are shallow.
SHALLOW = 0.2
# From how far above tools come, so that a long one begins outside a surface that bends up, metres.
TOOL_LIFT = 0.015


@dataclass(frozen=True)
class Row:
    """A path in a mode: ``claim`` is the largest jump as a share of the force."""

    mode: str
    event: str
    claim: float
    jump: Jump

    @property
    def holds(self) -> bool:
        """Whether anything was felt, and no more jumped than claimed or all still shrinks."""
        jump = self.jump
        return jump.force > 0.0 and (jump.share <= self.claim or jump.exponent >= SHRINKING)


def soft_body(name: str) -> SoftBody:
    """A sample scene's body."""
    mesh, fixed = tets_of(name)
    return bake(mesh, BakeSettings(BODIES[name], YOUNG_MODULUS, PinNodes(fixed)))[0]


def places_of(name: str, body: SoftBody) -> tuple[list[Place], float]:
    """Where the body is touched, and how far about it the paths reach, metres.

    On the cube the middle of the top, elsewhere a place of flat and one of turned facets.
    """
    facets = Facets(body)
    if name == "cube":
        x, z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        return [Place(np.array([0.0221, 0.0268, 0.05]), z, x, 0.0)], 0.01
    reach = 2.0 * facets.edge
    found = [facets.places(bends, reach, 1) for bends in ((0.0, 18.0), (18.0, 35.0))]
    return [place for places in found for place in places], reach


def by_points(
    native: Body, mode: str = "consistent", friction: tuple[float, float] = (0.0, 0.0), **feel: bool
) -> Follow:
    """Contact forces of points, by the servo's own ticks."""

    def follow(path: Vectors, rate: int) -> Vectors:
        fingers = SteppedFingers(
            native,
            path[0],
            Settings(
                YOUNG_MODULUS,
                mode="paper" if mode == "paper" else "consistent",
                static_friction=friction[0],
                dynamic_friction=friction[1],
                **feel,
            ),
            rate_hz=rate,
        )
        return fingers.follow(path)[0]

    return follow


def point_rows(body: SoftBody, native: Body, place: Place, reach: float) -> Iterator[Row]:
    """One and two fingers."""
    depth, length = 0.3 * reach, 1.6 * reach
    line = slide(body, place, depth, length)
    node = slide(body, moved_to_node(body, place), depth, length)
    plain = FACETS if place.bend > 0.0 else CONTINUOUS
    for mode in ("paper", "consistent"):
        follow = by_points(native, mode)
        aside = press(place, depth, 0.05 * reach)
        yield Row(mode, "made and broken", CONTINUOUS, jump_of(follow, aside))
        yield Row(mode, "over facets and edges", plain, jump_of(follow, line))
        yield Row(mode, "over a node", plain, jump_of(follow, node))
    shaded = by_points(native, shading=True)
    yield Row("shaded", "over facets and edges", CONTINUOUS, jump_of(shaded, line))
    rubbed = by_points(native, friction=(0.4, 0.4), shading=True)
    yield Row("shaded, friction 0.4", "over facets, edges", CONTINUOUS, jump_of(rubbed, line))
    rubbed = by_points(native, friction=(0.4, 0.4))
    cone = TURNED_CONE if place.bend > 0.0 else CONTINUOUS
    yield Row("friction 0.4", "over facets and edges", cone, jump_of(rubbed, line))
    letting_go = by_points(native, friction=(0.5, 0.3), shading=True)
    yield Row("shaded, 0.5 to 0.3", "stick to slip", LETTING_GO, jump_of(letting_go, line))
    both = by_points(native)
    near, close = beside(place, depth, 0.5 * reach), beside(place, depth, 0.12 * reach)
    yield Row("two fingers", "beside, comes and goes", STEEP, jump_of(both, near))
    yield Row("two fingers", "on one triangle", STEEP, jump_of(both, close))
    through = passing(place, depth, 0.6 * reach)
    snap = SNAP if place.bend > 0.0 else STEEP
    yield Row("two fingers", "through each other", snap, jump_of(both, through))
    yield Row("two fingers", "pinch", STEEP, jump_of(both, pinch(body, place, depth)))


def by_tool(
    native: Body, made: NativeTip, place: Place, front: float, friction: float = 0.0
) -> Follow:
    """Contact forces of a tool that looks at the place, lifted so that its front is on the path."""
    rotation = np.column_stack([place.along, np.cross(place.normal, place.along), place.normal])
    raised = front * place.normal

    def follow(path: Vectors, rate: int) -> Vectors:
        fingers = SteppedFingers(
            native,
            path[0] + raised,
            Settings(YOUNG_MODULUS, static_friction=friction, dynamic_friction=friction),
            rate_hz=rate,
        )
        fingers.set_tool(made, rotation)
        return fingers.follow(path + raised)[0]

    return follow


@dataclass(frozen=True)
class Pressed:
    """A tool, how deep "deep" is in metres, and what it may jump by drawn along, and pressed."""

    tool: Tool
    deep: float
    drawn: float = UNFINISHED
    pressed: float = UNFINISHED

    @property
    def front(self) -> float:
        """From its reference point to its foremost one, metres."""
        return self.tool.radius if len(self.tool.core) <= 2 else 0.0


def tools_for(name: str) -> list[Pressed]:
    """All kinds of tools; on the cube two fingertips."""
    wide = 0.008 * np.array([[-1, -1, 0.3], [1, -1, 0.3], [1, 1, 0.4], [-1, 1, 0.4], [0, 0, 2]])
    dull = np.vstack([wide, [[0.0, 0.0, 0.0]]])
    radii = (0.004, 0.012) if name == "cube" else (0.008,)
    return [
        *(Pressed(sphere(radius, f"fingertip {1000 * radius:g} mm"), radius) for radius in radii),
        Pressed(rod(0.006, 0.015), 0.006),
        Pressed(plate(0.016, 0.012), 0.006, drawn=SHARP),
        Pressed(convex(dull), 0.004, drawn=POINTED, pressed=POINTED_PRESS),
    ]


def tool_rows(name: str, body: SoftBody, native: Body, place: Place, reach: float) -> Iterator[Row]:
    """One tool after the other."""
    for each in tools_for(name):
        tool, deep = each.tool, each.deep
        contact = native_tool(body, native, tool)
        follow = by_tool(native, contact, place, each.front)
        for share in (0.1, 0.5, 1.0):
            path = from_above(place, press(place, share * deep, 0.05 * reach))
            event = f"made and broken, {share:g} deep"
            rates = SHALLOW_RATES if share < SHALLOW else TOOL_RATES
            yield Row(tool.name, event, each.pressed, jump_of(follow, path, rates, TOOL_SPEED))
        line = from_above(place, slide(body, place, 0.5 * deep, 1.2 * reach, 12))
        yield Row(tool.name, "patch changes, 0.5 deep", each.drawn, tool_jump(follow, line))
        rubbed = by_tool(native, contact, place, each.front, TOOL_FRICTION)
        mode = f"{tool.name}, friction {TOOL_FRICTION:g}"
        half = from_above(place, press(place, 0.5 * deep, 0.05 * reach))
        yield Row(mode, "made and broken, 0.5 deep", each.pressed, tool_jump(rubbed, half))
        yield Row(mode, "patch changes, 0.5 deep", each.drawn, tool_jump(rubbed, line))


def from_above(place: Place, corners: Vectors) -> Vectors:
    """The same path (k, 1, 3) begun and ended farther from the surface."""
    lift = TOOL_LIFT * place.normal
    return np.concatenate([corners[:1] + lift, corners, corners[-1:] + lift])


def tool_jump(follow: Follow, path: Vectors) -> Jump:
    """With fewer and longer steps than points, for the time that they take."""
    return jump_of(follow, path, TOOL_RATES, TOOL_SPEED)


def printed(name: str, row: Row) -> bool:
    """One line of the table; whether its claim holds."""
    jump = row.jump
    print(
        f"| {name} | {row.mode} | {row.event} | {jump.force:.3f} | {jump.step:.4f} "
        f"| {jump.left:.5f} | {100 * jump.share:.2f} % | {100 * row.claim:g} % "
        f"| {jump.exponent:.2f} |{'' if row.holds else ' VIOLATED'}",
        flush=True,
    )
    return row.holds


def main() -> int:
    """Print the table; 1 if a claim does not hold."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--body", choices=BODIES, action="append", help="only this one")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--no-tools", action="store_true", help="points alone: half a minute")
    which.add_argument("--no-points", action="store_true", help="tools alone")
    given = parser.parse_args()
    print(f"finest steps: points {RATES[-1]} Hz, tools {TOOL_RATES[-1]} Hz\n")
    print("| body | mode | event | force, N | in 1 ms, N | jump, N | share | claim | exponent |")
    print("|---|---|---|---|---|---|---|---|---|")
    holds = []
    for name in given.body or BODIES:
        body = soft_body(name)
        native = native_body(body, whole=True)
        places, reach = places_of(name, body)
        for place in () if given.no_points else places:
            where = name if place.bend == 0.0 else f"{name}, facets to {place.bend:.0f} deg"
            holds += [printed(where, row) for row in point_rows(body, native, place, reach)]
        if not given.no_tools:
            rows = tool_rows(name, body, native, places[0], reach)
            holds += [printed(name, row) for row in rows]
    print(f"\n{len(holds) - sum(holds)} of {len(holds)} claims do not hold")
    return 0 if all(holds) else 1


if __name__ == "__main__":
    sys.exit(main())
