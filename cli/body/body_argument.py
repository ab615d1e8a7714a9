"""Argument for a command's body."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_body(parser: argparse.ArgumentParser) -> None:
    """Add ``BODY.npz``, always the first argument."""
    parser.add_argument(
        "body", type=Path, metavar="BODY.npz", help="body file, as 'palpate bake' writes it"
    )
