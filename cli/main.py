"""Entry point of the command line ``palpate``."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn

from ..core.errors import PalpateError
from .bake import bake, pin
from .body import info
from .press import devices, press, servo
from .rest import settle
from .softness import curve, durometer, ild, materials, shore, softness

COMMANDS = (
    *(bake, info, pin, press, settle, servo, devices),
    *(materials, shore, ild, durometer, curve, softness),
)
EXIT_ERROR = 2


class _OneLineParser(argparse.ArgumentParser):
    """Parser with one-line errors."""

    def error(self, message: str) -> NoReturn:
        """Print the message and exit with the status of an error."""
        self.exit(EXIT_ERROR, f"palpate: {message}; see '{self.prog} --help'\n")


def make_parser() -> argparse.ArgumentParser:
    """Parser of all commands."""
    parser = _OneLineParser(
        prog="palpate", description="Make props soft, press them, and read the force."
    )
    subparsers = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for command in COMMANDS:
        name = command.__name__.rpartition(".")[2]
        one = subparsers.add_parser(name, help=command.HELP, description=command.DESCRIPTION)
        command.add_options(one)
        one.add_argument("--json", action="store_true", help="print figures as JSON")
        one.set_defaults(run=command.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; 0 on success, 2 with one line on standard error on failure."""
    if not sys.warnoptions:
        # Warnings of libraries are for developers; users get a result, or one line.
        warnings.simplefilter("ignore")
    given = sys.argv[1:] if arguments is None else arguments
    parsed = make_parser().parse_args([_shielded(word) for word in given])
    try:
        status: int = parsed.run(parsed)
    except PalpateError as problem:
        return _refused(str(problem))
    except OSError as problem:
        return _refused(
            ": ".join(filter(None, (problem.filename, problem.strerror or str(problem))))
        )
    except KeyboardInterrupt:
        print("palpate: stopped", file=sys.stderr)
        return 130
    return status


def _refused(message: str) -> int:
    # Errors of libraries and file names may have several lines.
    print("palpate:", " ".join(message.splitlines()), file=sys.stderr)
    return EXIT_ERROR


def _shielded(word: str) -> str:
    """Arguments with a blank before numbers such as -5e-3, which argparse takes for options."""
    try:
        float(word)
    except ValueError:
        return word
    return f" {word}" if word.startswith("-") else word


if __name__ == "__main__":
    sys.exit(main())
