"""Does a fingertip feel how finely a body is meshed? The same bodies at 1x, 2x and 4x.

    python benchmarks/contact/mesh_independence.py

A block and a ball, each with its edges halved once and twice, are touched by two fingertips at
nodes, on edges, in triangles and at places drawn at random, a tenth of the tip's radius deep and
deeper. The exit code is 1 where, against the finest mesh, the force differs by more than is
promised. Beside it, without a promise, what the same contact gives without the near field, and the
paper's point load; and how a finger that slides over the coarse mesh at one depth feels its
texture; and the far field of a point load against Boussinesq.

Linear tetrahedra at a Poisson's ratio of 0.3, where a whole body bends much alike at all three.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import cg

from palpate.benchmarks.measuring.refined import coarse_ball, refined
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.near_field.compliance_beneath import NearCorrection, near_correction
from palpate.core.contact.near_field.contact_points import ContactPoints, contact_points
from palpate.core.contact.near_field.half_space import surface_displacement
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_tool, touch_nearest
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.stiffness.assembly import assemble
from palpate.tests.bodies.baked_body import baked_body

POISSON_RATIO, YOUNG_MODULUS = 0.3, 1000.0
EDGE = 0.05
BALL = 0.03
CELLS = 4

# The most that forces may differ by from those on the finest mesh, where the patch of contact is as
# wide as two of the coarsest elements, and where it is narrower.
WIDE_PATCH, NARROW_PATCH = 0.05, 0.15

# Share of the closed form that a point load's far field may be off.
FAR_FIELD = 0.05

# Least third component of the normals of contact points that are looked at.
FACING_UP = 0.3

# Radii of the fingertips, and depths as shares of them.
RADII = (0.008, 0.03)
DEPTHS = {0.008: (0.1, 0.2, 0.4), 0.03: (0.2, 0.3)}


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A body with the contact points of one fingertip that look up, as all that are touched do."""

    body: SoftBody
    tool: Tool
    points: ContactPoints
    correction: NearCorrection

    @classmethod
    def of(cls, body: SoftBody, tool: Tool) -> Surroundings:
        """Spread the points, and look at them once."""
        points = contact_points(body, tool.spacing)
        points = points.taken(points.normals[:, 2] > FACING_UP)
        return cls(body, tool, points, near_correction(body, points))

    def pressed(
        self, place: NDArray[np.float64], normal: NDArray[np.float64], depth: float, *, near: bool
    ) -> tuple[float, float]:
        """Force along the normal, newton, and the radius of the patch, metres."""
        pose = Pose.at(place + (self.tool.radius - depth) * normal)
        touch = press_tool(
            self.body,
            self.tool,
            pose,
            spread=(self.points, self.correction if near else None),
        )
        return float(touch.force @ normal), float(np.sqrt(touch.area / np.pi))


@dataclass(frozen=True, eq=False)
class Family:
    """One shape at 1x, 2x and 4x, and places (q, 3) with normals (q, 3) to touch it at."""

    name: str
    bodies: tuple[SoftBody, ...]
    names: tuple[str, ...]
    places: NDArray[np.float64]
    normals: NDArray[np.float64]
    element: float


def block() -> Family:
    """The paper's cube, touched in its top no nearer to the rim than one coarse element."""
    bodies = tuple(
        baked_body(*paper_cube(EDGE, CELLS * times), POISSON_RATIO, YOUNG_MODULUS)
        for times in (1, 2, 4)
    )
    element = EDGE / CELLS
    centre, rng = np.array([EDGE / 2, EDGE / 2]), np.random.default_rng(5)
    known = {
        "node": (0.0, 0.0),
        "edge": (0.5, 0.0),
        "long edge": (0.5, 0.5),
        "triangle": (1 / 3, 1 / 4),
    }
    shifts = np.concatenate([np.array(list(known.values())), rng.uniform(-1, 1, (6, 2))])
    places = centre + element * shifts
    names = (*known, *(f"random {number}" for number in range(1, 7)))
    return Family(
        "block",
        bodies,
        names,
        np.column_stack([places, np.full(len(places), EDGE)]),
        np.tile([0.0, 0.0, 1.0], (len(places), 1)),
        element,
    )


def ball() -> Family:
    """A ball of coarse triangles, touched around its top; the finer ones have the same facets."""
    stages = [coarse_ball(BALL, CELLS)]
    for _ in range(2):
        stages.append(refined(*stages[-1]))
    bodies = tuple(baked_body(*stage, POISSON_RATIO, YOUNG_MODULUS) for stage in stages)
    coarse, rng = stages[0][0], np.random.default_rng(6)
    triangles = coarse.surface_triangles
    corners = coarse.nodes[triangles]
    high = np.argsort(-corners[:, :, 2].mean(axis=1), kind="stable")
    alphas = {
        "node": [1.0, 0.0, 0.0],
        "edge": [0.5, 0.5, 0.0],
        "triangle": [1 / 3, 1 / 3, 1 / 3],
        **{f"random {number}": rng.dirichlet([1, 1, 1]) for number in range(1, 6)},
    }
    chosen = high[[0, 1, 2, *rng.integers(0, 8, 5)]]
    places = np.einsum("pc,pcx->px", np.array(list(alphas.values())), corners[chosen])
    normals = places / np.linalg.norm(places, axis=1, keepdims=True)
    edges = np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2)
    element = float(edges[high[:8]].mean())
    return Family("ball", bodies, tuple(alphas), places, normals, element)


def compare(family: Family, radius: float) -> bool:
    """Print a table of one shape and one fingertip; whether it is as promised."""
    tool = sphere(radius)
    around = [Surroundings.of(body, tool) for body in family.bodies]
    print(
        f"\n{family.name}, fingertip {1000 * radius:.0f} mm, coarse elements "
        f"{1000 * family.element:.1f} mm; force over that at 4x"
    )
    print(
        f"{'place':<12}{'depth mm':>9}{'patch':>7}{'F(4x) mN':>10}"
        f"{'near 1x':>10}{'2x':>7}{'plain 1x':>10}{'2x':>7}{'paper 1x':>10}{'2x':>7}"
    )
    kept = True
    for name, place, normal in zip(family.names, family.places, family.normals, strict=True):
        for share in DEPTHS[radius]:
            depth = share * radius
            near = [one.pressed(place, normal, depth, near=True) for one in around]
            plain = [one.pressed(place, normal, depth, near=False)[0] for one in around]
            paper = [paper_force(body, place, normal, depth) for body in family.bodies]
            across = 2 * near[-1][1] / family.element
            force = np.array([one for one, _ in near])
            allowed = WIDE_PATCH if across >= 2 else NARROW_PATCH
            good = bool(np.abs(force[:2] / force[2] - 1).max() <= allowed)
            kept &= good
            ratios = [force / force[2], np.array(plain) / plain[2], np.array(paper) / paper[2]]
            columns = "".join(f"{ratio[0]:>10.3f}{ratio[1]:>7.3f}" for ratio in ratios)
            print(
                f"{name:<12}{1000 * depth:>9.2f}{across:>7.2f}{1000 * force[2]:>10.2f}{columns}"
                + ("" if good else f"   more than {100 * allowed:.0f} % off")
            )
    return kept


def paper_force(
    body: SoftBody, place: NDArray[np.float64], normal: NDArray[np.float64], depth: float
) -> float:
    """The paper's point load at the same place and depth, newton."""
    return float(
        touch_nearest(body, place, -depth * normal, ContactSettings(mode="paper")).force @ normal
    )


def texture(family: Family, radius: float, share: float) -> None:
    """Print how the force varies while a finger slides over two coarse elements."""
    tool, depth = sphere(radius), share * radius
    coarse = Surroundings.of(family.bodies[0], tool)
    up = np.array([0.0, 0.0, 1.0])
    middle = np.array([EDGE / 2, EDGE / 2 + 0.001, EDGE])
    steps = np.linspace(-1, 1, 41)[:, None] * np.array([1.0, 0.3, 0.0])
    path = middle + family.element * steps
    forces: dict[str, Callable[[NDArray[np.float64]], float]] = {
        "with the near field": lambda place: coarse.pressed(place, up, depth, near=True)[0],
        "plain finite elements": lambda place: coarse.pressed(place, up, depth, near=False)[0],
        "the paper's point load": lambda place: paper_force(coarse.body, place, up, depth),
    }
    print(
        f"\nsliding over the coarse block {1000 * depth:.1f} mm deep with {1000 * radius:.0f} mm: "
        "largest force over smallest"
    )
    for name, force in forces.items():
        felt = np.array([force(place) for place in path])
        print(f"  {name:<24}{felt.max() / felt.min():8.2f}")


def far_field() -> bool:
    """Print how a point load's far field differs from Boussinesq's; whether as promised."""
    cells = 32
    mesh, fixed = paper_cube(EDGE, cells)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    own = (3 * free[:, None] + np.arange(3)).ravel()
    stiffness = assemble(mesh, POISSON_RATIO)[own][:, own]
    centre = np.array([EDGE / 2, EDGE / 2, EDGE])
    loaded = int(np.argmin(np.linalg.norm(mesh.nodes[free] - centre, axis=1)))
    load = np.zeros(len(own))
    load[3 * loaded + 2] = 1.0
    moved, failed = cg(stiffness, load, rtol=1e-7, M=diags_array(1 / stiffness.diagonal()))
    if failed:
        raise ArithmeticError("conjugate gradients did not converge")
    offsets = mesh.nodes[free] - centre
    apart, step = np.linalg.norm(offsets, axis=1), EDGE / cells
    chosen = np.flatnonzero(
        (mesh.nodes[free, 2] == EDGE) & (apart > 1.5 * step) & (apart < 5 * step)
    )
    up = np.tile([0.0, 0.0, 1.0], (len(chosen), 1))
    exact = surface_displacement(offsets[chosen], up, POISSON_RATIO)[:, 2, 2]
    off = np.abs(moved.reshape(-1, 3)[chosen, 2] / exact - 1)
    print(
        f"\npoint load on the block of {cells}^3 cells, 1.5 to 5 elements away (to "
        f"{1000 * apart[chosen].max():.0f} mm of {1000 * EDGE:.0f}): off Boussinesq by "
        f"{100 * off.max():.1f} % at most, {100 * np.median(off):.1f} % in the median"
    )
    return bool(off.max() <= FAR_FIELD)


def main() -> int:
    """Print all tables; 1 where a promise is not kept."""
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    cube, round_one = block(), ball()
    kept = [compare(family, radius) for family in (cube, round_one) for radius in RADII]
    texture(cube, RADII[0], 0.2)
    kept.append(far_field())
    print("\nas promised" if all(kept) else "\nNOT as promised, see above")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
