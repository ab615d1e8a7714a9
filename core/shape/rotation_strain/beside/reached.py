"""Places of a surface that tools reach, three of each triangle, and what they tell of a touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls

from ....body.imprinted_body import ImprintedBody, as_touched
from ....body.soft_body import SoftBody
from ....contact.near_field.contact_points import ContactPoints
from ....contact.near_field.surface_shape import face_areas, face_normals
from ...solid.free_solid import FreeSolid
from ..finger_load import FingerLoad, Setting
from ..lying import Loose

Array = NDArray[np.float64]

# Places of a triangle, each for a third of its area.
PLACES = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0
# Points of a triangle, by its places: at nodes, on quarters of edges, and between.
QUARTERS = np.array([[i, j, 4 - i - j] for i in range(5) for j in range(5 - i)]) / 4.0
BETWEEN = QUARTERS @ np.linalg.inv(PLACES)
# Pressure over depth where a place is within a tool, times the mean edge, per pascal.
FIRMNESS = 30.0
# What lies within so many edges of a tool at rest may meet it.
MARGIN_EDGES = 2.0
# What lies farther from a tool than so many edges in the linear contact does not press in it.
NEARLY = 0.5
# Triangles at most: the compliance of what presses is factored again and again.
MOST_TRIANGLES = 2000

_places: WeakKeyDictionary[SoftBody, ContactPoints] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Reached:
    """Places that tools may meet, at unit modulus.

    Attributes
    ----------
    tools : each where it is.
    places : of each tool, all that are known of its own.
    near : of each tool, the numbers (p,) of its places among all of the surface.
    which : (p,), the tool of each place.
    free : (p, 3), the free nodes about it.
    shares : (p, 3), its area coordinates; none of what does not move.
    rests : (p, 3), where it is at rest, metres.
    firmness : (p,), force over depth, N/m at 1 Pa.
    known : (p, 3), the same nodes among those of the compliance.
    compliance : (k, k, 3, 3) between these, m/N at 1 Pa.
    gives : whether they give way by that, and are not held off until they do not.
    """

    tools: Sequence[Setting]
    places: Sequence[ContactPoints]
    near: Sequence[NDArray[np.int64]]
    which: NDArray[np.int64]
    free: NDArray[np.int64]
    shares: Array
    rests: Array
    firmness: Array
    known: NDArray[np.int64]
    compliance: Array
    gives: bool = False

    @classmethod
    def of(
        cls,
        body: SoftBody,
        solid: FreeSolid,
        loads: Sequence[FingerLoad],
        loose: Loose | None = None,
    ) -> Reached | None:
        """By the tools of ``loads``; None where they are none or reach too much."""
        whole = [(load, load.by) for load in loads if load.by is not None]
        if len(whole) < len(loads):
            return None
        near = [_near(load, by) for load, by in whole]
        if not 0 < sum(map(len, near)) <= 3 * MOST_TRIANGLES:
            return None
        tools = [by for _, by in whole]
        places = [places_of(by.body).taken(one) for by, one in zip(tools, near, strict=True)]
        triangles, alphas, rests, areas = (
            np.concatenate([getattr(one, name) for one in places])
            for name in ("triangles", "alphas", "positions", "areas")
        )
        corners = body.mesh.surface_triangles[triangles]
        free = np.searchsorted(solid.free, corners)
        free[free == solid.node_count] = 0
        moves = solid.free[free] == corners
        seen, known = np.unique(corners, return_inverse=True)
        local = np.searchsorted(body.mesh.surface_nodes, seen)
        compliance = body.surface_blocks(local, local)
        if loose is not None:
            compliance = compliance + loose.compliance(np.searchsorted(solid.free, seen))
        return cls(
            tools,
            places,
            near,
            np.repeat(np.arange(len(near)), [len(one) for one in near]),
            np.where(moves, free, 0),
            np.where(moves, alphas, 0.0),
            rests,
            FIRMNESS / usual_edge(body) * areas,
            known.reshape(-1, 3),
            compliance,
        )

    def moved(self, displacements: Array) -> Array:
        """Where the places are, (p, 3), at displacements (f, 3) of the free nodes."""
        ways = np.einsum("pa,pai->pi", self.shares, displacements[self.free])
        there: Array = self.rests + ways
        return there

    def on_bed(self, linear: Array, forces: Array, share: float) -> Reached | None:
        """With the near field beneath them, or so much of its give; None where it gives nothing.

        In the linear contact nodes are at displacements ``linear`` (f, 3), and triangles within the
        tools by what the near field dents the surface between nodes: as much as springs give, of
        one pressure for a depth, that carry the ``forces`` (k, 3) of the tools.
        """
        distance, _ = self.distances(self.moved(linear))
        within = np.maximum(-distance, 0.0)
        firmer = np.zeros(len(within))
        for one, force in enumerate(np.linalg.norm(forces, axis=1)):
            own = self.which == one
            carried = float(self.firmness[own] @ within[own])
            if not carried > 0.0:
                return None
            firmer[own] = force / carried
        return replace(self, firmness=self.firmness * firmer / share, gives=True)

    def on_springs(self, times: float) -> Reached:
        """Where each gives on a spring, so many times as firm as what holds it off here."""
        return replace(self, firmness=times * self.firmness, gives=True)

    def distances(self, there: Array) -> tuple[Array, Array]:
        """Distances (p,) of places (p, 3) from their tools, negative within, and normals (p, 3)."""
        distance, out = np.zeros(len(there)), np.zeros_like(there)
        for one, by in enumerate(self.tools):
            own = self.which == one
            distance[own], normals = by.tool.distance(by.pose.to_tool(there[own]))
            out[own] = normals @ by.pose.rotation.T
        return distance, out

    def within(self, displacements: Array) -> float:
        """How far the triangles of the places are within tools at most, metres."""
        there, deepest = self.moved(displacements), 0.0
        for one, (by, near) in enumerate(zip(self.tools, self.near, strict=True)):
            first = np.flatnonzero(near[2:] == near[:-2] + 2)
            first = first[near[first] % 3 == 0]
            places = there[self.which == one][first[:, None] + np.arange(3)]
            between = np.einsum("qa,tai->tqi", BETWEEN, places).reshape(-1, 3)
            distance, _ = by.tool.distance(by.pose.to_tool(between))
            deepest = max(deepest, -float(distance.min(initial=0.0)))
        return deepest

    def pushes(self, linear: Array) -> Array:
        """Forces (p, 3), N at 1 Pa, with which tools would press a linear body at these places.

        By the normals at its displacements ``linear`` (f, 3): a linear complementarity problem of
        a positive definite matrix is one of least squares that are not negative (R. W. Cottle,
        J.-S. Pang, R. E. Stone: The Linear Complementarity Problem, 1992, section 1.2).
        """
        there = self.moved(linear)
        distance, out = self.distances(there)
        depth = np.einsum("pi,pi->p", out, there - self.rests) - distance
        away = NEARLY * usual_edge(self.tools[0].body)
        within = np.flatnonzero((depth > 0.0) & (distance < away))
        found = np.zeros_like(there)
        if len(within):
            yields = self._compliance_along(within, out[within])
            upper = cholesky(yields + np.diag(1.0 / self.firmness[within]))
            sizes, _ = nnls(upper, solve_triangular(upper, depth[within], trans=1))
            found[within] = sizes[:, None] * out[within]
        return found

    def of_tools(self, pushes: Array) -> Array:
        """The force (k, 3) of each tool, of those on the places (p, 3)."""
        forces = np.zeros((len(self.tools), 3))
        np.add.at(forces, self.which, pushes)
        return forces

    def _compliance_along(self, places: NDArray[np.int64], ways: Array) -> Array:
        count = len(self.compliance)
        rows = np.zeros((len(places), count, 3))
        for corner in range(3):
            shares = self.shares[places, corner][:, None] * ways
            np.add.at(rows, (np.arange(len(places)), self.known[places, corner]), shares)
        flat = rows.reshape(len(places), -1)
        found: Array = flat @ self.compliance.transpose(0, 2, 1, 3).reshape(3 * count, -1) @ flat.T
        return 0.5 * (found + found.T)


def places_of(body: SoftBody) -> ContactPoints:
    """All places (3 t,) of a surface of t triangles, where contact meets it; kept with the body."""
    if body not in _places:
        _places[body] = _all_places(body)
    return _places[body]


def _all_places(body: SoftBody) -> ContactPoints:
    mesh = body.mesh
    at_rest = body.at_rest if isinstance(body, ImprintedBody) else body
    triangles = np.repeat(np.arange(len(mesh.surface_triangles)), 3)
    alphas = np.tile(PLACES, (len(mesh.surface_triangles), 1))
    corners = at_rest.mesh.nodes[mesh.surface_triangles[triangles]]
    return ContactPoints(
        as_touched(body, np.einsum("pa,pai->pi", alphas, corners)),
        face_normals(mesh)[triangles],
        triangles,
        alphas,
        face_areas(mesh)[triangles] / 3.0,
    )


def _near(load: FingerLoad, by: Setting) -> NDArray[np.int64]:
    """Places (p,) of free triangles that face a tool and may meet it."""
    mesh, places = by.body.mesh, places_of(by.body)
    distance, _ = by.tool.distance(by.pose.to_tool(places.positions))
    facing = places.normals @ load.forces.sum(axis=0) < 0.0
    free = ~np.isin(mesh.surface_triangles[places.triangles], by.body.fixed)
    return np.flatnonzero(
        facing & free.any(axis=1) & (distance < MARGIN_EDGES * usual_edge(by.body))
    )


def usual_edge(body: SoftBody) -> float:
    """Of a usual triangle of the surface, metres."""
    return float(np.sqrt(2.0 * np.median(face_areas(body.mesh))))
