"""A press beside the truth, as a line of a table, and what is claimed of it."""

from __future__ import annotations

from dataclasses import dataclass

# The real force: to half a radius and a fifth of the thickness, beyond, and of points that crush.
NEAR, FAR, CRUSHED = 0.05, 0.10, 0.20
# The drawn surface; and where few places press.
DRAWN, DRAWN_COARSELY, MANY_PLACES = 0.03, 0.30, 16.0


@dataclass(frozen=True, eq=False)
class Row:
    """A press.

    Attributes
    ----------
    name : of the press.
    depth, share : over the radius of a ball, of the part's thickness.
    is_near : by half a radius, or a fifth of the part, at most.
    places : of the surface's triangles, three each, that press; one of a point.
    is_stable : whether the truth is a rest, and no equilibrium that the body leaves.
    true : the force at 1 Pa, mm2, along the press.
    linear, real : forces over it; not a number where the body does not come to rest.
    is_whole : whether the body's own rest was found as deep as that.
    drawn : largest errors, linear and real, over the largest displacement.
    """

    name: str
    depth: float
    share: float
    is_near: bool
    places: float
    is_stable: bool
    true: float
    linear: float
    real: float
    is_whole: bool
    drawn: tuple[float, float]


def head() -> str:
    """Over the lines of a table."""
    names = "".join(f"{name:>9}" for name in ("linear", "real", "drawn", "real"))
    return f"{'':<26}{'depth':>7}{'share':>7}{'truth':>10}{names}{'places':>8}"


def written(row: Row) -> str:
    """A line of the table."""
    drawn = "".join(f"{100 * error:9.1f}" for error in row.drawn)
    return (
        f"{row.name:<26}{row.depth:7.3f}{row.share:7.3f}{row.true:10.2f}"
        f"{100 * (row.linear - 1):+9.1f}{100 * (row.real - 1):+9.1f}{drawn}{row.places:8.0f}"
        f"{'' if row.is_whole else '   no rest so deep'}"
        f"{'' if row.is_stable else '   the truth is not stable'}"
    )


def holds(row: Row) -> bool:
    """Whether the force and the drawn surface are as near as promised; says where they are not."""
    press = f"{row.name}, {max(row.depth, row.share):.3g}"
    is_point = "point" in row.name
    is_crushed = is_point and not row.is_near
    is_told = is_point or row.places >= MANY_PLACES
    most = CRUSHED if is_crushed else NEAR if row.is_near and is_told else FAR
    most_drawn = DRAWN if is_told else DRAWN_COARSELY
    is_felt = abs(row.real - 1.0) <= most
    is_drawn = is_crushed or not row.is_stable or row.drawn[1] <= most_drawn
    if not is_felt:
        print(f"CLAIM BROKEN: {press}: the real force is not within {most:.0%}")
    if not is_drawn:
        print(f"CLAIM BROKEN: {press}: the drawn surface is not within {most_drawn:.0%}")
    return is_felt and is_drawn
