"""Large deformations beside other finite element programs.

    python benchmarks/shape/nonlinear_referee.py [--bodies cube mouse-1.7k] [--loads N]

The paper's cube (Poisson's ratio 0.49) and the mouse of 1.7k nodes (0.3), under ten loads each that
deform them far: by Palpate's Newton's method, by scikit-fem with its own assembly, load steps and
solver, and by CalculiX with NLGEOM where its program ``ccx`` is on the path (it prints seven
digits). All take the same tetrahedra and St. Venant-Kirchhoff's material. Loads that the solid does
not carry are lessened until it does; the share is told.

Claimed: displacements agree to 1e-5 of the largest. The exit status tells whether that holds. A
busy machine changes nothing but the time it takes, a few minutes.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.shape.calculix import calculix_displacements, ccx_program
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.tests.bodies.large_loads import carried, large_loads
from palpate.tests.referees.nonlinear_reference import NonlinearReference

LARGEST_DIFFERENCE = 1e-5
# scikit-fem takes even load steps, and at least so many.
LOAD_STEPS = 2

# Poisson's ratio, and the axis towards the end of the body.
BODIES = {"cube": (0.49, 2), "mouse-1.7k": (0.3, 0)}


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=tuple(BODIES), choices=BODIES)
    parser.add_argument("--loads", type=int, default=10, metavar="N", help="only the first N")
    options = parser.parse_args()
    calculix = ccx_program()
    if calculix is None:
        print("CalculiX: ccx is not on the path, so scikit-fem is the only referee")
    head = ("of load", "moved mm", "least det F", "steps", "iterations", "scikit-fem", "CalculiX")
    worst = 0.0
    for name in options.bodies:
        mesh, fixed = tets_of(name)
        ratio, axis = BODIES[name]
        body = free_solid(mesh, fixed, ratio)
        reference = NonlinearReference(mesh, body.free, ratio)
        print(f"{name:20s}" + "".join(f"{title:>12s}" for title in head))
        for load, wanted in list(large_loads(body, axis).items())[: options.loads]:
            forces, found = carried(body, wanted)
            u = found.displacements
            others = [reference.displacements(forces, max(LOAD_STEPS, found.load_steps))]
            if calculix is not None:
                whole = np.zeros(mesh.nodes.shape)
                whole[body.free] = forces
                others.append(
                    calculix_displacements(mesh, fixed, ratio, whole, calculix)[body.free]
                )
            differences = [np.abs(other - u).max() / np.abs(other).max() for other in others]
            worst = max(worst, *differences)
            figures = (
                f"{np.abs(forces).max() / np.abs(wanted).max():12.3f}{1e3 * np.abs(u).max():12.2f}"
                f"{body.volume_ratios(u).min():12.3f}{found.load_steps:12d}{found.iterations:12d}"
            )
            print(
                f"  {load:18s}" + figures + "".join(f"{d:12.1e}" for d in differences), flush=True
            )
    print(f"largest difference {worst:.1e}")
    held = worst <= LARGEST_DIFFERENCE
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def free_solid(mesh: TetMesh, fixed: NDArray[np.int64], poisson_ratio: float) -> FreeSolid:
    """The solid of a body of which no compliance is needed."""
    nodes = np.setdiff1d(mesh.surface_nodes, fixed)
    none = DenseCompliance(nodes, np.empty((len(nodes), 3, 0)))
    return FreeSolid.of(SoftBody(mesh, fixed, poisson_ratio, none, 1.0))


if __name__ == "__main__":
    sys.exit(main())
