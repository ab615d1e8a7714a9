"""Options for the place and firmness of a measured body."""

from __future__ import annotations

import argparse

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.softness.scales.shore import Shore, young_from_shore
from ..body import body_argument


def add_at(parser: argparse.ArgumentParser) -> None:
    """Add ``--at X Y Z``."""
    parser.add_argument(
        "--at",
        type=float,
        nargs=3,
        required=True,
        metavar=("X", "Y", "Z"),
        help="the surface point nearest to this (metres, body coordinates)",
    )


def add_young(parser: argparse.ArgumentParser) -> None:
    """Add ``--young PA`` or ``--shore SHORE``."""
    group = parser.add_mutually_exclusive_group()
    body_argument.add_young(group)
    group.add_argument(
        "--shore", metavar="SHORE", help="Young's modulus by its Shore value, such as 00-30 or A20"
    )


def young_modulus_of(arguments: argparse.Namespace, body: SoftBody) -> float:
    """Young's modulus in pascal: as given, or the body's own.

    Raises
    ------
    PalpateError
        A modulus that is not positive, a Shore value that cannot be read or is beyond its scale.
    """
    if arguments.shore is not None:
        return young_from_shore(Shore.parse(arguments.shore), body.poisson_ratio)
    return body_argument.modulus_of(arguments, body)


def positive_length(text: str) -> float:
    """Length in metres, for ``argparse``."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is no positive number of metres")
    return value


def refuse_suffix(option: str, name: str, suffix: str, known: tuple[str, ...]) -> None:
    """Refuse a file of an unknown kind.

    Raises
    ------
    PalpateError
        ``suffix`` is not among the ``known``.
    """
    if suffix.lower() not in known:
        raise PalpateError(
            f"{option}: {name} is none of the kinds that can be written; end it in "
            f"{' or '.join(known)}"
        )
