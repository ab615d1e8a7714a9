"""The largest change of a force within a tick, for all modes, tools and ways of touching.

    python benchmarks/contact_continuity.py [--tools] [BODY.npz ...]

Beside the paper's cube and ``mouse-1.7k``, any baked body. One finger is drawn over the highest
part of the body at a constant depth, over edges, nodes and (tools) through patches that change; and
it is put down and lifted, so that contact is made and broken. Two points are put down beside each
other, and drawn through each other. Every path is walked with two lengths of step. A force that is
continuous changes half as much in half the step: its ratio is about 2, that of a jump about 1.

Where the god object itself jumps (over a sharp convex edge, out of a thin wall), so does the force.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
from measuring.bodies import stored_body
from numpy.typing import NDArray
from palpate_servo import Proxy, ToolContact

from palpate.core import cache
from palpate.core.bake import bake
from palpate.core.bake_settings import BakeSettings
from palpate.core.contact import CONTACT_MODES, ContactMode
from palpate.core.paper_cube import paper_cube
from palpate.core.pins import PinNodes
from palpate.core.pressing_fingers import fingers_at, press_fingers
from palpate.core.servo_session import native_body, native_tool
from palpate.core.soft_body import SoftBody
from palpate.core.tools import Tool, plate, rod, sphere

Array = NDArray[np.float64]
Walk = Callable[[Array], Array]

# Steps of the fingers, as shares of the body's size: half a millimetre a tick on the mouse is fast.
STEPS = (2e-3, 1e-3)
DEPTH = 0.02
LENGTH = 0.25


def highest_line(body: SoftBody) -> tuple[Array, Array, float]:
    """The highest place (3,), a horizontal direction (3,), the size in metres."""
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    size = float(np.ptp(nodes, axis=0).max())
    top = nodes[:, 2].max()
    near_top = nodes[nodes[:, 2] > top - 0.02 * size]
    centre = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
    place = near_top[np.linalg.norm(near_top - centre, axis=1).argmin()]
    longest = int(np.ptp(nodes[:, :2], axis=0).argmax())
    along = np.array([0.9, 0.43, 0.0]) if longest == 0 else np.array([0.43, 0.9, 0.0])
    return place, along / np.linalg.norm(along), size


def points_between(corners: list[Array], step: float) -> Array:
    """A polygon walked in steps no longer than ``step``, (t, 3)."""
    parts = [corners[0][None]]
    for start, end in pairwise(corners):
        count = int(np.ceil(np.linalg.norm(end - start) / step))
        parts.append(start + (end - start) * np.linspace(0, 1, count + 1)[1:, None])
    return np.concatenate(parts)


def drawn_along(body: SoftBody, step: float) -> tuple[Array, int]:
    """Down, along the surface at a depth, and the tick at which it is down."""
    place, along, size = highest_line(body)
    up = np.array([0.0, 0.0, size])
    reach = np.linspace(-0.5, 0.5, 9)
    tops = [_top(body, place + share * LENGTH * size * along) for share in reach]
    down = points_between([tops[0] + 0.01 * up, tops[0] - DEPTH * up], step * size)
    return np.concatenate(
        [down, points_between([top - DEPTH * up for top in tops], step * size)[1:]]
    ), len(down)


def up_and_down(body: SoftBody, step: float) -> Array:
    """Down beside the highest place and up again."""
    place, along, size = highest_line(body)
    up = np.array([0.0, 0.0, size])
    at = _top(body, place + 0.03 * size * along)
    return points_between([at + 0.01 * up, at - DEPTH * up, at + 0.01 * up], step * size)


def _top(body: SoftBody, above: Array) -> Array:
    """The highest place of the surface on the vertical of a place."""
    corners = body.mesh.nodes[body.mesh.surface_triangles]
    ab, ac = (corners[:, k, :2] - corners[:, 0, :2] for k in (1, 2))
    whole = _turn(ab, ac)
    seen = np.abs(whole) > 1e-12 * np.abs(whole).max()
    corners, ab, ac, whole = corners[seen], ab[seen], ac[seen], whole[seen]
    to = above[:2] - corners[:, 0, :2]
    v, w = _turn(to, ac) / whole, _turn(ab, to) / whole
    alpha = np.stack([1 - v - w, v, w], axis=1)
    inside = (alpha >= -1e-9).all(axis=1)
    heights = np.einsum("tc,tc->t", alpha, corners[:, :, 2])[inside]
    return np.array([above[0], above[1], heights.max()])


def _turn(a: Array, b: Array) -> Array:
    turned: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return turned


def by_point(body: SoftBody, mode: ContactMode) -> Walk:
    """Forces (t, 3) of a point along a path (t, 3)."""
    native = native_body(body)

    def walk(path: Array) -> Array:
        proxy, forces = Proxy(native), np.zeros_like(path)
        proxy.restart(path[0])
        for tick, probe in enumerate(path):
            touching, at, triangle, alpha = proxy.move(probe)
            if touching:
                forces[tick] = body.touch(triangle, alpha, probe - at, mode=mode).force
        return forces

    return walk


def by_tool(body: SoftBody, tool: Tool) -> Walk:
    """Forces (t, 3) of a tool whose foremost point goes along a path (t, 3)."""
    contact: ToolContact = native_tool(body, native_body(body, whole=True), tool)
    lift = np.array([0.0, 0.0, tool.radius - tool.core[:, 2].min()])

    def walk(path: Array) -> Array:
        forces = np.zeros_like(path)
        above = path[0] + lift + [0.0, 0.0, body.mesh.nodes[:, 2].max()]
        contact.restart(above, np.eye(3))
        for between in np.linspace(above, path[0] + lift, 200):
            contact.follow(between, np.eye(3), body.young_modulus)
        for tick, probe in enumerate(path):
            contact.follow(probe + lift, np.eye(3), body.young_modulus)
            forces[tick] = contact.force
        return forces

    return walk


def by_two(body: SoftBody, apart: Callable[[int], Array]) -> Walk:
    """Forces (t, 6) of two points, the second ``apart(ticks)`` (t, 3) from the first."""
    native = native_body(body)

    def walk(path: Array) -> Array:
        probes = np.stack([path, path + apart(len(path))], axis=1)
        proxies = [Proxy(native), Proxy(native)]
        for one, start in zip(proxies, probes[0], strict=True):
            one.restart(start)
        fingers, forces = fingers_at(body, probes[0]), np.zeros((len(path), 6))
        for tick, at in enumerate(probes):
            fingers = press_fingers(body, proxies, fingers, at)
            forces[tick] = np.concatenate([finger.force for finger in fingers])
        return forces

    return walk


def rows(body: SoftBody, *, tools: bool) -> Iterator[tuple[str, list[Array]]]:
    """What touches how, and its forces at both lengths of step."""
    _, along, size = highest_line(body)
    sideways = np.cross([0.0, 0.0, 1.0], along)
    ones: list[tuple[str, Walk]] = [
        (f"point, {mode}", by_point(body, mode)) for mode in CONTACT_MODES
    ]
    if tools:
        shapes = (
            sphere(0.16 * size, "fingertip"),
            rod(0.1 * size, 0.2 * size, "rod"),
            plate(0.3 * size, 0.2 * size),
        )
        ones.extend((tool.name, by_tool(body, tool)) for tool in shapes)
    for name, walk in ones:
        dragged = [drawn_along(body, step) for step in STEPS]
        yield f"{name}: over edges and nodes", [walk(path)[down:] for path, down in dragged]
        yield (
            f"{name}: made and broken",
            [walk(up_and_down(body, step)) for step in STEPS],
        )
    beside = by_two(body, lambda ticks: np.tile(0.04 * size * sideways, (ticks, 1)))
    yield "two points beside each other", [beside(up_and_down(body, step)) for step in STEPS]

    def crossing(ticks: int) -> Array:
        return np.linspace(-0.04, 0.04, ticks)[:, None] * size * sideways

    through = by_two(body, crossing)
    dragged = [drawn_along(body, step) for step in STEPS]
    yield "two points through each other", [through(path)[down:] for path, down in dragged]


def print_table(name: str, body: SoftBody, *, tools: bool) -> None:
    """One line a row: largest change in a tick as a share of the largest force, and the ratio."""
    print(f"\n{name}: {body.compliance.node_count} free surface nodes")
    print(f"{'':44}{'largest N':>10}{'step':>9}{'half step':>11}{'ratio':>7}")
    for what, walked in rows(body, tools=tools):
        most = max(float(np.abs(forces).max()) for forces in walked)
        if most == 0.0:
            print(f"{what:44}  touches nothing")
            continue
        jumps = [float(np.abs(np.diff(forces, axis=0)).max()) / most for forces in walked]
        print(
            f"{what:44}{most:10.3f}{jumps[0]:9.4f}{jumps[1]:11.4f}{jumps[0] / jumps[1]:7.2f}",
            flush=True,
        )


def main() -> None:
    """Print a table for each body."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bodies", nargs="*", type=Path, metavar="BODY.npz")
    parser.add_argument("--tools", action="store_true", help="also tools: a minute for each body")
    given = parser.parse_args()
    mesh, fixed = paper_cube()
    cube = bake(mesh, BakeSettings(0.49, 1e4, PinNodes(fixed)))[0]
    print_table("cube", cube, tools=given.tools)
    mouse = stored_body("mouse-1.7k")
    settings = BakeSettings(0.3, 1e3, PinNodes(mouse.fixed), form="dense")
    print_table(mouse.name, bake(mouse.mesh, settings)[0], tools=given.tools)
    for file in given.bodies:
        print_table(file.name, cache.load(file), tools=given.tools)


if __name__ == "__main__":
    main()
