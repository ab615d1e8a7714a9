"""Figures of the demo: force against depth, and pictures side by side."""

from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

TEAL, CORAL, INK = "#1f7a80", "#e4572e", "#263238"
CLOSE = (0.03, 0.87, 0.06, 0.9)  # the mouse, without much of the table
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.5,
    "axes.edgecolor": "#90a4ae",
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#eceff1",
}


def force_curve(path: Path, samples: NDArray[np.void], press: dict[str, Any]) -> Path:
    """Force against depth, and both against time."""
    with mpl.rc_context(STYLE):
        figure, (curve, course) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
        _draw_curve(curve, samples, press)
        _draw_course(course, samples)
        return _save(figure, path, 130)


def readme_picture(
    path: Path,
    before: Path,
    after: Path,
    contact: dict[str, Any],
    samples: NDArray[np.void],
    press: dict[str, Any],
) -> Path:
    """Picture for the README: at rest, pressed, and the force."""
    with mpl.rc_context(STYLE):
        figure = plt.figure(figsize=(13.5, 3.75), layout="constrained")
        left, middle, right = figure.subplots(1, 3, width_ratios=[1.5, 1.5, 1.15])
        _show(left, before, "At rest", CLOSE)
        pressed = f"Pressed {press['depth_mm']:.1f} mm: {1e3 * press['force_n']:.0f} mN"
        _show(middle, after, pressed, CLOSE)
        _arrow(middle, contact)
        _draw_curve(right, samples, press)
        return _save(figure, path, 110)


def cube_picture(path: Path, pictures: list[Path], presses: list[dict[str, Any]]) -> Path:
    """Picture of the cube at rest and under each press."""
    with mpl.rc_context(STYLE):
        figure = plt.figure(figsize=(12.5, 3.1), layout="constrained")
        axes = figure.subplots(1, len(pictures))
        _show(axes[0], pictures[0], "At rest")
        for ax, picture, press in zip(axes[1:], pictures[1:], presses, strict=True):
            moved = press["max_displacement_mm"]
            _show(ax, picture, f"{press['name'].title()} pressed {moved:.1f} mm")
        return _save(figure, path, 110)


def _depth_and_force(
    samples: NDArray[np.void],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Depth in mm and felt force in N of every tick."""
    depth = 1e3 * np.linalg.norm(samples["probe"] - samples["proxy"], axis=1)
    return depth, np.linalg.norm(samples["output"], axis=1)


def _draw_curve(ax: Axes, samples: NDArray[np.void], press: dict[str, Any]) -> None:
    depth, force = _depth_and_force(samples)
    touching = depth > 0
    ax.plot(depth[touching], force[touching], ".", color=TEAL, markersize=1.6, alpha=0.5)
    ax.plot(press["depth_mm"], press["force_n"], "o", color=CORAL, markersize=7)
    ax.set_xlabel("depth, mm")
    ax.set_ylabel("felt force, N")
    ax.set_title(f"{np.count_nonzero(touching):,} ticks in touch, 1 kHz", fontsize=10)
    ax.set_xlim(0, None)
    ax.set_ylim(0, None)


def _draw_course(ax: Axes, samples: NDArray[np.void]) -> None:
    depth, force = _depth_and_force(samples)
    time = samples["time"] - samples["time"][0]
    ax.plot(time, force, color=TEAL, linewidth=1.2)
    ax.set_xlabel("time, s")
    ax.set_ylabel("felt force, N", color=TEAL)
    ax.set_ylim(0, None)
    twin = ax.twinx()
    twin.plot(time, depth, color=CORAL, linewidth=1.2, linestyle="--")
    twin.set_ylabel("depth, mm", color=CORAL)
    twin.set_ylim(0, None)
    twin.grid(visible=False)


def _show(ax: Axes, picture: Path, title: str, crop: tuple[float, ...] = (0, 1, 0, 1)) -> None:
    """Show a picture, or the part between shares `crop` of its width and height."""
    pixels = plt.imread(picture)
    height, width = pixels.shape[:2]
    ax.imshow(pixels, interpolation="lanczos")
    ax.set_xlim(crop[0] * width, crop[1] * width)
    ax.set_ylim(crop[3] * height, crop[2] * height)
    ax.set_title(title, fontsize=10)
    ax.axis("off")


def _arrow(ax: Axes, contact: dict[str, Any]) -> None:
    """Draw the force on a picture, next to the dent."""
    height, width = ax.get_images()[0].get_array().shape[:2]
    probe, proxy = (
        np.array(contact["pixels"][name]) * (width, height) for name in ("probe", "proxy")
    )
    out = (proxy - probe) / np.linalg.norm(proxy - probe)
    ax.annotate(
        "",
        xy=tuple(proxy + 0.27 * height * out),
        xytext=tuple(proxy + 0.07 * height * out),
        arrowprops={"arrowstyle": "-|>", "color": CORAL, "linewidth": 3, "mutation_scale": 20},
    )


def _save(figure: Figure, path: Path, dpi: int) -> Path:
    figure.savefig(path, dpi=dpi, facecolor="white")
    plt.close(figure)
    return path
