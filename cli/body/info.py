"""``palpate info``: contents of a body file."""

from __future__ import annotations

import argparse
import json
import sys
import time

from ...core.body import body_file
from ...core.mesh.fit import size_warnings
from .body_argument import add_body
from .body_figures import body_figures
from .figure_lines import as_lines

HELP = "check a body file and print its figures"
DESCRIPTION = "Check a body file against its checksums and print its size, material and pins."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser)


def run(arguments: argparse.Namespace) -> int:
    """Load, check and describe."""
    start = time.perf_counter()
    body = body_file.load(arguments.body)
    figures = {**body_figures(body), "seconds": {"load": time.perf_counter() - start}}
    for warning in size_warnings(body.mesh):
        print(f"palpate: warning: {warning}", file=sys.stderr)
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0
