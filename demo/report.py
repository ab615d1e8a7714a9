"""Measurements of the demo, as report.json and as readable lines."""

import math
from typing import Any

SERVO = ("rate_hz", "ticks", "late_ticks", "realtime")
LINK = ("states", "forces", "lost", "crc_errors")


def report(raw: dict[str, Any], pictures: list[str]) -> dict[str, Any]:
    """Report from the Blender part's files."""
    servo = raw["servo"]
    return {
        "blender": raw["blender"],
        "cube": raw["cube"],
        "cube_presses": {one["name"]: one["force_n"] for one in raw["cube_presses"]},
        "mouse": raw["mouse"],
        "servo": {
            **{name: servo[name] for name in SERVO},
            "lateness_us": {name: servo["lateness_us"][name] for name in ("p50", "p99", "max")},
            "link": {name: servo["link"][name] for name in LINK},
        },
        "press": raw["press"],
        "pictures": pictures,
    }


def summary(made: dict[str, Any]) -> str:
    """Summary of the report in a dozen lines."""
    lines = {
        "Blender": made["blender"],
        "cube": _body(made["cube"]),
        "forces": _forces(made["cube_presses"]),
        "mouse": _body(made["mouse"]),
        "servo": _servo(made["servo"]),
        "link": _link(made["servo"]["link"]),
        "press": _press(made["press"]),
        "frames": _frames(made["press"]),
    }
    told = [f"{name:8} {text}" for name, text in lines.items()]
    return "\n".join([*told, *(f"picture  {path}" for path in made["pictures"])])


def _forces(presses: dict[str, list[float]]) -> str:
    """To all digits: stored tetrahedra feel the same on every system."""
    told = (f"{name} {math.hypot(*force):.12g} N" for name, force in presses.items())
    return f"5 mm into the cube: {', '.join(told)}"


def _servo(servo: dict[str, Any]) -> str:
    late = servo["lateness_us"]
    return (
        f"{servo['ticks']} ticks at {servo['rate_hz']} Hz, {servo['late_ticks']} of them more than "
        f"200 us late; lateness {late['p50']:.0f} us median, {late['p99']:.0f} us 99 %, "
        f"{late['max']:.0f} us worst; real-time priority: {servo['realtime']}"
    )


def _link(link: dict[str, Any]) -> str:
    return (
        f"{link['states']} states in, {link['forces']} forces out, {link['lost']} lost, "
        f"{link['crc_errors']} checksum errors"
    )


def _press(press: dict[str, Any]) -> str:
    return (
        f"{press['object']}: {press['depth_mm']:.1f} mm deep, {press['force_n']:.3f} N, "
        f"the mesh moves {press['max_displacement_mm']:.1f} mm"
    )


def _frames(press: dict[str, Any]) -> str:
    time = press["frame_ms"]
    return (
        f"{press['frames']} drawn beside it; {time['p50']:.1f} ms median, {time['p99']:.1f} ms 99 %"
    )


def _body(figures: dict[str, Any]) -> str:
    return (
        f"{figures['nodes']} nodes, {figures['tets']} tetrahedra, "
        f"{figures['free_surface_nodes']} free surface nodes of {figures['surface_nodes']}, "
        f"{figures['formulation']}, "
        f"L {figures['form']} in {figures['compliance_bytes'] / 1e6:.1f} MB, "
        f"baked in {sum(figures['seconds'].values()):.2g} s"
    )
