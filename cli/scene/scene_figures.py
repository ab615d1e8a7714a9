"""Figures of bodies at rest: where each lies, and what bears what; their surfaces as a file."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...core.files.atomic_file import atomic_file
from ...core.rest.rest import BodyTouch, Rest
from ..body.figure_lines import as_lines
from .scene_file import Scene

Told = dict[str, list[dict[str, Any]]]


def scene_figures(scene: Scene, rests: Sequence[Rest], tool_names: Sequence[str]) -> Told:
    """Bodies with what touches each, and tools with what they feel, as plain values; SI units.

    Forces are those on the body of which they are told, in the world.
    """
    bodies = [
        _body(scene, name, rest, tool_names)
        for name, rest in zip(scene.body_names, rests, strict=True)
    ]
    tools = [
        {
            "name": name,
            "force": np.sum([rest.tools[number].force for rest in rests], axis=0).tolist(),
        }
        for number, name in enumerate(tool_names)
    ]
    return {"bodies": bodies, "tools": tools}


def _body(scene: Scene, name: str, rest: Rest, tool_names: Sequence[str]) -> dict[str, object]:
    touches = [
        *zip(scene.support_names, rest.supports, strict=True),
        *zip(scene.body_names, rest.others, strict=True),
        *zip(tool_names, rest.tools, strict=True),
    ]
    turn = Rotation.from_matrix(rest.placement.rotation).as_rotvec(degrees=True)
    return {
        "name": name,
        "position": rest.placement.position.tolist(),
        "rotation": turn.tolist(),
        **_mass(rest),
        "max_displacement": float(np.linalg.norm(rest.displacements(), axis=1).max()),
        "elastic_energy": rest.elastic,
        "touched_by": [
            {"name": other, **_pressed(touch)} for other, touch in touches if len(touch.places)
        ],
    }


def _mass(rest: Rest) -> dict[str, object]:
    if not rest.body.is_free:
        return {}
    return {"centre_of_mass": rest.centre.tolist(), "mass_kg": rest.body.mass}


def _pressed(touch: BodyTouch) -> dict[str, object]:
    return {
        "force": (-touch.force).tolist(),
        "pressed_points": len(touch.places),
        "pressed_area_m2": float(touch.areas.sum()),
        "largest_pressure_pa": float(touch.pressures.max(initial=0.0)),
    }


def for_people(figures: Told) -> str:
    """The same, short enough to read: a paragraph a body, a line for each that touches it."""
    lines = []
    for body in figures["bodies"]:
        told = {name: value for name, value in body.items() if name not in {"name", "touched_by"}}
        lines += [str(body["name"]), _indented(as_lines(told))]
        lines += [
            f"  touched by {one['name']}: force {as_lines({'': one['force']}).strip()} N"
            for one in body["touched_by"]
        ]
    lines += [
        f"{tool['name']}: force {as_lines({'': tool['force']}).strip()} N"
        for tool in figures["tools"]
    ]
    return "\n".join(lines)


def write_surfaces(
    path: Path,
    scene: Scene,
    rests: Sequence[Rest],
    what: Callable[[Rest], NDArray[np.float64]],
) -> None:
    """Write an array (n, 3) of each body's surface nodes into one .npz, under the body's name."""
    with atomic_file(path) as file, zipfile.ZipFile(file, "w") as archive:
        for name, rest in zip(scene.body_names, rests, strict=True):
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, what(rest), allow_pickle=False)


def _indented(lines: str) -> str:
    return "\n".join(f"  {line}" for line in lines.splitlines())
