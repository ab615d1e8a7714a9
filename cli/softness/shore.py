"""``palpate shore``: Shore value to Young's modulus by every relation, or the inverse."""

from __future__ import annotations

import argparse
import json

from ...core.errors import PalpateError
from ...core.softness.scales.relations import RELATIONS, RUBBER_POISSON_RATIO
from ...core.softness.scales.shore import (
    SCALES,
    Shore,
    shore_from_young,
    young_from_shore,
    young_range,
)
from ..body.figure_lines import as_lines

HELP = "convert Shore 00 or A to Young's modulus, and back"
DESCRIPTION = "Print Young's modulus for a Shore value, or the Shore values for Young's modulus."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument(
        "value", nargs="?", metavar="SHORE", help="Shore value, such as 00-30 or A20"
    )
    which.add_argument(
        "--young", type=float, metavar="PA", help="Young's modulus, to convert to Shore values"
    )
    parser.add_argument(
        "--poisson",
        type=float,
        default=RUBBER_POISSON_RATIO,
        metavar="NU",
        help="Poisson's ratio (default: %(default)g, rubber)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Convert and print."""
    figures = _both_scales(arguments) if arguments.value is None else _moduli(arguments)
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0


def _moduli(arguments: argparse.Namespace) -> dict[str, object]:
    shore = Shore.parse(arguments.value)
    usual = young_from_shore(shore, arguments.poisson)
    figures: dict[str, object] = {"shore": str(shore), "young_modulus": usual}
    for name, relation in RELATIONS.items():
        if relation.scale == shore.scale and relation.lowest <= shore.value <= relation.highest:
            figures[f"young_by_{name}"] = young_from_shore(shore, arguments.poisson, name)
    return figures


def _both_scales(arguments: argparse.Namespace) -> dict[str, object]:
    """Value on each scale whose range includes this modulus; raises if there is none."""
    figures: dict[str, object] = {"young_modulus": arguments.young}
    refusals = []
    for scale in SCALES:
        try:
            shore = shore_from_young(arguments.young, scale, arguments.poisson)
        except PalpateError as refusal:
            refusals.append(refusal)
        else:
            figures[f"shore_{scale.lower()}"] = round(shore.value, 1)
    if len(refusals) == len(SCALES):
        # Scales go from soft to firm: the first one's error fits a modulus softer than all.
        softest, _ = young_range(SCALES[0], arguments.poisson)
        raise refusals[0 if arguments.young < softest else -1]
    return figures
