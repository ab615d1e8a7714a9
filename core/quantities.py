"""Quantities as readable text: few digits, fitting units."""

from __future__ import annotations

MINUTE, HOUR = 60.0, 3600.0
TENTHS_BELOW = 10.0


def duration(seconds: float) -> str:
    """Time: ``8 s``, ``2 min 10 s``, ``1 h 5 min``."""
    if seconds < MINUTE:
        return f"{max(0, round(seconds))} s"
    if seconds < HOUR:
        minutes, rest = divmod(round(seconds), 60)
        return f"{minutes} min {rest} s" if minutes < 10 and rest else f"{minutes} min"
    hours, minutes = divmod(round(seconds / MINUTE), 60)
    return f"{hours} h {minutes} min"


def waiting(seconds: float) -> str:
    """Waiting time: ``0.3 s``, then as :func:`duration`."""
    return f"{seconds:.1f} s" if seconds < TENTHS_BELOW else duration(seconds)


def memory(count: float) -> str:
    """Bytes: ``36 MB``, ``1.2 GB``."""
    for unit, size in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if count >= size:
            return f"{count / size:.{1 if count < 10 * size else 0}f} {unit}"
    return f"{count / 1e3:.0f} kB"


def microseconds(time: float) -> str:
    """Short time in µs: ``0.4 µs``, ``12 µs``, ``1.2 ms``."""
    if time >= 1000.0:
        return f"{time / 1000:.1f} ms"
    return f"{time:.{1 if time < 10.0 else 0}f} µs"


def about(count: float) -> str:
    """Predicted number, two digits: ``1,700``."""
    return f"{float(f'{count:.2g}'):,.0f}"


def percent(share: float) -> str:
    """Share in percent, two digits: ``0.1 %``."""
    return f"{100 * share:.2g} %"


def area(square_metres: float) -> str:
    """Contact area: ``12.3 mm²``, ``4.6 cm²``, ``0.124 m²``."""
    for unit, size, most in (("mm²", 1e-6, 100.0), ("cm²", 1e-4, 999.5)):
        if square_metres < most * size:
            return f"{square_metres / size:.3g} {unit}"
    return f"{square_metres:.3g} m²"


def pressure(pascal: float) -> str:
    """Pressure in kPa or MPa, three digits."""
    kilo = pascal / 1000
    return f"{kilo:.3g} kPa" if kilo < 999.5 else f"{kilo / 1000:.3g} MPa"


def length(metres: float) -> str:
    """Length, three digits: ``2.5 µm``, ``33 mm``, ``1.2 m``, ``2 km``."""
    for unit, size in (("km", 1e3), ("m", 1.0), ("mm", 1e-3)):
        if metres >= 0.9995 * size:
            return f"{metres / size:.3g} {unit}"
    return f"{1e6 * metres:.3g} µm"


def volume(cubic_metres: float) -> str:
    """Volume, three digits: ``0.5 mm³``, ``65.4 cm³``, ``2 m³``."""
    for unit, size in (("km³", 1e9), ("m³", 1.0), ("cm³", 1e-6)):
        if cubic_metres >= 0.1 * size:
            return f"{cubic_metres / size:.3g} {unit}"
    return f"{1e9 * cubic_metres:.3g} mm³"
