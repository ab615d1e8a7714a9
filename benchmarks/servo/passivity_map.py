"""For which body, delay and encoder a touch stays passive, with and without the servo's coupling.

    python benchmarks/servo/passivity_map.py [--plants N] [--docs]

Searches for the stiffest passive body of a typical desktop device (the loop is the servo's own
code, the hands are those of tests/passivity/passivity.py), draws the borders in
build/reports/passivity.png and, with ``--docs``, in docs/images/passivity.png. Then it tries the
default coupling on all corners of the documented range and on N plants inside (100 unless told
otherwise). A plant that is not passive is named, and the exit code is 1.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter
from numpy.typing import NDArray

from palpate.tests.passivity.closed_forms import stable_stiffness
from palpate.tests.passivity.contact_loop import NONE, CouplingSettings, DevicePlant
from palpate.tests.passivity.plant_range import COARSE, RANGE
from palpate.tests.passivity.trials import judge, stiffest_passive_body

PROJECT = Path(__file__).resolve().parents[2]
DESKTOP = DevicePlant(mass=0.1, damping=0.5, coulomb=0.09, force_step=1e-3)
DELAYS_MS = np.arange(0.0, 5.01, 0.5)
ENCODERS_UM = (1, 60, 200)
LEAST, MOST = 50.0, 20_000.0
DEFAULT = CouplingSettings.for_devices(1000)
SETTINGS = {
    "The body itself": NONE,
    "Passivity control alone": CouplingSettings(passivity_control=True),
    f"Limit of {DEFAULT.stiffness:.0f} N/m alone": CouplingSettings(DEFAULT.stiffness),
    "Default: limit, damping and control": DEFAULT,
}
RANGE_BODIES = (100.0, 300.0, 700.0, 5000.0)
# Okabe and Ito's palette; lines differ in their marks too.
LOOKS = {1: ("#0072B2", "o", "-"), 60: ("#E69F00", "s", "--"), 200: ("#CC3311", "^", ":")}

Borders = dict[tuple[str, int], NDArray[np.float64]]


def desktop(encoder_um: int, delay_ms: float) -> DevicePlant:
    """The device of the map."""
    return replace(DESKTOP, encoder_step=encoder_um * 1e-6, delay=delay_ms * 1e-3)


def search(pool: ThreadPoolExecutor) -> Borders:
    """The stiffest passive body for each setting, encoder and delay; N/m."""
    cases = list(product(SETTINGS, ENCODERS_UM))

    def border(case: tuple[tuple[str, int], float]) -> float:
        (name, encoder), delay = case
        plant = desktop(encoder, delay)
        return stiffest_passive_body(plant, SETTINGS[name], least=LEAST, most=MOST)

    found = list(pool.map(border, product(cases, DELAYS_MS)))
    return dict(zip(cases, np.reshape(found, (len(cases), -1)), strict=True))


def print_table(borders: Borders) -> None:
    """Borders as text."""
    print("stiffest passive body, N/m (all: every body up to 20,000), by delay in ms")
    print(f"{'':36} {'encoder':>8}" + "".join(f"{delay:8.1f}" for delay in DELAYS_MS))
    for (name, encoder), values in borders.items():
        shown = ["all" if v >= MOST else "none" if v == 0.0 else f"{v:.0f}" for v in values]
        print(f"{name:36} {encoder:5} um" + "".join(f"{text:>8}" for text in shown))


def draw(path: Path, borders: Borders) -> None:
    """Four panels: below a line every body is passive."""
    mpl.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(2, 2, figsize=(10.0, 8.0), sharex=True, sharey=True)
    for axes, name in zip(panels.flat, SETTINGS, strict=True):
        draw_panel(axes, name, borders)
    for axes in panels[1]:
        axes.set_xlabel("delay besides the tick's own holding, ms")
    for axes in panels[:, 0]:
        axes.set_ylabel("stiffness of the body, N/m")
    panels[1, 1].annotate(
        "range of\nthe default",
        (1.0, 55.0),
        ha="center",
        va="bottom",
        fontsize=10,
        color="#333333",
    )
    handles, labels = panels[1, 1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=3, frameon=False, fontsize=10)
    figure.suptitle(
        "Below its line every body is passive, whoever holds the device\n"
        f"({DESKTOP.mass * 1e3:.0f} g, {DESKTOP.damping:g} N s/m, friction "
        f"{DESKTOP.coulomb * 1e3:.0f} mN, 1 kHz)",
        fontsize=12,
    )
    figure.tight_layout(rect=(0.0, 0.09, 1.0, 1.0))
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_panel(axes: Axes, name: str, borders: Borders) -> None:
    """One setting."""
    worst = np.min([borders[name, encoder] for encoder in ENCODERS_UM], axis=0)
    axes.fill_between(
        DELAYS_MS,
        LEAST,
        np.maximum(worst, LEAST),
        color="#009E73",
        alpha=0.15,
        linewidth=0.0,
        label="passive with all three encoders",
    )
    for encoder in ENCODERS_UM:
        colour, mark, line = LOOKS[encoder]
        axes.plot(
            DELAYS_MS,
            np.where(borders[name, encoder] > 0.0, borders[name, encoder], np.nan),
            line,
            marker=mark,
            markersize=5,
            color=colour,
            clip_on=False,
            label=f"encoder of {encoder} µm"
            + (" (outside the range)" if encoder * 1e-6 > RANGE.encoder_step[1] else ""),
        )
    delays = np.linspace(0.0, DELAYS_MS[-1], 200)
    theory = [stable_stiffness(DESKTOP.damping, 1e-3, delay * 1e-3) for delay in delays]
    axes.plot(
        delays, theory, color="black", linewidth=1.2, label="theory, any encoder: b / (T/2 + delay)"
    )
    axes.plot(
        [0.0, 0.35],
        [2.0 * DESKTOP.coulomb / (ENCODERS_UM[-1] * 1e-6)] * 2,
        color=LOOKS[ENCODERS_UM[-1]][0],
        linewidth=3.0,
        alpha=0.5,
        label=f"theory, {ENCODERS_UM[-1]} µm: 2 friction / step",
    )
    if SETTINGS[name] == DEFAULT:
        axes.axvspan(
            0.0,
            RANGE.delay[1] * 1e3,
            color="#56B4E9",
            alpha=0.18,
            linewidth=0.0,
            label="delays of the default's range",
        )
    if np.isfinite(SETTINGS[name].stiffness):
        axes.axhline(SETTINGS[name].stiffness, color="#666666", linewidth=1.0, linestyle="-.")
        axes.annotate(
            "felt as the limit above",
            (2.05, SETTINGS[name].stiffness * 1.1),
            fontsize=9,
            color="#333333",
        )
    axes.set_title(name, fontsize=11, loc="left")
    axes.set_yscale("log")
    axes.set_ylim(LEAST, MOST)
    axes.set_xlim(0.0, DELAYS_MS[-1])
    axes.yaxis.set_major_locator(FixedLocator([50, 100, 300, 1000, 3000, 10_000, 20_000]))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def prove(pool: ThreadPoolExecutor, name: str, plants: Iterable[DevicePlant]) -> bool:
    """Try the default on plants; False if one is not passive."""
    cases = list(product(plants, RANGE_BODIES))

    def excess(case: tuple[DevicePlant, float]) -> float:
        plant, body = case
        coupling = CouplingSettings.for_devices(plant.rate_hz, plant.encoder_step)
        return judge(plant, body, coupling).excess

    found = list(pool.map(excess, cases))
    failed = [(e, *case) for e, case in zip(found, cases, strict=True) if e > 1.0]
    print(
        f"{name}: {len(cases) // len(RANGE_BODIES)} plants on {len(RANGE_BODIES)} bodies, "
        f"{len(failed)} not passive; at worst {max(found):.0%} of the allowed energy"
    )
    for e, plant, body in sorted(failed, key=lambda failure: -failure[0])[:5]:
        print(f"  NOT PASSIVE: {e:.1f} of what is allowed, body {body:g} N/m, {plant}")
    return not failed


def main(arguments: Sequence[str] | None = None) -> int:
    """Search, draw, prove."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plants", type=int, default=100, metavar="N", help="inside the range")
    parser.add_argument("--docs", action="store_true", help="rewrite the docs' picture too")
    options = parser.parse_args(arguments)
    begin = time.perf_counter()
    # The simulation lets go of the interpreter's lock.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        borders = search(pool)
        print_table(borders)
        draw(PROJECT / "build" / "reports" / "passivity.png", borders)
        if options.docs:
            draw(PROJECT / "docs" / "images" / "passivity.png", borders)
        print(f"default: {DEFAULT}")
        passive = [
            prove(pool, "corners of the range", RANGE.corners()),
            prove(pool, "inside the range", RANGE.drawn(options.plants, seed=1)),
            prove(pool, "corners, coarse encoders", COARSE.corners()),
            prove(pool, "inside, coarse encoders", COARSE.drawn(options.plants, seed=1)),
        ]
    print(f"{time.perf_counter() - begin:.0f} s")
    return 0 if all(passive) else 1


if __name__ == "__main__":
    sys.exit(main())
