"""``palpate materials``: the presets and their sources."""

from __future__ import annotations

import argparse
import json

from ...core.law.of_material import LAWS, RUBBER
from ...core.softness.scales.materials import MATERIALS, Material

HELP = "list the material presets and their sources"
DESCRIPTION = (
    "List the materials that 'palpate bake --material' knows, with their constants "
    "and where these come from."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""


def run(arguments: argparse.Namespace) -> int:
    """Print all presets."""
    if arguments.json:
        print(json.dumps({name: _figures(material) for name, material in MATERIALS.items()}))
        return 0
    for name, material in MATERIALS.items():
        shore = "" if material.shore is None else f", Shore {material.shore}"
        constants = f"{_pascal(material.young_modulus)}, {material.poisson_ratio:g}{shore}"
        weight = f"{material.density:g} kg/m3"
        print(f"{name.lower().replace('_', '-'):16}{material.name}: {constants}, {weight}")
        print(f"{'':16}{material.basis}: {material.source}")
        if material.law != RUBBER:
            print(f"{'':16}law of {material.law}: {LAWS[material.law].source}")
    return 0


def material_named(word: str) -> Material:
    """Preset by its printed name, for ``argparse``."""
    key = word.upper().replace("-", "_")
    if key not in MATERIALS:
        raise argparse.ArgumentTypeError(
            f"'{word}' is no material; 'palpate materials' lists them, such as ecoflex-30"
        )
    return MATERIALS[key]


def _figures(material: Material) -> dict[str, object]:
    return {
        "name": material.name,
        "young_modulus": material.young_modulus,
        "poisson_ratio": material.poisson_ratio,
        "basis": material.basis,
        "source": material.source,
        "shore": None if material.shore is None else str(material.shore),
        "density": material.density,
        "law": material.law,
    }


def _pascal(modulus: float) -> str:
    if modulus >= 1e6:
        return f"{modulus / 1e6:.3g} MPa"
    return f"{modulus / 1e3:.3g} kPa"
