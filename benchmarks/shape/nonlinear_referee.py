"""Large deformations beside other finite element programs.

    python benchmarks/shape/nonlinear_referee.py [--bodies cube mouse-1.7k] [--loads N] [--laws L]

The paper's cube (Poisson's ratio 0.49) and the mouse of 1.7k nodes (0.3), under ten loads each that
deform them far, by three laws: by Palpate's Newton's method, by scikit-fem with its own assembly,
load steps and solver (neo-Hookean, St. Venant-Kirchhoff), and by CalculiX with NLGEOM where its
program ``ccx`` is on the path (St. Venant-Kirchhoff, foam; it prints seven digits). All take the
same tetrahedra. Loads that the solid does not carry are lessened until it does; the share is told.

Claimed: displacements agree to 1e-5 of the largest. The exit status tells whether that holds. A
busy machine changes nothing but the time it takes, a few minutes.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from functools import partial
from itertools import product

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.shape.calculix import (
    calculix_displacements,
    ccx_program,
    elastic,
    hyperfoam,
)
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.law.foam import Foam
from palpate.core.law.law import Law
from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.law.principal import Power
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.tests.bodies.large_loads import carried, large_loads
from palpate.tests.referees.nonlinear_reference import (
    NEO_HOOKEAN,
    ST_VENANT_KIRCHHOFF,
    Forms,
    NonlinearReference,
)

LARGEST_DIFFERENCE = 1e-5
# scikit-fem takes even load steps, and at least so many.
LOAD_STEPS = 2

# A foam that yields and stiffens again; its exponents are no particular foam's.
FOAM = (Power(0.7, 8.0), Power(0.3, -2.0))
# Without a referee of the law a program is left out.
LAWS: dict[str, Callable[[float], tuple[Law, Forms | None, str | None]]] = {
    "neo-hookean": lambda _: (NeoHookean(), NEO_HOOKEAN, None),
    "foam": lambda ratio: (Foam(ratio, FOAM), None, hyperfoam(Foam(ratio, FOAM))),
    "st-venant-kirchhoff": lambda ratio: (
        StVenantKirchhoff(),
        ST_VENANT_KIRCHHOFF,
        elastic(ratio),
    ),
}
# Poisson's ratio, and the axis towards the end of the body.
BODIES = {"cube": (0.49, 2), "mouse-1.7k": (0.3, 0)}


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=tuple(BODIES), choices=BODIES)
    parser.add_argument("--loads", type=int, default=10, metavar="N", help="only the first N")
    parser.add_argument("--laws", nargs="+", default=tuple(LAWS), choices=LAWS)
    options = parser.parse_args()
    calculix = ccx_program()
    if calculix is None:
        print("CalculiX: ccx is not on the path, so scikit-fem is the only referee")
    head = ("of load", "moved mm", "least det F", "steps", "iterations")
    worst = 0.0
    for law_name, name in product(options.laws, options.bodies):
        mesh, fixed = tets_of(name)
        ratio, axis = BODIES[name]
        law, forms, material = LAWS[law_name](ratio)
        body = free_solid(mesh, fixed, ratio, law)
        referees = ["scikit-fem"] * (forms is not None) + ["CalculiX"] * (material is not None)
        print(f"{law_name}: beside " + " and ".join(referees))
        print(f"{name:20s}" + "".join(f"{title:>12s}" for title in head))
        for load, wanted in list(large_loads(body, axis).items())[: options.loads]:
            forces, found = carried(body, wanted)
            u = found.displacements
            reach = max(LOAD_STEPS, 2 * found.load_steps)
            whole = np.zeros(mesh.nodes.shape)
            whole[body.free] = forces
            others: list[Callable[[], NDArray[np.float64]]] = []
            if forms is not None:
                reference = NonlinearReference(mesh, body.free, ratio, forms)
                others.append(partial(reference.displacements, forces, reach))
            if material is not None and calculix is not None:
                others.append(
                    partial(calculix_displacements, mesh, fixed, material, whole, calculix)
                )
            differences = [difference(u, other, body.free) for other in others]
            worst = max([worst, *np.nan_to_num(differences).tolist()])
            figures = (
                f"{np.abs(forces).max() / np.abs(wanted).max():12.3f}{1e3 * np.abs(u).max():12.2f}"
                f"{body.solid.terms[0].volume_ratios(u).min():12.3f}"
                f"{found.load_steps:12d}{found.iterations:12d}"
            )
            print(
                f"  {load:18s}" + figures + "".join(f"{d:12.1e}" for d in differences), flush=True
            )
    print(f"largest difference {worst:.1e}")
    held = worst <= LARGEST_DIFFERENCE
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def difference(
    moved: NDArray[np.float64], other: Callable[[], NDArray[np.float64]], free: NDArray[np.int64]
) -> float:
    """Of another program's displacements from these (f, 3), over the largest; nan: it gave up."""
    try:
        found = other()
    except ArithmeticError as problem:
        print(f"    {str(problem).splitlines()[0]}")
        return float("nan")
    found = found if len(found) == len(free) else found[free]
    return float(np.abs(found - moved).max() / np.abs(found).max())


def free_solid(
    mesh: TetMesh, fixed: NDArray[np.int64], poisson_ratio: float, law: Law
) -> FreeSolid:
    """The solid of a body of which no compliance is needed."""
    nodes = np.setdiff1d(mesh.surface_nodes, fixed)
    none = DenseCompliance(nodes, np.empty((len(nodes), 3, 0)))
    return FreeSolid.of(SoftBody(mesh, fixed, poisson_ratio, none, 1.0), law)


if __name__ == "__main__":
    sys.exit(main())
