"""Arguments for a command's body and its firmness."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.body.soft_body import SoftBody
from ...core.stiffness.assembly import lame_parameters


def add_body(parser: argparse.ArgumentParser, *, or_scene: bool = False) -> None:
    """Add ``BODY.npz``, always the first argument; or a scene of several bodies in its place."""
    told = "body file, as 'palpate bake' writes it"
    parser.add_argument(
        "body",
        type=Path,
        metavar="BODY.npz|SCENE.json" if or_scene else "BODY.npz",
        help=f"{told}; or a scene file (docs/free-bodies.md)" if or_scene else told,
    )


def add_young(parser: argparse.ArgumentParser | argparse._MutuallyExclusiveGroup) -> None:
    """Add ``--young PA``."""
    parser.add_argument(
        "--young", type=float, metavar="PA", help="Young's modulus (default: the body's own)"
    )


def modulus_of(arguments: argparse.Namespace, body: SoftBody) -> float:
    """Young's modulus in pascal: as given, or the body's own.

    Raises
    ------
    PalpateError
        It is not positive.
    """
    modulus: float = body.young_modulus if arguments.young is None else arguments.young
    lame_parameters(modulus, body.poisson_ratio)
    return modulus
