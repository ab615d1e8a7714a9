"""Large deformations by CalculiX, where its program ``ccx`` is installed (Debian: calculix-ccx).

Its elastic material with NLGEOM relates the second Piola-Kirchhoff stress to Lagrange's strain by
Hooke's law (CalculiX CrunchiX user's manual 2.20, section on linear elastic materials), which is
St. Venant-Kirchhoff's; its hyperfoam is Storakers'. Its neo-Hookean rubber parts volume from shape
in another way than Palpate's. Displacements are read as it prints them, with seven digits.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.core.law.foam import Foam
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import lame_parameters

# CalculiX compares some numbers with fixed small ones, so it is given millimetres.
MILLIMETRES = 1e3

# Residual and correction at which an increment is done, as shares; its defaults are 0.005 and 0.01.
CONTROLS = """*CONTROLS, PARAMETERS=FIELD
1e-9, 1e-9, , , 1e-9
*CONTROLS, PARAMETERS=TIME INCREMENTATION
20, 40, 9, 60, 10, 4, , 20
"""


def ccx_program() -> str | None:
    """The program, if it is on the path."""
    return shutil.which("ccx")


def elastic(poisson_ratio: float) -> str:
    """St. Venant-Kirchhoff's law of 1 Pa, as CalculiX reads it."""
    return f"*ELASTIC\n1.0, {poisson_ratio}"


def hyperfoam(law: Foam) -> str:
    """A foam of 1 Pa, as CalculiX reads it."""
    _, shear = lame_parameters(1.0, law.poisson_ratio)
    constants = [f"{shear * term.share:.12e}, {term.exponent:.12e}" for term in law.terms]
    ratios = [f"{law.poisson_ratio}"] * len(law.terms)
    return f"*HYPERFOAM, N={len(law.terms)}\n" + ", ".join(constants + ratios)


def calculix_displacements(
    mesh: TetMesh,
    fixed: NDArray[np.int64],
    material: str,
    nodal_forces: NDArray[np.float64],
    program: str = "ccx",
) -> NDArray[np.float64]:
    """Displacements (N, 3), metres, under forces (N, 3) at a modulus of 1 Pa.

    ``material`` is what its input has for it: :func:`elastic` or :func:`hyperfoam`.

    Raises
    ------
    ArithmeticError
        CalculiX does not come to the whole load.
    """
    with tempfile.TemporaryDirectory() as folder:
        job = Path(folder, "job")
        job.with_suffix(".inp").write_text(_deck(mesh, fixed, material, nodal_forces))
        ran = subprocess.run(
            [program, "job"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        if ran.returncode or "Job finished" not in ran.stdout:
            raise ArithmeticError(f"CalculiX: {ran.stdout[-300:]}{ran.stderr[-300:]}")
        table = [
            line.split()
            for line in job.with_suffix(".dat").read_text().splitlines()
            if line.strip() and not line.lstrip().startswith("displacements")
        ]
    found = np.array(table, dtype=np.float64)[-len(mesh.nodes) :]
    displacements = np.empty_like(mesh.nodes)
    displacements[found[:, 0].astype(np.int64) - 1] = found[:, 1:] / MILLIMETRES
    return displacements


def _deck(
    mesh: TetMesh, fixed: NDArray[np.int64], material: str, forces: NDArray[np.float64]
) -> str:
    # Fields longer than twenty characters are cut off.
    nodes = (
        f"{number},{x:.12e},{y:.12e},{z:.12e}"
        for number, (x, y, z) in enumerate(MILLIMETRES * mesh.nodes, start=1)
    )
    tets = (
        f"{number}," + ",".join(map(str, corners))
        for number, corners in enumerate((mesh.tets + 1).tolist(), start=1)
    )
    loads = (
        f"{node + 1},{axis + 1},{MILLIMETRES**2 * forces[node, axis]:.12e}"
        for node, axis in np.argwhere(forces).tolist()
    )
    parts: list[str | Iterable[str]] = [
        "*NODE, NSET=NALL",
        nodes,
        "*ELEMENT, TYPE=C3D4, ELSET=EALL",
        tets,
        f"*MATERIAL, NAME=SOFT\n{material}",
        "*SOLID SECTION, ELSET=EALL, MATERIAL=SOFT",
        "*BOUNDARY",
        (f"{node + 1},1,3" for node in fixed.tolist()),
        "*STEP, NLGEOM, INC=400\n*STATIC\n0.25, 1.0, 1e-4, 0.25",
        CONTROLS.rstrip(),
        "*CLOAD",
        loads,
        "*NODE PRINT, NSET=NALL, FREQUENCY=400\nU\n*END STEP\n",
    ]
    return "\n".join(part if isinstance(part, str) else "\n".join(part) for part in parts)
