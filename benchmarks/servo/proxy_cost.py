"""What a tick of the proxy costs, beside another implementation's, and how that grows.

    python benchmarks/servo/proxy_cost.py [--quick]

On the 192-triangle cube and on a sphere of 2,346 triangles (R 25 mm), the finger slides 3 mm deep
at 100 mm/s, pokes to and fro through the surface at 100 mm/s, hovers 0.1 mm over it, and strokes to
and fro over the same 30 mm, at 1 kHz; then the same on spheres of 200 to 1,000,000 triangles. A
figure is the median over batches of 40 ticks, of god object, contact point and contact force
together. And for the sphere how much the force jumps per tick while sliding 5 mm deep, beyond what
it does on an ideal sphere.

Another implementation takes part when ``PALPATE_PROXY_PEER`` names an executable::

    $PALPATE_PROXY_PEER MESH PATH BATCH OUTPUT plain|shaded

MESH is a text file: a line with the numbers of nodes and triangles, a line of three coordinates (m)
a node, a line of three node numbers (from 0, counter-clockwise seen from outside) a triangle. PATH:
a line with the number of positions, then a line of three coordinates each. It follows the path with
a point (radius 0), prints the nanoseconds per tick of each batch of BATCH positions, a line each,
and writes to OUTPUT for each position the point that makes the force: position + force / stiffness.
Both run in turns, on the same core, and the quickest of the turns counts for either.

``--quick`` measures growth to 20,000 triangles only.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import Proxy

from palpate.core.mesh.paper_cube import paper_cube
from palpate.tests.bodies.golden_sphere import golden_sphere

PEER = "PALPATE_PROXY_PEER"
RADIUS = 0.025
STEP = 1e-4
BATCH = 40
TICKS = 8_000
TURNS = 5
STIFFNESS = 500.0
SIZES = (200, 2_346, 20_000, 200_000, 1_000_000)
QUICK_SIZES = SIZES[:3]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Shape:
    """A closed surface under a name: nodes (n, 3) in m, triangles (m, 3)."""

    name: str
    nodes: Floats
    triangles: NDArray[np.int64]

    def body(self) -> Body:
        """On a bed of equal springs."""
        return Body(self.nodes, self.triangles, np.tile(np.eye(3), (len(self.nodes), 1, 1)))


@dataclass(frozen=True)
class Feel:
    """What the contact point does beyond following the god object, under a name."""

    name: str
    shading: bool = False
    static_friction: float = 0.0
    dynamic_friction: float = 0.0

    def proxy(self, body: Body) -> Proxy:
        """A proxy that feels so."""
        return Proxy(
            body,
            shading=self.shading,
            static_friction=self.static_friction,
            dynamic_friction=self.dynamic_friction,
        )


PLAIN = Feel("shape alone")
SHADED = Feel("shading", shading=True)
RUBBING = Feel("friction", static_friction=0.4, dynamic_friction=0.3)
BOTH = Feel("shading, friction", shading=True, static_friction=0.4, dynamic_friction=0.3)


def sphere(triangle_count: int) -> Shape:
    """A sphere around the origin of exactly so many triangles, if even."""
    return Shape("sphere", *golden_sphere(triangle_count // 2 + 2, RADIUS))


def cube() -> Shape:
    """The paper's cube around the origin."""
    mesh, _ = paper_cube()
    return Shape("cube", mesh.nodes[mesh.surface_nodes] - 0.025, mesh.surface_local_triangles)


def around(radius: float, ticks: int = TICKS) -> Floats:
    """Directions (ticks, 3) along tilted circles, STEP apart at a radius."""
    angle = np.arange(ticks) * STEP / radius
    tilt = 0.5 * np.sin(0.137 * angle)
    ring = np.column_stack(
        [np.cos(angle) * np.cos(tilt), np.sin(angle) * np.cos(tilt), np.sin(tilt)]
    )
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    return np.asarray(ring @ turn.T)


def reach(shape: Shape, directions: Floats) -> Floats:
    """Distances (k,) from the origin to the surface: of a cube by its sides, of a sphere R."""
    if shape.name == "cube":
        return np.asarray(0.025 / np.abs(directions).max(axis=1))
    return np.full(len(directions), RADIUS)


def motions(shape: Shape) -> Iterator[tuple[str, Floats]]:
    """What the finger does, and where it is in each tick (TICKS, 3)."""
    ways = around(0.0225)
    surface = reach(shape, ways)[:, None]
    yield "sliding", ways * (surface - 0.003)
    # 4 mm through the surface and out again within 80 ticks, all over the body.
    stroke = 0.001 - 0.004 * np.abs((np.arange(TICKS) / 40) % 2 - 1)
    pokes = ways[(np.arange(TICKS) // 80) * 80]
    yield "poking", pokes * (reach(shape, pokes) + stroke)[:, None]
    yield "hovering", ways * (surface + 1e-4)
    # To and fro over 30 mm: the same triangles again and again, as fingers do.
    stroke_of = 300 - np.abs(np.arange(TICKS) % 600 - 300)
    yield "stroking", (ways * (surface - 0.003))[stroke_of]


def entry(path: Floats) -> Floats:
    """A way from outside to where a path begins (100, 3)."""
    return np.linspace(1.5, 1.0, 100)[:, None] * path[0]


def our_batches(body: Body, feel: Feel, path: Floats) -> Floats:
    """Nanoseconds per tick of each batch."""
    proxy = feel.proxy(body)
    way_in = entry(path)
    proxy.restart(way_in[0])
    proxy.follow_path(way_in)
    return 1e9 * proxy.time_path(path, BATCH)


@dataclass(frozen=True)
class Peer:
    """The other implementation, and a place for the files that it reads and writes."""

    executable: str
    place: Path

    def follow(self, shape: Shape, path: Floats, mode: str) -> tuple[Floats, Floats]:
        """Nanoseconds per tick of each batch, and the points (k, 3) that make the force."""
        mesh_file, path_file, output = (self.place / name for name in ("mesh", "path", "out"))
        with mesh_file.open("w") as file:
            file.write(f"{len(shape.nodes)} {len(shape.triangles)}\n")
            np.savetxt(file, shape.nodes, fmt="%.17g")
            np.savetxt(file, shape.triangles, fmt="%d")
        way_in = entry(path)[: BATCH * (100 // BATCH)]
        with path_file.open("w") as file:
            file.write(f"{len(way_in) + len(path)}\n")
            np.savetxt(file, np.vstack([way_in, path]), fmt="%.17g")
        printed = subprocess.run(
            [self.executable, mesh_file, path_file, str(BATCH), output, mode],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        batches = np.array(printed.split(), dtype=np.float64)
        return batches[len(way_in) // BATCH :], np.loadtxt(output)[len(way_in) :]


def print_costs(shape: Shape, peer: Peer | None) -> None:
    """Costs of each motion with each feel, and the peer's."""
    body = shape.body()
    for motion, path in motions(shape):
        ours: dict[str, float] = {}
        theirs: dict[str, float] = {}
        for _ in range(TURNS):
            for feel in (PLAIN, SHADED, RUBBING, BOTH):
                median = float(np.median(our_batches(body, feel, path)))
                ours[feel.name] = min(median, ours.get(feel.name, np.inf))
            for mode in ("plain", "shaded") if peer else ():
                median = float(np.median(peer.follow(shape, path, mode)[0]))
                theirs[mode] = min(median, theirs.get(mode, np.inf))
        columns = "".join(f"{value:>19.0f}" for value in [*ours.values(), *theirs.values()])
        print(f"{shape.name:<8}{len(shape.triangles):>6} {motion:<10}{columns}", flush=True)


def excess_jumps(points: Floats, path: Floats) -> Floats:
    """How much more than on the ideal sphere the force jumps from tick to tick, N (k - 1,)."""
    directions = path / np.linalg.norm(path, axis=1, keepdims=True)
    force = STIFFNESS * (points - path)
    ideal = STIFFNESS * (RADIUS * directions - path)
    jump, ideal_jump = (np.linalg.norm(np.diff(f, axis=0), axis=1) for f in (force, ideal))
    return np.asarray(jump - ideal_jump)


def print_smoothness(shape: Shape, peer: Peer | None) -> None:
    """Percentiles of the force's jumps while sliding 5 mm deep at 100 mm/s."""
    path = around(0.02, 20_000) * 0.02
    jumps: dict[str, Floats] = {}
    body = shape.body()
    for feel in (PLAIN, SHADED):
        proxy = feel.proxy(body)
        way_in = entry(path)
        proxy.restart(way_in[0])
        proxy.follow_path(way_in)
        jumps[feel.name] = excess_jumps(proxy.follow_path(path)[0], path)
    for mode in ("plain", "shaded") if peer else ():
        jumps[f"peer, {mode}"] = excess_jumps(peer.follow(shape, path, mode)[1], path)
    print("\nforce jumps a tick beyond the ideal sphere's 0.0125 N, N")
    print(f"{'':<20}{'median':>9}{'p99':>9}{'largest':>9}")
    for name, jump in jumps.items():
        median, high = np.percentile(jump, [50, 99])
        print(f"{name:<20}{median:>9.4f}{high:>9.4f}{jump.max():>9.4f}")


def print_growth(sizes: tuple[int, ...]) -> None:
    """Costs from a few triangles to a million."""
    print(
        f"\n{'triangles':>9}{'Body, s':>9}{'sliding, ns':>14}{'poking, ns':>14}{'hovering, ns':>14}"
    )
    for size in sizes:
        shape = sphere(size)
        start = time.perf_counter()
        body = shape.body()
        building = time.perf_counter() - start
        costs = [
            min(float(np.median(our_batches(body, PLAIN, path))) for _ in range(TURNS))
            for _, path in motions(shape)
        ]
        columns = "".join(f"{cost:>14.0f}" for cost in costs)
        print(f"{len(shape.triangles):>9}{building:>9.2f}{columns}", flush=True)


def main() -> None:
    """Print the three tables."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    arguments.add_argument("--quick", action="store_true", help="up to 20,000 triangles only")
    quick = arguments.parse_args().quick
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    executable = os.environ.get(PEER)
    with tempfile.TemporaryDirectory() as place:
        peer = Peer(executable, Path(place)) if executable else None
        print("a tick's cost, ns" + ("" if peer else f" (no peer: {PEER} names none)"))
        names = [feel.name for feel in (PLAIN, SHADED, RUBBING, BOTH)]
        names += ["peer, plain", "peer, shaded"] if peer else []
        print(f"{'':<25}" + "".join(f"{name:>19}" for name in names))
        for shape in (cube(), sphere(2346)):
            print_costs(shape, peer)
        print_smoothness(sphere(2346), peer)
    print_growth(QUICK_SIZES if quick else SIZES)


if __name__ == "__main__":
    main()
