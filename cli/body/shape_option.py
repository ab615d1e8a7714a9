"""The shape by which a body is drawn and felt: the material's own unless told otherwise."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

DEFAULT = "(default: real; linear with --mode paper)"


def add_shape(parser: argparse.ArgumentParser, names: Sequence[str], what: str) -> None:
    """Add the option, with the names that it takes and ``what`` they are."""
    parser.add_argument("--shape", choices=names, help=f"{what} {DEFAULT}")


def shape_of(arguments: argparse.Namespace) -> str:
    """Name of the shape that is asked for, also a former one; or of that for what is pressed."""
    asked: str | None = arguments.shape
    return asked or ("linear" if arguments.mode == "paper" else "real")
