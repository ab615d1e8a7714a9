"""A ball under a plate and a cube under a sphere, on a floor, beside another finite element code.

    python benchmarks/contact/resting_referee.py [--edge-length F]

The referee is scikit-fem, axially symmetric, with its own contact at plate and table; see
``benchmarks/measuring/contact/resting_ball.py``. A ball of 60 mm, baked without pins, lies on a
floor without weight, turned anyhow, and a plate comes down on it; a friction of 0.05 keeps it from
rolling to where its mesh is softest. Its radius is the mean of its contact points'. Claimed: force
on the plate within 5 % at every depth and turn, and within 3 % in the mean. The ball that is glued
up to a tenth of its height is the referee's alone: what a body feels too firm by when it is held
there. A cube of 50 mm that a sphere of 14 mm presses on its middle: within 3 %, the referee's floor
being smooth and Palpate's rough enough to keep it in place. The exit status tells whether all of
that holds.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from palpate.benchmarks.measuring.contact.contact_reference import reference_forces
from palpate.benchmarks.measuring.contact.resting_ball import RestingBall
from palpate.core.bake.job import run_bake
from palpate.core.bake.settings import BakeSettings
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.surface import Surface
from palpate.core.rest.bearing_points import bearing_points
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.stiffness.pins import NoPins
from palpate.tests.bodies import fingertip_on_cube as cube
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.bodies.golden_sphere import golden_sphere

RADIUS, POISSON_RATIO, YOUNG_MODULUS = 0.03, 0.45, 1e4
DEPTHS = (0.001, 0.002, 0.004, 0.012)
LARGEST_ERROR, LARGEST_MEAN_ERROR = 0.05, 0.03
TURNS, AIR, FRICTION = 4, 2e-4, 0.05
SURFACE_NODES = 3000
EDGE, LARGEST_ERROR_OF_CUBE = cube.EDGE, 0.03


def cube_holds() -> bool:
    """Print the cube's table; whether its claim holds."""
    mesh, _ = paper_cube(EDGE, 8)
    body = baked_body(mesh, [], cube.POISSON_RATIO, cube.YOUNG_MODULUS, density=1.0)
    above = np.array([EDGE / 2, EDGE / 2, EDGE + cube.RADIUS])
    weightless = RestSettings(friction=0.0, gravity=(0.0, 0.0, 0.0))
    tools = [(sphere(cube.RADIUS), Pose.at(above + np.array([0.0, 0.0, 1e-5])))]
    resting = Resting(body, [Floor()], tools, settings=weightless)
    resting.step()
    material = cube.YOUNG_MODULUS, cube.POISSON_RATIO
    expected = reference_forces(EDGE, cube.RADIUS, cube.DEPTHS, *material, on_floor=True)
    held = True
    print("cube: depth, mm   referee, N   Palpate's sphere, floor / referee")
    for depth, force in zip(cube.DEPTHS, expected, strict=True):
        resting.lead([Pose.at(above - [0.0, 0.0, depth])])
        rest = resting.settle()
        ratios = np.array([rest.tools[0].force[2], -rest.supports[0].force[2]]) / force
        print(f"{1e3 * depth:15.1f}{force:13.5f}     {ratios.round(4)}", flush=True)
        held &= bool((np.abs(ratios - 1.0) <= LARGEST_ERROR_OF_CUBE).all())
    return held


def turned_ratios(body: SoftBody, radius: float, table: RestingBall, seed: int) -> list[float]:
    """Force on the plate over the referee's at all depths, of the ball turned anyhow."""
    turn = Rotation.random(random_state=np.random.default_rng(seed)).as_matrix()
    top = 2.0 * radius
    resting = Resting(
        body,
        [Floor(0.0, friction=FRICTION)],
        [(plate(0.05, 0.05), Pose.at([0.0, 0.0, top + AIR]))],
        placement=Pose.at([0.0, 0.0, radius + 0.2 * AIR], turn),
        settings=RestSettings(friction=FRICTION, gravity=(0.0, 0.0, -1e-6)),
    )
    resting.step()
    ratios = []
    for depth in DEPTHS:
        resting.lead([Pose.at([0.0, 0.0, top - depth])])
        force = table.under_plate(depth / radius)[0] * YOUNG_MODULUS * radius**2
        ratios.append(float(resting.settle().tools[0].force[2]) / force)
    return ratios


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--edge-length", type=float, default=0.06, metavar="F")
    settings = BakeSettings(
        poisson_ratio=POISSON_RATIO,
        young_modulus=YOUNG_MODULUS,
        pins=NoPins(),
        edge_length=parser.parse_args().edge_length,
        epsilon=1e-3,
    )
    ball = Surface(*golden_sphere(SURFACE_NODES, RADIUS))
    # fTetWild leaves files where it runs.
    with tempfile.TemporaryDirectory() as folder:
        body, _ = run_bake(ball, settings, Path(folder) / "body.npz")
    points, _ = bearing_points(body)
    radius = float(np.linalg.norm(points.positions, axis=1).mean())
    table = RestingBall(POISSON_RATIO)
    glued = RestingBall(POISSON_RATIO, glued=0.2)
    held = cube_holds()
    ratios = np.array([turned_ratios(body, radius, table, seed) for seed in range(TURNS)])
    print(f"{len(body.mesh.nodes)} nodes, {len(points)} contact points, {TURNS} turns")
    print("depth, mm   glued / resting   Palpate / referee: mean, least, largest")
    for depth, some in zip(DEPTHS, ratios.T, strict=True):
        share = depth / radius
        firmer = glued.under_plate(share)[0] / table.under_plate(share)[0]
        figures = [some.mean(), some.min(), some.max()]
        print(f"{1e3 * depth:9.1f}{firmer:18.2f}     {np.round(figures, 3)}", flush=True)
        held &= bool((np.abs(some - 1.0) <= LARGEST_ERROR).all())
        held &= abs(figures[0] - 1.0) <= LARGEST_MEAN_ERROR
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
