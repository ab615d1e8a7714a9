"""The demo's report: the shape that was promised, whatever else Blender wrote down."""

import json
from typing import Any

import numpy as np
import pytest
from report import report, summary

BODY = {
    "nodes": 125,
    "tets": 320,
    "surface_nodes": 98,
    "free_surface_nodes": 73,
    "surface_triangles": 192,
    "formulation": "linear",
    "form": "dense",
    "compliance_bytes": 191844,
    "seconds": {"stiffness": 0.1, "compliance": 0.2},
    "key": "0",
}


@pytest.fixture
def raw() -> dict[str, Any]:
    return {
        "blender": "5.0.1",
        "cube": BODY,
        "mouse": BODY,
        "cube_presses": [{"name": "top", "at": (0.5, 0.5), "force_n": [0.3, 0.0, 0.4]}],
        "servo": {
            "rate_hz": 1000,
            "ticks": 8000,
            "late_ticks": 3,
            "longest_gap_us": 1300.0,
            "lateness_us": {"p50": 12.0, "p99": 80.0, "p99_9": 100.0, "max": 300.0},
            "realtime": "fifo 20",
            "link": {
                "states": 7990,
                "forces": 7980,
                "lost": 4,
                "crc_errors": 1,
                "device": {"name": "Simulated"},
            },
        },
        "press": {
            "object": "Mouse",
            "depth_mm": 8.0,
            "force_n": 0.06,
            "max_displacement_mm": 7.5,
            "frames": 390,
            "frame_ms": {"p50": 0.7, "p99": 2.0},
        },
        "contact": {},
    }


def test_the_report_has_exactly_the_promised_shape(raw: dict[str, Any]) -> None:
    made = report(raw, ["a.png"])
    assert set(made) == {
        *("blender", "cube", "cube_presses", "mouse", "servo", "press", "pictures")
    }
    assert set(made["servo"]) == {
        "rate_hz", "ticks", "late_ticks", "lateness_us", "realtime", "link",
    }  # fmt: skip
    assert set(made["servo"]["lateness_us"]) == {"p50", "p99", "max"}
    assert set(made["servo"]["link"]) == {"states", "forces", "lost", "crc_errors"}
    assert made["press"] == raw["press"]
    assert made["cube"] == BODY
    assert made["cube_presses"] == {"top": [0.3, 0.0, 0.4]}
    assert json.loads(json.dumps(made)) == made


def test_the_summary_says_what_was_measured(raw: dict[str, Any]) -> None:
    text = summary(report(raw, ["a.png"]))
    for part in (
        "125 nodes",
        "linear, L dense",
        "top 0.5 N",
        "8000 ticks",
        "fifo 20",
        "8.0 mm",
        "0.060 N",
        "390",
        "a.png",
    ):
        assert part in text


def test_the_figures_show_a_press(raw: dict[str, Any], tmp_path: Any) -> None:
    charts = pytest.importorskip("charts")
    depth = np.linspace(0.0, 8e-3, 50)
    samples = np.zeros(
        50, dtype=[("time", "f8"), ("probe", "f8", 3), ("proxy", "f8", 3), ("output", "f8", 3)]
    )
    samples["time"] = np.linspace(0.0, 0.05, 50)
    samples["probe"][:, 2] = -depth
    samples["output"][:, 2] = 7.5 * depth
    made = charts.force_curve(tmp_path / "curve.png", samples, raw["press"])
    assert made.stat().st_size > 10_000
