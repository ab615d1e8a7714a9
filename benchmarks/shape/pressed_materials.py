"""The same press on rubber, foam and memory foam, at once and after two seconds, beside linear.

    python benchmarks/shape/pressed_materials.py [--picture docs/images/pressed-materials.png]

A flat disc goes into a slab by up to two fifths of its thickness, as in the indentation test of
foam: :mod:`palpate.core.softness.pressed_slab`, neo-Hookean rubber of a Poisson's ratio of 0.45 and
the foam of :mod:`palpate.core.softness.ild`. Printed are forces over E times the disc's area, E the
modulus at small strain, of memory foam the one that lasts. Nothing is claimed.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.law.of_material import LAWS
from palpate.core.law.relaxation import RELAXATIONS
from palpate.core.softness.ild import DISC_AREA, slab
from palpate.core.softness.pressed_slab import PressedSlab

SHARES = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4)
SHALLOW = 0.001
RUBBER_RATIO = 0.45
LATER = 2.0
MILLIMETRES = 1e3

Array = NDArray[np.float64]


def main() -> int:
    """Print the table, and draw the picture if asked for."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--picture", type=Path, metavar="PNG")
    options = parser.parse_args()
    foam = slab(LAWS["foam"].law)
    rubber = replace(foam, law=NeoHookean(), poisson_ratio=RUBBER_RATIO)
    linear, shape = linearly(foam)
    fading = RELAXATIONS["MEMORY_FOAM"].modulus
    lasting = foam.forces(SHARES) / DISC_AREA
    curves = {
        "linear": linear,
        "rubber": rubber.forces(SHARES) / DISC_AREA,
        "foam": lasting,
        "memory foam, at once": fading(0.0) * lasting,
        f"memory foam, after {LATER:g} s": fading(LATER) * lasting,
    }
    print(f"{'of thickness':26s}" + "".join(f"{share:8.2f}" for share in SHARES))
    for name, curve in curves.items():
        print(f"{name:26s}" + "".join(f"{value:8.3f}" for value in curve))
    if options.picture is not None:
        shapes = {"linear": (foam, shape)}
        shapes |= {
            name: (one, one.shapes(SHARES)[-1])
            for name, one in (("rubber", rubber), ("foam", foam))
        }
        draw(options.picture, curves, shapes)
    return 0


def linearly(one: PressedSlab) -> tuple[Array, Array]:
    """Forces over E times the disc's area at :data:`SHARES`, and the shape at the last of these."""
    (little,) = one.shapes((SHALLOW,))
    slope = one.forces((SHALLOW,))[0] / SHALLOW / DISC_AREA
    return slope * np.array(SHARES), little * (SHARES[-1] / SHALLOW)


def draw(
    path: Path, curves: dict[str, Array], shapes: dict[str, tuple[PressedSlab, Array]]
) -> None:
    """Shapes at the last share on the left, curves on the right."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure = plt.figure(figsize=(11, 5.2), layout="constrained")
    grid = figure.add_gridspec(len(shapes), 2, width_ratios=(1.1, 1.0))
    for row, (name, (one, moved)) in enumerate(shapes.items()):
        axes = figure.add_subplot(grid[row, 0])
        z = one.places[:, 1].reshape(-1, np.count_nonzero(one.places[:, 1] == 0.0))
        places = MILLIMETRES * (one.places + moved).reshape(*z.shape, 2)
        for side in (-1.0, 1.0):
            axes.plot(side * places[:, :, 0], places[:, :, 1], color="#9fb4bb", lw=0.6)
            axes.plot(side * places[:, :, 0].T, places[:, :, 1].T, color="#9fb4bb", lw=0.6)
            axes.plot(side * places[-1, :, 0], places[-1, :, 1], color="#1f7a80", lw=2.0)
        axes.set(aspect="equal", ylabel="mm")
        axes.text(0.5, 0.8, f"{name}, {SHARES[-1]:.0%} deep", ha="center", transform=axes.transAxes)
    axes = figure.add_subplot(grid[:, 1])
    for name, curve in curves.items():
        style = "--" if name == "linear" else "-"
        axes.plot([0.0, *np.multiply(100.0, SHARES)], [0.0, *curve], style, lw=2.0, label=name)
    axes.set(xlabel="depth, % of the thickness", ylabel="force over E times the disc's area")
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    raise SystemExit(main())
