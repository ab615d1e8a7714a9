"""Options of ``palpate bake``, and the bake's arguments that follow from them."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.bake.settings import FORMS, BakeSettings
from ...core.compliance.free_body.density import DEFAULT_DENSITY
from ...core.errors import PalpateError
from ...core.law.of_material import RUBBER
from ...core.mesh.read_mesh import TetFile, read_surface, read_tets
from ...core.mesh.surface import Surface
from ...core.mesh.tet_mesh import TetMesh
from ...core.softness.scales.shore import Shore, young_from_shore
from ...core.stiffness.formulation import FORMULATIONS
from ...core.stiffness.pins import NoPins, PinBelow, PinNodes, Pins
from ...core.stiffness.regions import TetScale
from ..softness.materials import material_named

DEFAULT_PIN_FRACTION = 0.1
AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, eq=False)
class BakeInput:
    """Mesh and settings for a bake."""

    source: Surface | TetMesh
    settings: BakeSettings


def add_bake_options(parser: argparse.ArgumentParser) -> None:
    """Add options of shape, pins, material and compliance."""
    default = BakeSettings()
    shape = parser.add_argument_group("shape")
    shape.add_argument(
        "--edge-length",
        type=float,
        metavar="F",
        help="wanted edge length of tetrahedra as a share of the bounding box diagonal "
        f"(default: {default.edge_length:g}; not for npz)",
    )
    shape.add_argument(
        "--epsilon",
        type=float,
        default=default.epsilon,
        metavar="F",
        help="how far the body's surface may lie from the mesh's, as such a share "
        "(default: %(default)g)",
    )
    shape.add_argument(
        "--metres-per-unit",
        type=float,
        default=1.0,
        metavar="S",
        help="unit of the file (default: 1)",
    )
    shape.add_argument(
        "--time-limit",
        type=float,
        default=default.time_limit,
        metavar="S",
        help="give up tetrahedralization after so many seconds (default: %(default)g)",
    )
    pins = parser.add_argument_group("pins")
    held = pins.add_mutually_exclusive_group()
    held.add_argument(
        "--pins",
        choices=("none",),
        help="pin nothing: a free body, held by what it meets, such as a floor",
    )
    held.add_argument(
        "--pin-below",
        type=float,
        metavar="FRACTION",
        help="pin surface nodes within this lowest share of the height "
        f"(default: 'fixed' of an npz, else {DEFAULT_PIN_FRACTION:g})",
    )
    pins.add_argument("--up", choices=AXES, default="z", help="upward axis (default: z)")
    material = parser.add_argument_group("material")
    material.add_argument(
        "--material",
        type=material_named,
        metavar="NAME",
        help="preset such as ecoflex-30, for what is not given; 'palpate materials' lists them",
    )
    modulus = material.add_mutually_exclusive_group()
    modulus.add_argument(
        "--young",
        type=float,
        metavar="PA",
        help="Young's modulus stored as the default for presses "
        f"(default: {default.young_modulus:g})",
    )
    modulus.add_argument(
        "--shore", metavar="SHORE", help="Young's modulus by its Shore value, such as 00-30 or A20"
    )
    material.add_argument(
        "--poisson",
        type=float,
        metavar="NU",
        help=f"Poisson's ratio (default: {default.poisson_ratio:g})",
    )
    material.add_argument(
        "--density",
        type=float,
        metavar="KG/M3",
        help="of the body, for its weight (default: the preset's, or for --pins none "
        f"{DEFAULT_DENSITY:g})",
    )
    material.add_argument(
        "--formulation",
        choices=FORMULATIONS,
        default=default.formulation,
        help="of the tetrahedra: smoothed, or the paper's linear ones, which are too stiff and "
        "lock where Poisson's ratio is near 0.5 (default: %(default)s)",
    )
    compliance = parser.add_argument_group("compliance")
    compliance.add_argument(
        "--form",
        choices=FORMS,
        default=default.form,
        help="dense as in the paper, or compressed (default: %(default)s, compressed when large)",
    )
    compliance.add_argument(
        "--tolerance",
        type=float,
        default=default.tolerance,
        metavar="F",
        help="largest relative column error that compressing may cause (default: %(default)g)",
    )
    compliance.add_argument(
        "--threads",
        type=int,
        metavar="N",
        help="threads of BLAS for each bake (default: the idle cores; for many meshes the cores "
        "this program may use, divided among the bakes at once)",
    )


def bake_input(arguments: argparse.Namespace, mesh: Path, threads: int | None) -> BakeInput:
    """Read the mesh and its settings.

    Raises
    ------
    PalpateError
        A mesh that cannot be read, an option that does not suit it.
    """
    if not (np.isfinite(arguments.metres_per_unit) and arguments.metres_per_unit > 0):
        raise PalpateError(
            f"--metres-per-unit: {arguments.metres_per_unit} is not a positive number; "
            "give 0.001 for a file in millimetres"
        )
    tets = None
    source: Surface | TetMesh
    if mesh.suffix.lower() == ".npz":
        if arguments.edge_length is not None:
            raise PalpateError(
                f"--edge-length: {mesh} holds tetrahedra already; leave the option out, or give a "
                "surface (obj, ply, stl)"
            )
        tets = read_tets(mesh, arguments.metres_per_unit)
        source = tets.mesh
    else:
        source = read_surface(mesh, arguments.metres_per_unit)
    return BakeInput(source, _settings(arguments, tets, threads))


def _settings(
    arguments: argparse.Namespace, tets: TetFile | None, threads: int | None
) -> BakeSettings:
    scale = None if tets is None else tets.young_scale
    young_modulus, poisson_ratio = _material(arguments)
    return BakeSettings(
        poisson_ratio=poisson_ratio,
        young_modulus=young_modulus,
        pins=_pins(arguments, tets),
        edge_length=(
            BakeSettings.edge_length if arguments.edge_length is None else arguments.edge_length
        ),
        epsilon=arguments.epsilon,
        time_limit=arguments.time_limit,
        formulation=arguments.formulation,
        form=arguments.form,
        tolerance=arguments.tolerance,
        stiffness=None if scale is None else TetScale(scale),
        threads=threads,
        density=_density(arguments),
        law=RUBBER if arguments.material is None else arguments.material.law,
    ).checked()


def _material(arguments: argparse.Namespace) -> tuple[float, float]:
    """Young's modulus in pascal and Poisson's ratio: as given, the preset's, or the default."""
    start = BakeSettings() if arguments.material is None else arguments.material
    ratio = start.poisson_ratio if arguments.poisson is None else arguments.poisson
    if arguments.shore is not None:
        return young_from_shore(Shore.parse(arguments.shore), ratio), ratio
    return start.young_modulus if arguments.young is None else arguments.young, ratio


def _density(arguments: argparse.Namespace) -> float | None:
    """Density in kg/m3: as given, or the preset's."""
    given: float | None = arguments.density
    if given is None and arguments.material is not None:
        return float(arguments.material.density)
    return given


def _pins(arguments: argparse.Namespace, tets: TetFile | None) -> Pins:
    if arguments.pins == "none":
        return NoPins()
    if arguments.pin_below is not None:
        return PinBelow(arguments.pin_below, AXES[arguments.up])
    if tets is not None and tets.fixed is not None:
        return PinNodes(tets.fixed)
    return PinBelow(DEFAULT_PIN_FRACTION, AXES[arguments.up])
