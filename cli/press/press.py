"""``palpate press``: press a body at one or several places and read the forces."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...core.body import body_file
from ...core.body.soft_body import SoftBody
from ...core.contact.equations import CONTACT_MODES
from ...core.contact.place import compliance_between
from ...core.contact.press import ContactSettings
from ...core.contact.single_press import press_points
from ...core.contact.touches import PointTouch, ToolTouch, contact_displacement
from ...core.errors import PalpateError
from ...core.files.atomic_file import atomic_file
from ...core.shape.felt import felt, loads_of
from ...core.shape.meeting import settled
from ...core.shape.shapes import FORMER_NAMES, SHAPES, shape, shape_name
from ..body.body_argument import add_body, add_young, modulus_of
from ..body.figure_lines import as_lines
from ..body.shape_option import add_shape, shape_of
from ..body.tool_option import KINDS, tool_from
from ..rest.floor_options import add_floor
from ..rest.press_resting import pressed_on_floor, refuse_beside_floor, refuse_floor
from ..rest.rest_figures import rest_figures, touch_figures
from ..scene.scene_commands import press_scene
from ..scene.scene_file import is_scene
from .press_tool import pressed_tools, tool_figures, tool_summary

HELP = "press a body with one or several fingers and read the forces"
TOO_DEEP = (
    "the body finds no rest so deep by its material's law; the force is as firm as where it did"
)
One = TypeVar("One", PointTouch, ToolTouch)
DESCRIPTION = (
    "Press a body and print the force on each finger, where it touches, and how "
    "far the surface moves."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    parser.epilog = (
        "Several fingers: give --at and --by once for each, in the same order. The tools of a "
        "scene file go their own ways; --tool, --at and --by add more."
    )
    add_body(parser, or_scene=True)
    for name, what in (
        ("at", "the surface point nearest to this is touched"),
        ("by", "the finger's displacement from there"),
    ):
        parser.add_argument(
            f"--{name}",
            type=float,
            nargs=3,
            action="append",
            metavar=("X", "Y", "Z"),
            help=f"{what} (metres, body coordinates); once for each finger",
        )
    add_young(parser)
    parser.add_argument(
        "--mode",
        choices=CONTACT_MODES,
        help="contact inside triangles: its point moves by exactly the finger's displacement "
        "(consistent, the default), or as in the paper",
    )
    parser.add_argument(
        "--tool",
        metavar="TOOL",
        help=f"press this instead of a point: {KINDS} (metres); its -z side is set down at --at, "
        "against the surface, and moved by --by; a body without pins lies on a floor",
    )
    parser.add_argument(
        "--friction",
        type=float,
        metavar="MU",
        help="coefficient of friction between --tool and body (default: 0)",
    )
    add_floor(parser)
    add_shape(
        parser,
        (*SHAPES, *FORMER_NAMES),
        "how the deformed shape is computed under the forces: by the material's own law, which "
        "tells the force, too (real; formerly rotation-strain), by linear elasticity (linear), or "
        "by the paper's (16) (paper; formerly table and series)",
    )
    parser.add_argument(
        "--displacements",
        type=Path,
        metavar="OUT",
        help="write displacements of the free surface nodes, float64 (n, 3), as .npy; of a scene "
        "an .npz with those of each body under its name",
    )


def run(arguments: argparse.Namespace) -> int:
    """Touch, deform, print."""
    if is_scene(arguments.body):
        return press_scene(arguments)
    for option in ("at", "by"):
        if not getattr(arguments, option):
            raise PalpateError(f"--{option}: it is missing; give three numbers, X Y Z, in metres")
    body = body_file.load(arguments.body)
    young_modulus = modulus_of(arguments, body)
    if arguments.tool is not None and body.is_free:
        return _press_resting(arguments, body, young_modulus)
    refuse_floor(arguments, body)
    if arguments.tool is not None:
        return _press_tool(arguments, body, young_modulus)
    if arguments.friction is not None:
        raise PalpateError("--friction: points have none; give it with --tool")
    return _press_points(arguments, body, young_modulus)


def _press_points(arguments: argparse.Namespace, body: SoftBody, young_modulus: float) -> int:
    settings = ContactSettings(young_modulus, mode=arguments.mode or "consistent")
    linear = press_points(body, arguments.at, arguments.by, settings)
    # The paper's contact stays as published.
    firm = settings.mode == "consistent"
    touches, displacements = _deformed(arguments, body, linear, young_modulus, firm=firm)
    contacts = [_contact_figures(body, touch, displacements) for touch in touches]
    common = _common_figures(arguments, displacements, young_modulus)
    common |= {"mode": settings.mode}
    coupling = _coupling(body, arguments.at, young_modulus) if len(contacts) > 1 else None
    _print(arguments, contacts, common, coupling)
    return 0


def _press_tool(arguments: argparse.Namespace, body: SoftBody, young_modulus: float) -> int:
    if arguments.mode is not None:
        raise PalpateError("--mode: it is about points; leave it out with --tool")
    tool = tool_from(arguments.tool)
    settings = ContactSettings(young_modulus, arguments.friction or 0.0)
    linear = pressed_tools(body, tool, arguments.at, arguments.by, settings)
    touches, displacements = _deformed(arguments, body, linear, young_modulus)
    common = _common_figures(arguments, displacements, young_modulus)
    figures = [(tool_figures if arguments.json else tool_summary)(touch) for touch in touches]
    _print(arguments, figures, common)
    return 0


def _press_resting(arguments: argparse.Namespace, body: SoftBody, young_modulus: float) -> int:
    refuse_beside_floor(arguments)
    rest = pressed_on_floor(arguments, body, tool_from(arguments.tool), young_modulus)
    if arguments.displacements is not None:
        with atomic_file(arguments.displacements) as file:
            np.save(file, rest.displacements())
    contacts = [{"tool": arguments.tool, **touch_figures(touch)} for touch in rest.tools]
    _print(arguments, contacts, rest_figures(rest, young_modulus))
    return 0


def _print(
    arguments: argparse.Namespace,
    contacts: list[dict[str, object]],
    common: dict[str, object],
    coupling: NDArray[np.float64] | None = None,
) -> None:
    """Figures of each contact and of all, m/N those of the coupling between contacts."""
    if len(contacts) == 1:
        figures = contacts[0] | common
        print(json.dumps(figures) if arguments.json else as_lines(figures))
    elif arguments.json:
        coupled = {} if coupling is None else {"coupling": coupling.tolist()}
        print(json.dumps({"contacts": contacts, **coupled, **common}))
    else:
        for number, contact in enumerate(contacts, start=1):
            print(f"contact {number}\n{_indented(as_lines(contact))}")
        if coupling is not None:
            print("coupling, m/N (how far each contact moves per newton on each)")
            print(_as_table(coupling))
        print(as_lines(common))


def _deformed(
    arguments: argparse.Namespace,
    body: SoftBody,
    linear: tuple[One, ...],
    young_modulus: float,
    *,
    firm: bool = True,
) -> tuple[tuple[One, ...], NDArray[np.float64]]:
    """Touches as they are felt, from ``linear`` ones, and displacements (n, 3), written where that
    is asked for; ``firm`` where the shape tells the forces, too.
    """
    chosen, loads = shape(body, shape_of(arguments), arguments.body), loads_of(linear)
    touches = linear
    try:
        displacements = settled(body, chosen, loads, young_modulus).displacements
        if firm:
            pressed = felt(chosen, linear, young_modulus)
            touches = pressed.touches
            if not pressed.firmness.is_whole:
                print(f"palpate: warning: {TOO_DEEP}", file=sys.stderr)
    finally:
        chosen.close()
        if chosen.notice:
            print(f"palpate: warning: {chosen.notice}", file=sys.stderr)
    finite = all(np.isfinite(load.forces).all() for load in loads)
    if not (finite and np.isfinite(displacements).all()):
        raise PalpateError(
            f"--young: at {young_modulus} Pa this press is beyond what numbers can hold; give less"
        )
    if arguments.displacements is not None:
        with atomic_file(arguments.displacements) as file:
            np.save(file, displacements)
    return touches, displacements


def _common_figures(
    arguments: argparse.Namespace, displacements: NDArray[np.float64], young_modulus: float
) -> dict[str, object]:
    return {
        "max_displacement": float(np.linalg.norm(displacements, axis=1).max()),
        "young_modulus": young_modulus,
        "shape": shape_name(shape_of(arguments)),
    }


def _contact_figures(
    body: SoftBody, touch: PointTouch, displacements: NDArray[np.float64]
) -> dict[str, object]:
    return {
        "triangle": touch.triangle.tolist(),
        "alpha": touch.alpha.tolist(),
        "point": touch.point.tolist(),
        "nodal_forces": touch.nodal_forces.tolist(),
        "force": touch.force.tolist(),
        "contact_displacement": contact_displacement(body, touch, displacements).tolist(),
    }


def _coupling(body: SoftBody, at: list[list[float]], young_modulus: float) -> NDArray[np.float64]:
    """C_pq / E, (m, m, 3, 3), m/N."""
    places = body.closest_points.query(np.array(at))
    return compliance_between(body, places.triangle, places.alpha) / young_modulus


def _as_table(coupling: NDArray[np.float64]) -> str:
    """The blocks as one matrix, three rows and columns for each contact."""
    size = 3 * len(coupling)
    rows = coupling.transpose(0, 2, 1, 3).reshape(size, size)
    return "\n".join("".join(f"{value:11.3e}" for value in row) for row in rows)


def _indented(lines: str) -> str:
    return "\n".join(f"  {line}" for line in lines.splitlines())
