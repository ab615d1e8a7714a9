"""What bodies of one to fifty thousand nodes cost, as a table and a plot in the docs.

    python benchmarks/bake/cost_against_size.py [--sizes N ...] [--again] [--docs]

Bakes the mouse in six sizes and both forms, each in its own process, prints the table and draws
build/reports/cost.png. With ``--docs`` it rewrites docs/cost.md and docs/images/cost.png too. What
was measured is kept in build/cost, so that a run that was stopped goes on where it was; ``--again``
measures anew. Best on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import json
import platform
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

from palpate.benchmarks.measuring.bodies import made_body
from palpate.benchmarks.measuring.memory import in_fresh_process, with_peak
from palpate.benchmarks.measuring.timing import median_seconds
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body import body_file
from palpate.core.errors import PalpateError
from palpate.core.machine.machine_speed import dgemm_rate
from palpate.core.stiffness.pins import PinNodes

PROJECT = Path(__file__).resolve().parents[2]
KEPT = PROJECT / "build" / "cost"
SIZES = (1000, 2000, 5000, 10_000, 20_000, 50_000)
FORMS = ("dense", "compressed")
TOUCHES = 200
TABLE_BEGINS, TABLE_ENDS = "<!-- table begins -->", "<!-- table ends -->"
COLOURS = {"dense": "#1f5fa8", "compressed": "#c8562b"}
MARKERS = {"dense": "o", "compressed": "s"}


@dataclass(frozen=True)
class Cost:
    """What one body in one form costs.

    Attributes
    ----------
    nodes, free_surface_nodes : of the tetrahedra.
    form : of the compliance.
    bake_seconds : from tetrahedra to the body in memory, one thread.
    peak_bytes : by how much the process grew meanwhile at most.
    file_bytes : of the body file.
    touch_seconds : median of a nine-column deformation at a random triangle.
    gemm_rate : floating point operations a second of a large matrix product, just before.
    """

    nodes: int
    free_surface_nodes: int
    form: str
    bake_seconds: float
    peak_bytes: int
    file_bytes: int
    touch_seconds: float
    gemm_rate: float


@dataclass(frozen=True)
class Quantity:
    """A column of the table and a panel of the plot."""

    title: str
    unit: str
    of: Callable[[Cost], float]


QUANTITIES = (
    Quantity("Bake", "s", lambda cost: cost.bake_seconds),
    Quantity("Memory while baking", "MB", lambda cost: cost.peak_bytes / 1e6),
    Quantity("Body file", "MB", lambda cost: cost.file_bytes / 1e6),
    Quantity("Touch", "µs", lambda cost: 1e6 * cost.touch_seconds),
)


def bake_once(size: int, form: str) -> Cost:
    """Bake, save and touch, for a process of its own."""
    measured = made_body(size)
    rate = dgemm_rate(1)
    settings = BakeSettings(0.3, 1000.0, PinNodes(measured.fixed), form=form, threads=1)
    start = time.perf_counter()
    (body, _), peak = with_peak(partial(bake, measured.mesh, settings))
    bake_seconds = time.perf_counter() - start
    rng = np.random.default_rng(1999)
    count = body.compliance.node_count
    forces = rng.normal(size=(3, 3))
    loads = iter(rng.integers(0, count, (2 * TOUCHES, 3)))
    touch = median_seconds(lambda: body.compliance.apply(forces, next(loads)), TOUCHES)
    with tempfile.TemporaryDirectory() as folder:
        body_file.save(body, Path(folder) / "body.npz")
        file_bytes = (Path(folder) / "body.npz").stat().st_size
    return Cost(
        nodes=len(body.mesh.nodes),
        free_surface_nodes=count,
        form=form,
        bake_seconds=bake_seconds,
        peak_bytes=peak,
        file_bytes=file_bytes,
        touch_seconds=touch,
        gemm_rate=rate,
    )


def cost_of(size: int, form: str, *, again: bool) -> Cost | None:
    """The cost as it is kept, or measured; None where the body does not fit this machine."""
    file = KEPT / f"{size}-{form}.json"
    if again or not file.exists():
        print(f"baking about {size} nodes, {form} ...", flush=True)
        try:
            cost, _ = in_fresh_process(bake_once, size, form)
        except PalpateError as refusal:
            print(f"  {refusal}")
            return None
        KEPT.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(asdict(cost), indent=1), encoding="utf-8")
    return Cost(**json.loads(file.read_text(encoding="utf-8")))


def exponent(costs: list[Cost], quantity: Quantity, of: Callable[[Cost], int]) -> float:
    """The exponent p of the power law ``size**p`` that fits best in the logarithms."""
    sizes = np.log([of(cost) for cost in costs])
    return float(np.polyfit(sizes, np.log([quantity.of(cost) for cost in costs]), 1)[0])


def all_nodes(cost: Cost) -> int:
    """N, on which the work inside depends."""
    return cost.nodes


def surface_nodes(cost: Cost) -> int:
    """n, the size of the compliance."""
    return cost.free_surface_nodes


def table(costs: list[Cost]) -> str:
    """All figures as Markdown, the fitted exponents in the last rows."""
    header = ["nodes N", "free on the surface n", "form"]
    header += [f"{quantity.title.lower()}, {quantity.unit}" for quantity in QUANTITIES]
    rows = [
        [
            f"{cost.nodes:,}",
            f"{cost.free_surface_nodes:,}",
            cost.form,
            *(three_digits(quantity.of(cost)) for quantity in QUANTITIES),
        ]
        for cost in costs
    ]
    for form in FORMS:
        of_form = [cost for cost in costs if cost.form == form]
        if len(of_form) > 1:
            for name, of in (("N", all_nodes), ("n", surface_nodes)):
                powers = [exponent(of_form, quantity, of) for quantity in QUANTITIES]
                rows.append([f"power of {name}", "", form, *(f"{power:.2f}" for power in powers)])
    align = ["--:", "--:", ":--", *["--:"] * len(QUANTITIES)]
    return "\n".join("| " + " | ".join(row) + " |" for row in [header, align, *rows])


def three_digits(value: float) -> str:
    """A number as a table shows it."""
    if value >= 100:
        return f"{value:,.0f}"
    return f"{value:.3g}"


def machine(costs: list[Cost]) -> str:
    """One sentence on what it was measured with."""
    rates = [cost.gemm_rate / 1e9 for cost in costs]
    return (
        f"Measured with one thread on {platform.machine()} at {np.median(rates):.0f} GF/s of large "
        f"matrix products (from {min(rates):.0f} to {max(rates):.0f} while this was measured), "
        f"Python {platform.python_version()}, numpy {np.__version__}."
    )


def rewrite_table(page: Path, costs: list[Cost]) -> None:
    """Put the table between its marks in cost.md."""
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(TABLE_BEGINS)
    _, after = rest.split(TABLE_ENDS)
    inside = f"{TABLE_BEGINS}\n{machine(costs)}\n\n{table(costs)}\n{TABLE_ENDS}"
    page.write_text(f"{before}{inside}{after}", encoding="utf-8")


def draw_line(
    panel: Axes, form: str, costs: list[Cost], quantity: Quantity, *, above: bool
) -> None:
    """One form's costs, with the fitted exponent at the end, a little above or below."""
    nodes, values = [cost.nodes for cost in costs], [quantity.of(cost) for cost in costs]
    panel.loglog(nodes, values, marker=MARKERS[form], color=COLOURS[form], label=form)
    panel.annotate(
        f"$N^{{{exponent(costs, quantity, all_nodes):.2f}}}$",
        (nodes[-1], values[-1]),
        (8, 6 if above else -8),
        textcoords="offset points",
        va="center",
        color=COLOURS[form],
    )


def draw(picture: Path, costs: list[Cost]) -> None:
    """Four panels over the number of nodes, all logarithmic."""
    mpl.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(2, 2, figsize=(9, 6.4), sharex=True, layout="constrained")
    for panel, quantity in zip(axes.flat, QUANTITIES, strict=True):
        lines = {form: [cost for cost in costs if cost.form == form] for form in FORMS}
        lines = {form: of_form for form, of_form in lines.items() if len(of_form) > 1}
        highest = max(lines, key=lambda form: quantity.of(lines[form][-1]))
        for form, of_form in lines.items():
            draw_line(panel, form, of_form, quantity, above=form == highest)
        panel.set_title(f"{quantity.title}, {quantity.unit}", loc="left", fontsize=12)
        panel.grid(visible=True, which="major", color="#dddddd", linewidth=0.8)
        panel.set_axisbelow(True)
        panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 1000:g}k"))
        panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.yaxis.set_minor_formatter(NullFormatter())
        panel.set_xticks(SIZES)
        # Room for the exponents behind the last points.
        panel.set_xlim(0.8 * SIZES[0], 2.0 * SIZES[-1])
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=2, frameon=False)
    for panel in axes[1]:
        panel.set_xlabel("nodes N")
    picture.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(picture, dpi=130)


def main() -> None:
    """Measure what is not known yet, then write table and plot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, metavar="NODES")
    parser.add_argument("--again", action="store_true", help="measure what is kept anew")
    parser.add_argument("--docs", action="store_true", help="rewrite the docs' table and plot too")
    arguments = parser.parse_args()
    found = [
        cost_of(size, form, again=arguments.again) for size in arguments.sizes for form in FORMS
    ]
    costs = [cost for cost in found if cost is not None]
    print(machine(costs), table(costs), sep="\n\n")
    draw(PROJECT / "build" / "reports" / "cost.png", costs)
    if arguments.docs:
        rewrite_table(PROJECT / "docs" / "cost.md", costs)
        draw(PROJECT / "docs" / "images" / "cost.png", costs)


if __name__ == "__main__":
    main()
