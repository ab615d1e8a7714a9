"""``blender -c palpate bake|press|animate FILE.blend --object NAME``: operators without a window.

Started with ``blender -c`` Blender has read preferences and extensions but no file; exit status is
0, or 2 with one line on standard error and nothing written.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import NoReturn

import bpy

from ..core.contact.touches import ToolTouch
from ..core.errors import PalpateError
from ..core.shape.shapes import FORMER_NAMES, SHAPES, shape_name
from ..core.softness.scales.materials import MATERIALS
from ..operators.animation.keeping import ITEMS as KEPT_ITEMS
from ..operators.bake import bake_session
from ..operators.object import body_store
from ..operators.press.press_once import press_several
from ..operators.press.pressed import PressedFinger
from ..operators.scene.active_object import chosen_alone
from ..operators.shape.drawn_shape import chosen_shape
from .blend_file import opened_object, save
from .command_options import set_up, set_young, within
from .properties.finger import MODE_ITEMS, TIP_ITEMS
from .properties.soft_object import FORM_ITEMS, FORMULATION_ITEMS

NAME = "palpate"
EXIT_ERROR = 2


class _OneLineParser(argparse.ArgumentParser):
    """Parser with one-line errors."""

    def error(self, message: str) -> NoReturn:
        self.exit(EXIT_ERROR, f"palpate: {message}; see 'blender -c palpate --help'\n")


def run(words: list[str]) -> int:
    """Run a command with its arguments; returns the exit status."""
    try:
        arguments = _parser().parse_args([_shielded(word) for word in words])
    except SystemExit as end:
        # Blender expects a status, and would report an exception as a bug of the extension.
        return int(end.code or 0)
    try:
        figures = arguments.run(arguments)
    except PalpateError as problem:
        print(f"palpate: {problem}", file=sys.stderr)
        return EXIT_ERROR
    if arguments.json:
        print(json.dumps(figures))
    else:
        width = max(map(len, figures))
        for name, value in figures.items():
            print(f"{name.replace('_', ' '):{width}}  {value}")
    return 0


def bake(arguments: argparse.Namespace) -> dict[str, object]:
    """Make an object soft and save the file."""
    thing = opened_object(arguments.file, arguments.object)
    set_up(thing.palpate, arguments)
    before = body_store.present()
    body, report = bake_session.run(thing, bpy.context.scene)
    written = body_store.stamp(thing)
    try:
        save(arguments.file)
    except PalpateError:
        # The body of an unsaved scene has no owner.
        body_store.take_back(thing, before, written)
        raise
    for warning in report.warnings:
        print(f"palpate: warning: {warning}", file=sys.stderr)
    return {
        "object": thing.name,
        "nodes": len(body.mesh.nodes),
        "tets": len(body.mesh.tets),
        "surface_nodes": len(body.mesh.surface_nodes),
        "free_surface_nodes": len(body.compliance.free_surface),
        "surface_triangles": len(body.mesh.surface_triangles),
        "formulation": body.formulation,
        "form": body.compliance.form,
        **_error(thing.palpate),
        "compliance_bytes": body.compliance.nbytes,
        "seconds": report.seconds,
        "key": thing.palpate.body_key,
        "body": str(body_store.locate(thing)),
    }


def _error(baked: bpy.types.PropertyGroup) -> dict[str, object]:
    """Error of the body's compression."""
    return {"column_error": baked.column_error / 100} if baked.baked_form == "compressed" else {}


def press(arguments: argparse.Namespace) -> dict[str, object]:
    """Press an object once; with --keep save the shape in the file."""
    thing = opened_object(arguments.file, arguments.object)
    set_young(thing, arguments)
    if len(arguments.at) != len(arguments.by):
        raise PalpateError(
            f"--by: {len(arguments.by)} for {len(arguments.at)} --at; give one for each finger"
        )
    _choose(thing, arguments)
    pressed = press_several(
        thing, bpy.context.scene, arguments.at, arguments.by, keep=arguments.keep
    )
    for remark in pressed.remarks:
        print(f"palpate: warning: {remark}", file=sys.stderr)
    if arguments.keep:
        save(arguments.file)
    fingers = [_figures(finger) for finger in pressed.fingers]
    return {
        "object": thing.name,
        **(fingers[0] if len(fingers) == 1 else {"fingers": fingers}),
        "max_displacement": pressed.largest_displacement,
        "shape": shape_name(chosen_shape(thing)),
        "layer": pressed.layer,
    }


def animate(arguments: argparse.Namespace) -> dict[str, object]:
    """Bake the animation of what presses an object, and save the file."""
    thing = opened_object(arguments.file, arguments.object)
    set_young(thing, arguments)
    options = {
        option: getattr(arguments, option)
        for option in ("frame_start", "frame_end", "step", "forces")
        if getattr(arguments, option) is not None
    }
    before = set(thing.modifiers.keys())
    try:
        with chosen_alone(thing):
            bpy.ops.palpate.press_frames(keep=arguments.keep_as.upper(), **options)
    except RuntimeError as problem:
        reason = str(problem).strip().removeprefix("Error: ")
        raise PalpateError(f"{arguments.object}: {reason}") from problem
    save(arguments.file)
    made = [modifier.name for modifier in thing.modifiers if modifier.name not in before]
    return {"object": thing.name, "keep_as": arguments.keep_as, "modifiers": made}


def _choose(thing: bpy.types.Object, arguments: argparse.Namespace) -> None:
    """Set tip, contact mode and shape from the options."""
    chosen = bpy.context.scene.palpate
    if arguments.radius is not None:
        chosen.tip_radius = within(chosen, "tip_radius", "radius", arguments.radius)
    if arguments.shape is not None:
        asked = "table" if arguments.shape == "paper" else arguments.shape
        thing.palpate.shape = asked.upper().replace("-", "_")
    for option, name in (("mode", "contact_mode"), ("tip", "tip")):
        if getattr(arguments, option) is not None:
            setattr(chosen, name, getattr(arguments, option).upper())


def _figures(finger: PressedFinger) -> dict[str, object]:
    """Figures of a finger; a point with its triangle, a tool with area and pressure."""
    made = finger.made
    figures: dict[str, object] = {"force": list(finger.force), "depth": finger.depth}
    if isinstance(made, ToolTouch):
        return {**figures, "area": made.area, "largest_pressure": made.largest_pressure}
    return {
        "triangle": made.triangle.tolist(),
        "alpha": made.alpha.tolist(),
        "nodal_forces": made.nodal_forces.tolist(),
        **figures,
    }


def _parser() -> argparse.ArgumentParser:
    parser = _OneLineParser(
        prog="blender -c palpate",
        description="Make objects soft, press them, and bake animations, without a window.",
    )
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    one = commands.add_parser("bake", help="make an object soft and save the file")
    _add_common(one)
    one.add_argument("--material", choices=list(MATERIALS), help="preset, before the other options")
    one.add_argument("--poisson", type=float, metavar="NU", help="Poisson's ratio")
    pins = one.add_mutually_exclusive_group()
    pins.add_argument("--pin-below", type=float, metavar="FRACTION", help="of the height, world Z")
    pins.add_argument("--pin-group", metavar="GROUP", help="vertex group")
    one.add_argument("--edge-length", type=float, metavar="F", help="share of the diagonal")
    one.add_argument("--epsilon", type=float, metavar="F", help="tolerance, share of the diagonal")
    one.add_argument("--time-limit", type=float, metavar="S", help="seconds")
    formulations = [name.lower() for name, *_ in FORMULATION_ITEMS]
    one.add_argument("--formulation", choices=formulations, help="of the stiffness")
    forms = [name.lower() for name, *_ in FORM_ITEMS]
    one.add_argument("--form", choices=forms, help="of the compliance: dense or compressed")
    one.add_argument(
        "--tolerance", type=float, metavar="F", help="largest error of compressing, such as 0.001"
    )
    one.add_argument("--stiff-group", metavar="GROUP", help="vertex group that is stiffer")
    one.add_argument("--stiff-factor", type=float, metavar="F", help="factor on Young's modulus")
    one.set_defaults(run=bake)
    two = commands.add_parser("press", help="press an object once and print the force")
    _add_common(two)
    for name, axes, text in (
        (
            "--at",
            ("X", "Y", "Z"),
            "the surface point nearest to this is touched, world coordinates",
        ),
        ("--by", ("DX", "DY", "DZ"), "how far it is moved, world axes"),
    ):
        told = f"{text}; once a finger"
        two.add_argument(
            name, type=float, nargs=3, action="append", required=True, metavar=axes, help=told
        )
    modes = [name.lower() for name, *_ in MODE_ITEMS]
    two.add_argument("--mode", choices=modes, help="how the contact is computed")
    tips = [name.lower() for name, *_ in TIP_ITEMS]
    two.add_argument("--tip", choices=tips, help="what touches; else as the scene says")
    two.add_argument("--radius", type=float, metavar="R", help="of fingertip or rod, scene units")
    shapes = (*SHAPES, *FORMER_NAMES)
    two.add_argument("--shape", choices=shapes, help="how it deforms; else as the object says")
    two.add_argument("--keep", action="store_true", help="keep a layer and save the file")
    two.set_defaults(run=press)
    three = commands.add_parser("animate", help="bake an animation and save the file")
    _add_common(three)
    for name, told in (("--frame-start", "first"), ("--frame-end", "last")):
        three.add_argument(
            name, type=int, metavar="N", help=f"{told} frame; else the scene's {told}"
        )
    three.add_argument("--step", type=int, metavar="N", help="keep every so many frames")
    kinds = [name.lower() for name, *_ in KEPT_ITEMS]
    three.add_argument("--keep-as", choices=kinds, default="cache", help="what plays it")
    three.add_argument("--forces", metavar="FILE.csv", help="table of forces a frame")
    three.set_defaults(run=animate)
    return parser


def _add_common(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, metavar="FILE.blend")
    parser.add_argument("--object", required=True, metavar="NAME")
    parser.add_argument("--young", type=float, metavar="PA", help="Young's modulus")
    parser.add_argument("--json", action="store_true", help="print figures as JSON")


def _shielded(word: str) -> str:
    """Argument with a blank before a number such as -5e-3, which argparse takes for an option."""
    try:
        float(word)
    except ValueError:
        return word
    return f" {word}" if word.startswith("-") else word


_commands: list[object] = []


def register() -> None:
    """Add the command."""
    _commands.append(bpy.utils.register_cli_command(NAME, run))


def unregister() -> None:
    """Remove the command."""
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
