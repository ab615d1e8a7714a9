"""``palpate ild``: the forces by which foam is sold, and its modulus."""

from __future__ import annotations

import argparse
import json

from ...core.softness.ild import ild_of_force, ild_of_young
from ..body.figure_lines import as_lines

HELP = "convert the indentation force that foam is sold by to Young's modulus, and back"
DESCRIPTION = (
    "Press a virtual slab of flexible foam as ISO 2439 and ASTM D3574 do, and print the forces "
    "at 25, 40 and 65 % with Young's modulus."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument(
        "force", nargs="?", type=float, metavar="N", help="force at 25 %%, newton (4.45 a lbf)"
    )
    which.add_argument(
        "--young", type=float, metavar="PA", help="Young's modulus of the foam at small strain"
    )


def run(arguments: argparse.Namespace) -> int:
    """Press and print."""
    forces = (
        ild_of_young(arguments.young) if arguments.force is None else ild_of_force(arguments.force)
    )
    figures: dict[str, object] = {
        "ild_25_n": forces.at_25,
        "ild_40_n": forces.at_40,
        "ild_65_n": forces.at_65,
        "support_factor": forces.support_factor,
        "young_modulus_at_small_strain": forces.young_modulus,
        "young_modulus_in_the_mean": forces.mean_modulus,
    }
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0
