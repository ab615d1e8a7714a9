"""A cube on a floor under a sphere, by Palpate and by MuJoCo's flex: force, and time a step.

    pip install '.[bench]'
    python benchmarks/rest/beside_mujoco.py [--cells N] [--step S]

The referee is scikit-fem with its own contact (``benchmarks/measuring/contact``), which shares
nothing with either. Both have the same cube of N cells a side (11: 1,728 nodes), Young's modulus
10 kPa, Poisson's ratio 0.3, no weight, a floor and a sphere of 14 mm that goes in by 0.7, 1.4 and
2.0 mm. MuJoCo takes steps, as long as told, until the force changes by less than 0.02 % in 20 of
them; its integrator is *discrete*, the one that takes a flex of this step, its solver CG, its
contacts as soft as they are unless told. Palpate's tick is that of 1 kHz, bounded as in the servo.
Times are the processor's, medians, while the sphere is in. Claimed: Palpate within 3 % of the
referee, and its tick less than MuJoCo's step; the exit status tells whether that holds.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from palpate.benchmarks.measuring.contact.contact_reference import reference_forces
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.tests.bodies import fingertip_on_cube as cube
from palpate.tests.bodies.free_shapes import free_block

DEPTHS = (0.0007, 0.0014, 0.002)
EDGE, RADIUS = cube.EDGE, cube.RADIUS
YOUNG, POISSON = cube.YOUNG_MODULUS, cube.POISSON_RATIO
MASS = 0.125
CHANGES, BLOCK, MOST_BLOCKS = 2e-4, 20, 100
MOST_ERROR = 0.03


@dataclass(frozen=True)
class Pressed:
    """Forces at all depths, N, and the processor's time of a step, s."""

    forces: list[float]
    seconds: float


def by_palpate(cells: int) -> Pressed:
    """Forces at rest; ticks of 1 kHz, bounded."""
    body = free_block((EDGE, EDGE, EDGE), (cells,) * 3, young_modulus=YOUNG)
    weightless = RestSettings(friction=0.0, gravity=(0.0, 0.0, 0.0))
    above = np.array([EDGE / 2, EDGE / 2, EDGE + RADIUS])
    tip = (sphere(RADIUS), Pose.at(above + np.array([0.0, 0.0, 1e-5])))
    resting = Resting(body, [Floor(friction=0.05)], [tip], settings=weightless)
    resting.step()
    forces, took = [], []
    for depth in DEPTHS:
        resting.lead([Pose.at(above - [0.0, 0.0, depth])])
        for _ in range(200):
            start = time.process_time()
            resting.tick(1e-3, hurried=True)
            took.append(time.process_time() - start)
        forces.append(float(resting.settle().tools[0].force[2]))
    return Pressed(forces, float(np.median(took)))


def by_mujoco(cells: int, step: float) -> Pressed:
    """The same by MuJoCo's flex."""
    import mujoco  # The opponent alone needs it.

    nodes, spacing = cells + 1, EDGE / cells
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{step}" gravity="0 0 0" solver="CG" tolerance="1e-8" iterations="100"
                  integrator="discrete"/>
          <size memory="2G"/>
          <worldbody>
            <geom type="plane" size="1 1 0.1"/>
            <body name="tip" mocap="true" pos="0 0 {EDGE + RADIUS}">
              <geom name="tip" type="sphere" size="{RADIUS}" friction="0.05"/>
            </body>
            <flexcomp name="cube" type="grid" dim="3" count="{nodes} {nodes} {nodes}"
                      spacing="{spacing} {spacing} {spacing}" pos="0 0 {EDGE / 2}" radius="1e-5"
                      mass="{MASS}">
              <elasticity young="{YOUNG}" poisson="{POISSON}" damping="0.001"/>
              <contact selfcollide="none" condim="3" friction="0.05"/>
            </flexcomp>
          </worldbody>
        </mujoco>""")
    data = mujoco.MjData(model)
    tip = model.geom("tip").id
    forces, took = [], []
    for depth in DEPTHS:
        data.mocap_pos[0] = [0.0, 0.0, EDGE + RADIUS - depth]
        force = 0.0
        for _ in range(MOST_BLOCKS):
            for _ in range(BLOCK):
                start = time.process_time()
                mujoco.mj_step(model, data)
                took.append(time.process_time() - start)
            before, force = force, _upward(mujoco, model, data, tip)
            if abs(force - before) <= CHANGES * abs(force):
                break
        forces.append(force)
    return Pressed(forces, float(np.median(took)))


def _upward(mujoco: Any, model: Any, data: Any, tip: int) -> float:
    """Force on the sphere, N."""
    total, wrench = 0.0, np.zeros(6)
    for number in range(data.ncon):
        contact = data.contact[number]
        if tip in contact.geom:
            mujoco.mj_contactForce(model, data, number, wrench)
            total += float(np.asarray(contact.frame).reshape(3, 3)[:, 2] @ wrench[:3])
    return abs(total)


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--cells", type=int, default=11)
    parser.add_argument("--step", type=float, default=1e-3, help="of MuJoCo, s")
    options = parser.parse_args()
    wanted = np.array(reference_forces(EDGE, RADIUS, list(DEPTHS), YOUNG, POISSON, on_floor=True))
    ours, theirs = by_palpate(options.cells), by_mujoco(options.cells, options.step)
    print(f"cube of {(options.cells + 1) ** 3} nodes; force over the referee's at each depth")
    for name, one in (("Palpate", ours), ("MuJoCo flex", theirs)):
        ratios = np.array(one.forces) / wanted
        print(f"{name:12} {ratios.round(3)}   {1e3 * one.seconds:8.3f} ms a step")
    error = np.abs(np.array(ours.forces) / wanted - 1.0).max()
    held = error <= MOST_ERROR and ours.seconds < theirs.seconds
    print("as claimed" if held else "NOT AS CLAIMED")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
