"""A referee of contact that shares no law with the engine: least elastic energy, by scipy.

Among all forces on a body's contact points that keep the points out of every tool, and bring each
finger's point to where its finger has it, those of least elastic energy are looked for by
sequential quadratic programming. There are no pushes, no friction and no pairs of tools in it: a
point is displaced once, and has to be outside of all of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize, nnls

from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.tool.tool_surface import surface_and_correction

# Points within this share of a tool's radius of it at rest may be touched.
NEAR = 0.6


@dataclass(frozen=True, eq=False)
class Held:
    """A finger's point: its place on the surface, and how far it is moved from there, metres."""

    triangle: int
    alpha: np.ndarray
    by: np.ndarray


def least_energy(body, tools, held=()):
    """Forces felt by tools (t, 3), (tool, pose) of one spacing, and by held points (h, 3), N."""
    surface, correction = surface_and_correction(body, tools[0][0])
    gaps = [tool.distance(pose.to_tool(surface.positions))[0] for tool, pose in tools]
    near = [gap < NEAR * tool.radius for gap, (tool, _) in zip(gaps, tools, strict=True)]
    chosen = np.flatnonzero(np.any(near, axis=0))
    rest, free = surface.positions[chosen], len(chosen)
    compliance = _compliance(body, surface, correction, chosen, held) / body.young_modulus
    to_size = 1e3  # Metres to about one.
    unit = 1e-3 / np.median(np.diag(compliance))  # N, about what moves a point by a millimetre.
    matrix = compliance * unit * to_size

    def distances(tool, pose, forces):
        moved = (matrix @ forces).reshape(-1, 3)[:free] / to_size
        distance, normals = tool.distance(pose.to_tool(rest + moved))
        return distance * to_size, normals @ pose.rotation.T

    def slopes(tool, pose, forces):
        _, normals = distances(tool, pose, forces)
        return np.einsum("px,pxf->pf", normals, matrix.reshape(-1, 3, len(matrix))[:free])

    outside = [
        {
            "type": "ineq",
            "fun": lambda f, t=t: distances(*t, f)[0],
            "jac": lambda f, t=t: slopes(*t, f),
        }
        for t in tools
    ]
    if held:
        asked = np.concatenate([one.by for one in held]) * to_size
        rows = matrix[3 * free :]
        outside.append({"type": "eq", "fun": lambda f: rows @ f - asked, "jac": lambda _: rows})
    found = minimize(
        lambda f: 0.5 * f @ matrix @ f,
        np.zeros(len(matrix)),
        jac=lambda f: matrix @ f,
        method="SLSQP",
        constraints=outside,
        options={"maxiter": 200, "ftol": 1e-14},
    )
    forces = found.x.reshape(-1, 3) * unit
    return _by_tool([distances(*tool, found.x) for tool in tools], forces[:free]), -forces[free:]


def _by_tool(seen, forces):
    """What each tool feels: a point's force goes to those that it lies on, along their normals."""
    felt = np.zeros((len(seen), 3))
    for point, force in enumerate(forces):
        normals = np.array([n[point] * (d[point] < 1e-6) for d, n in seen]).T
        felt -= (normals * nnls(normals, force)[0]).T
    return felt


def _compliance(body, surface, correction, chosen, held):
    """Of the chosen contact points and, by the elements alone, of those held: (3n, 3n) at 1 Pa."""
    own = surface.taken(chosen)
    if held:
        triangles, alphas = (np.array([getattr(h, n) for h in held]) for n in ("triangle", "alpha"))
        corners = body.mesh.nodes[body.mesh.surface_triangles[triangles]]
        places = np.einsum("hc,hcx->hx", alphas, corners)
        more = (places, np.zeros_like(places), triangles, alphas, np.ones(len(held)))
        names = ("positions", "normals", "triangles", "alphas", "areas")
        joined = [np.concatenate([getattr(own, n), m]) for n, m in zip(names, more, strict=True)]
        own = type(own)(*joined)
    every = np.arange(len(own))
    blocks = point_compliance(body, own, every, every)
    here = np.arange(len(chosen))
    blocks[np.ix_(here, here)] += correction.between(chosen, chosen)
    matrix = blocks.transpose(0, 2, 1, 3).reshape(3 * len(own), -1)
    return 0.5 * (matrix + matrix.T)
