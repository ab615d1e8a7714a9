"""Bodies that nobody holds, pressed as deep as they go: what is felt and drawn, and the truth.

The truth is :mod:`.lying_solid` on the same tetrahedra of smoothed strains.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from math import nan

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.shape.pressed.deep_press import LAWS, farthest_off
from palpate.benchmarks.measuring.shape.pressed.hands import floor_wall
from palpate.benchmarks.measuring.shape.pressed.lying_solid import Lying, LyingSolid
from palpate.benchmarks.measuring.shape.pressed.pressers import Presser
from palpate.benchmarks.measuring.shape.pressed.resting_press import Depth, Press, presses_of
from palpate.benchmarks.measuring.shape.pressed.rows import Row
from palpate.core.body.soft_body import SoftBody
from palpate.core.law.of_material import RUBBER
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.rest.refusals import RestlessError, SwallowedError
from palpate.core.rest.rest import Rest
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.shapes import Shape, shape
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.bodies.free_shapes import NO_PINS, blown_up
from palpate.tests.bodies.soft_block import block_mesh

Array = NDArray[np.float64]

AIR = 1e-3
# Without gravity bodies weigh nothing, whatever their density; that tells how drag is spread.
SMOOTH = RestSettings(friction=0.0, gravity=(0.0, 0.0, 0.0))
BALL_RADIUS = 0.03


@dataclass(frozen=True, eq=False)
class RestingBench:
    """One body, ready to be pressed."""

    name: str
    told: str
    body: SoftBody
    solid: LyingSolid
    shapes: tuple[Shape, ...]

    @classmethod
    def of(cls, name: str, law: str, *, is_linear: bool = False) -> RestingBench:
        """A body without pins, of smoothed strains and 1 Pa, of a law of :data:`LAWS`; linear
        alone, where nothing is asked of *Real*.
        """
        whole = baked_body(mesh_of(name), NO_PINS, LAWS[law], 1.0, "smoothed", density=1.0)
        body = replace(whole, law=law)
        shapes = () if is_linear else (shape(body, "real"),)
        told = name if law == RUBBER else f"{name}, {law}"
        return cls(name, told, body, LyingSolid(body), shapes)

    def rows(self) -> Iterator[Row]:
        """All presses of the body."""
        for press in presses_of(self.name, self.body, self.solid.edge):
            yield from self._pressed(press)

    def close(self) -> None:
        """End what *Real* keeps."""
        for one in self.shapes:
            one.close()

    def _pressed(self, press: Press) -> Iterator[Row]:
        linear, real = self._rests(press, ()), self._rests(press, self.shapes)
        for depth, true in zip(press.depths, self._truths(press), strict=True):
            yield self._row(press, depth, true, (next(linear), next(real)))

    def _truths(self, press: Press) -> Iterator[Lying]:
        """At every depth; the body is looked at half way to it, too, so as not to miss its rest."""
        ends = pairwise([0.0, *(depth.way for depth in press.depths)])
        ways = [way for before, after in ends for way in (0.5 * (before + after), after)]
        touching = [self._touching(press, way) for way in ways]
        yield from islice(self.solid.among(touching), 1, None, 2)

    def _touching(self, press: Press, way: float) -> list[Presser]:
        tools = [hand.presser for hand in press.hands(way)]
        return [*tools, *(floor_wall(floor) for floor in press.floors)]

    def _rests(self, press: Press, shapes: tuple[Shape, ...]) -> Iterator[Rest | None]:
        """At every depth, by the ``shapes`` or linear; None from where it does not come to rest."""
        tools = [(hand.tool, hand.pose) for hand in press.hands(-AIR)]
        lying = Resting(self.body, press.floors, tools, settings=SMOOTH)
        lying.step()
        is_lost = False
        for depth in press.depths:
            try:
                lying.lead([hand.pose for hand in press.hands(depth.way)])
                rest = settle_firmly(lying, shapes)[0] if shapes else lying.settle()
            except (RestlessError, SwallowedError):
                is_lost = True
            # Out from beneath the tools it rests, too.
            is_lost = is_lost or not all(touch.force.any() for touch in rest.tools)
            yield None if is_lost else rest

    def _row(
        self, press: Press, depth: Depth, true: Lying, rests: tuple[Rest | None, Rest | None]
    ) -> Row:
        force = float(true.forces[0] @ press.inward)
        at_rest = self.body.mesh.nodes[self.body.compliance.free_surface]
        moved = true.displacements[self.solid.solid.surface]

        def felt(rest: Rest | None) -> float:
            return nan if rest is None else float(rest.tools[0].force @ press.inward) / force

        def drawn(rest: Rest | None) -> float:
            return nan if rest is None else farthest_off(rest.surface() - at_rest, moved)

        return Row(
            f"{self.told}, {press.name}",
            depth.radii,
            depth.share,
            depth.is_near,
            true.places,
            true.is_stable,
            1e6 * force,
            -felt(rests[0]),
            -felt(rests[1]),
            rests[1] is not None,
            (drawn(rests[0]), drawn(rests[1])),
        )


def mesh_of(name: str) -> TetMesh:
    """Tetrahedra of a body that lies, or of a stored one."""
    if name == "cube":
        return paper_cube(cells=10)[0]
    if name == "ball":
        return blown_up(paper_cube(2.0, cells=10)[0], BALL_RADIUS)
    if name == "bar":
        return block_mesh((0.12, 0.02, 0.02), (24, 4, 4))
    return tets_of(name)[0]
