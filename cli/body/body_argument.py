"""The body that a command works on."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_body(parser: argparse.ArgumentParser) -> None:
    """``BODY.npz``, always the first argument."""
    parser.add_argument(
        "body", type=Path, metavar="BODY.npz", help="body file, as 'palpate bake' writes it"
    )
