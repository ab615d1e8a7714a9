"""Presses as deep as a body goes: what is felt and drawn, beside the law's own contact.

The truth is :mod:`.pressed_solid` on the same tetrahedra of smoothed strains. Pressed are a ball of
2.4 edges of the surface's mesh to one radius, a point and a wall to two fifths of the part's
thickness.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.shape.pressed.pressed_solid import Pressed, PressedSolid
from palpate.benchmarks.measuring.shape.pressed.pressers import Ball, Presser, Wall
from palpate.benchmarks.measuring.shape.pressed.rows import Row
from palpate.benchmarks.measuring.standing import standing_body
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.place import Place, nearest_place
from palpate.core.contact.single_press import press_tool, touch_at
from palpate.core.contact.tool.pose import Pose, facing
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.contact.touches import Touch
from palpate.core.law.of_material import RUBBER
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.felt import felt, loads_of
from palpate.core.shape.meeting import settled
from palpate.core.shape.shapes import Shape, shape
from palpate.core.softness.parallel_rays import thickness
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.bodies.soft_block import block_mesh

Array = NDArray[np.float64]

# Laws, and the Poisson's ratio of the bodies that have them here.
LAWS = {RUBBER: 0.45, "foam": 0.2, "fibres": 0.2, "natural-rubber": 0.45}
BODIES = ("cube", "mouse-1.7k", "drumstick", "hare", "bar")
# Walls come down on these; what is slender would be bent, or touched at its pins.
WALLED = ("cube", "mouse-1.7k")
BALL_EDGES = 2.4
BALL_DEPTHS, WALL_DEPTHS, POINT_DEPTHS = (0.5, 0.75, 1.0), (0.1, 0.2, 0.4), (0.1, 0.2, 0.4)
PLACES_SEED = 1999
DEEPEST = 0.4  # of the part's thickness, what a ball goes in at most


@cache
def mesh_of(name: str) -> tuple[TetMesh, NDArray[np.int64]]:
    """Tetrahedra and pins of one of :data:`BODIES`, or what a bake makes of a mesh's file."""
    if Path(name).is_file():
        body = standing_body(Path(name))
        return body.mesh, body.fixed
    if name == "cube":
        return paper_cube(cells=10)
    if name == "bar":
        mesh = block_mesh((0.12, 0.02, 0.02), (24, 4, 4))
        return mesh, np.flatnonzero(mesh.nodes[:, 0] == 0.0)
    return tets_of(name)


@dataclass(frozen=True, eq=False)
class Bench:
    """One body, ready to be pressed."""

    name: str
    is_walled: bool
    body: SoftBody
    solid: PressedSolid
    shape: Shape

    @classmethod
    def of(cls, name: str, law: str, poisson_ratio: float | None = None) -> Bench:
        """A body with smoothed strains, of a law of :data:`LAWS` and 1 Pa; see :func:`mesh_of`."""
        ratio = LAWS[law] if poisson_ratio is None else poisson_ratio
        body = replace(baked_body(*mesh_of(name), ratio, 1.0, "smoothed"), law=law)
        real = shape(body, "real")
        real.wait_for(body.mesh.surface_nodes[:1])
        told = Path(name).stem if Path(name).is_file() else name
        told = told if law == RUBBER else f"{told}, {law}"
        return cls(told, name in WALLED, body, PressedSolid(body), real)

    def at_place(self, place: Place, number: int) -> Iterator[Row]:
        """A ball and a point at a place of the surface."""
        outward = -place.axis
        through = thickness(self.body, place)
        radius = BALL_EDGES * self.solid.edge
        depths = [radius * share for share in BALL_DEPTHS if radius * share <= DEEPEST * through]
        yield from self.by_ball(place, radius, depths, through, f"ball {number}")
        ways = np.array([share * through * place.axis for share in POINT_DEPTHS])
        pressed = self.solid.by_point(place.triangle, place.alpha, ways)
        for share, way, true in zip(POINT_DEPTHS, ways, pressed, strict=True):
            touch = touch_at(self.body, place.triangle, place.alpha, way)
            yield self.row(f"point {number}", (share, share), share <= 0.2, true, touch, outward)

    def by_ball(
        self, place: Place, radius: float, depths: list[float], through: float, name: str
    ) -> Iterator[Row]:
        """A ball whose front goes in at a place, to these depths."""
        outward, tool = -place.axis, sphere(radius)
        middles = [place.position + (radius - depth) * outward for depth in depths]
        pressed = self.solid.by_tools([Ball(middle, radius) for middle in middles], outward)
        for depth, middle, true in zip(depths, middles, pressed, strict=True):
            near = depth <= min(0.5 * radius, 0.2 * through)
            touch = press_tool(self.body, tool, Pose.at(middle))
            yield self.row(name, (depth / radius, depth / through), near, true, touch, outward)

    def by_wall(self, outward: Array) -> Iterator[Row]:
        """A wall that comes against the body from ``outward`` (3,), unit."""
        nodes = self.body.mesh.nodes[self.body.mesh.surface_nodes]
        place = nearest_place(self.body, nodes[(nodes @ outward).argmax()])
        inward = Place(place.position, -outward, place.triangle, place.alpha)
        through = thickness(self.body, inward)
        size = 2.0 * float(np.ptp(nodes, axis=0).max())
        aside = nodes.mean(axis=0) - place.position
        over = place.position + aside - (aside @ outward) * outward
        tool, turn = plate(size, size), facing(outward, np.eye(3)[0])
        faces = [over - share * through * outward for share in WALL_DEPTHS]
        walls: list[Presser] = [Wall(face, outward) for face in faces]
        pressed = self.solid.by_tools(walls, outward)
        for share, face, true in zip(WALL_DEPTHS, faces, pressed, strict=True):
            touch = press_tool(self.body, tool, Pose.at(face, turn))
            yield self.row("wall", (share, share), share <= 0.2, true, touch, outward)

    def row(
        self,
        name: str,
        depths: tuple[float, float],
        near: bool,
        true: Pressed,
        touch: Touch,
        outward: Array,
    ) -> Row:
        """One press beside the truth."""
        force, linear = -float(true.force @ outward), float(touch.force @ outward)
        surface = true.displacements[self.solid.solid.surface]
        met = settled(self.body, self.shape, loads_of([touch]), 1.0)
        real = felt(self.shape, [touch], 1.0)
        linear_drawn, real_drawn = (
            farthest_off(one, surface) for one in (met.linear, met.displacements)
        )
        pressed = float(real.touches[0].force @ outward)
        return Row(
            f"{self.name}, {name}",
            *depths,
            near,
            true.places,
            true.is_stable,
            1e6 * force,
            linear / force,
            pressed / force,
            real.firmness.is_whole,
            (linear_drawn, real_drawn),
        )


def farthest_off(drawn: Array, true: Array) -> float:
    """The largest error of displacements (n, 3), over the largest of the true ones."""
    error = np.linalg.norm(drawn - true, axis=1).max()
    return float(error / np.linalg.norm(true, axis=1).max())


def places_on(body: SoftBody, count: int, rng: np.random.Generator) -> Iterator[Place]:
    """Places in the upper three quarters of a body, inside free triangles."""
    corners = body.mesh.nodes[body.mesh.surface_triangles]
    held = np.isin(body.mesh.surface_triangles, body.fixed).any(axis=1)
    lowest, highest = np.quantile(body.mesh.nodes[:, 2], (0.0, 1.0))
    high = corners.mean(axis=1)[:, 2] > lowest + 0.25 * (highest - lowest)
    for triangle in rng.choice(np.flatnonzero(~held & high), count, replace=False):
        yield nearest_place(body, rng.dirichlet([2.0, 2.0, 2.0]) @ corners[triangle])


def rows_of(bench: Bench, count: int) -> Iterator[Row]:
    """All presses of one body; the same in every run."""
    rng = np.random.default_rng(PLACES_SEED)
    for number, place in enumerate(places_on(bench.body, count, rng), start=1):
        yield from bench.at_place(place, number)
    if bench.is_walled:
        yield from bench.by_wall(np.array([0.0, 0.0, 1.0]))
