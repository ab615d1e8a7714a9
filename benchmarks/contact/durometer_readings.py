"""What the virtual durometer reads on blocks and layers, and how even a softness map is.

    python benchmarks/contact/durometer_readings.py

Referees: closed forms of a ball and a truncated cone on a half-space; Dimitriadis et al. 2002 for a
ball on a bonded layer; the even pressure on a disc. Exit status 1 where a claim of docs/softness.md
fails.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.softness.durometer import block_reading, read_durometer
from palpate.core.softness.scales.durometer_type import TYPE_00, TYPES
from palpate.core.softness.scales.indentation import indenter_force
from palpate.core.softness.scales.shore import Shore, young_from_shore
from palpate.core.softness.softness_map import softness_map
from palpate.tests.bodies.soft_block import soft_block

BLOCK = (0.08, 0.08, 0.05)
MIDDLE = (0.041, 0.0385, 0.05)
READINGS = range(10, 91, 10)
# Claims, in points of the scale and as shares.
BLOCK_POINTS, RELATION_POINTS, LAYER_POINTS = 0.8, 5.0, 1.5
PAD_TEXTURE, PAD_MESH = 0.03, 0.01


def main() -> int:
    """Print the tables."""
    held = [blocks(), layers(), maps()]
    return 0 if all(held) else 1


def blocks() -> bool:
    """Readings on a block of 80 x 80 x 50 mm against the half-space's."""
    coarse, fine = soft_block(BLOCK, (8, 8, 5)), soft_block(BLOCK, (12, 12, 8))
    print("Block, edges 10 and 6.5 mm. Young's modulus by the usual relation of the scale.\n")
    print("| Shore | half-space | block, coarse | block, fine | in the standard's stand |")
    print("|---|---|---|---|---|")
    held = True
    for scale, kind in TYPES.items():
        for value in READINGS:
            shore = Shore(scale, float(value))
            young = young_from_shore(shore, coarse.poisson_ratio)
            expected = block_reading(kind, young, coarse.poisson_ratio)
            read = [_value(body, scale, young) for body in (coarse, fine)]
            stand = _value(coarse, scale, young, kind.load)
            print(f"| {shore} | {expected:.1f} | {read[0]:.1f} | {read[1]:.1f} | {stand:.1f} |")
            held &= max(abs(one - expected) for one in read) < BLOCK_POINTS
            held &= abs(expected - value) < RELATION_POINTS
    return _told(held, f"blocks read as half-spaces within {BLOCK_POINTS} points")


def layers() -> bool:
    """Readings on a layer of rubber on a rigid base."""
    print("\nLayer on a rigid base, Shore 00-60 by the relation.\n")
    print("| thickness, mm | edges, mm | closed form | read | warnings |\n|---|---|---|---|---|")
    held = True
    for height, cells in ((10, (18, 18, 5)), (10, (9, 9, 3)), (6, (24, 24, 4)), (6, (9, 9, 2))):
        body = soft_block((0.036, 0.036, height / 1000), cells, 0.49)
        young = young_from_shore(Shore("00", 60.0), 0.49)
        found = read_durometer(body, (0.0182, 0.0177, height / 1000), young_modulus=young)
        edge, expected = 36 / cells[0], on_layer(young / (1 - 0.49**2), height / 1000)
        print(
            f"| {height} | {edge:.1f} | {expected:.1f} | {found.shore.value:.1f} | "
            f"{len(found.warnings)} |"
        )
        if edge <= height / 4:
            held &= abs(found.shore.value - expected) < LAYER_POINTS
        else:
            held &= bool(found.warnings)
    return _told(held, f"within {LAYER_POINTS} points where edges are a quarter of the thickness")


def on_layer(stiffness: float, height: float) -> float:
    """Reading of type 00 on a bonded incompressible layer, plane-strain modulus in pascal."""
    depth = np.linspace(1e-6, TYPE_00.travel, 20_000)
    chi = np.sqrt(TYPE_00.shaft * depth) / height
    firmer = 1 + 1.133 * chi + 1.283 * chi**2 + 0.769 * chi**3 + 0.0975 * chi**4
    # Their ball is a paraboloid; the exact ball's force on a half-space takes its place.
    alone = np.array([indenter_force(TYPE_00, d) for d in depth.tolist()])
    readings = 100 * (1 - depth / TYPE_00.travel)
    spring = TYPE_00.force_at_zero + TYPE_00.force_per_point * readings
    return float(np.interp(0.0, stiffness * alone * firmer - spring, readings))


def maps() -> bool:
    """How a softness map follows two shaken meshes of one block."""
    print("\nSoftness in the middle of a block's top, shaken meshes, N/mm (scatter).\n")
    print("| pad radius, mm | half-space | edges 13 mm | edges 6.5 mm |\n|---|---|---|---|")
    bodies = [soft_block(BLOCK, cells, jitter=0.25) for cells in ((6, 6, 4), (12, 12, 8))]
    held = True
    for radius in (0.0, 0.0025, 0.005, 0.01):
        found = [softness_map(body, pad_radius=radius).stiffness[_top(body)] for body in bodies]
        closed = 3 * np.pi**2 / 16 * radius * 1e5 / (1 - 0.45**2) / 1000
        expected = f"{closed:.3f}" if radius else ""
        cells = [f"{k.mean() / 1000:.3f} ({100 * k.std() / k.mean():.1f} %)" for k in found]
        name = f"{1000 * radius:g}" if radius else "bare node"
        print(f"| {name} | {expected} | {cells[0]} | {cells[1]} |")
        if radius == 0.005:
            held &= max(k.std() / k.mean() for k in found) < PAD_TEXTURE
            held &= abs(found[0].mean() / found[1].mean() - 1) < PAD_MESH
    return _told(held, "a pad of 5 mm feels no mesh")


def _value(body: SoftBody, scale: str, young: float, load: float | None = None) -> float:
    return read_durometer(body, MIDDLE, scale, young_modulus=young, load=load).shore.value


def _top(body: SoftBody) -> NDArray[np.int64]:
    x, y, z = body.mesh.nodes[body.mesh.surface_nodes].T
    return np.flatnonzero((z > 0.0499) & (np.abs(x - 0.04) < 0.02) & (np.abs(y - 0.04) < 0.02))


def _told(held: bool, claim: str) -> bool:
    print(f"\n{'holds' if held else 'FAILS'}: {claim}")
    return held


if __name__ == "__main__":
    sys.exit(main())
