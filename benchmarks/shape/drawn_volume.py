"""Whether drawn rubber keeps its volume, at a Poisson's ratio of 0.49.

    python benchmarks/shape/drawn_volume.py [--bodies cube bar ...]

Presses by a ball of 2.4 edges at two places of each body, to a half and the whole of its radius,
and the bends, pulls and turns of :mod:`.strokes_at_depth`. Printed is by how much the volume that
the drawn surface encloses changes, linear and *Real*.

Claimed, by exit code: *Real* keeps the volume within 1 %.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.deep_press import (
    BALL_EDGES,
    BODIES,
    Bench,
    places_on,
)
from palpate.benchmarks.shape.strokes_at_depth import shaped, strokes
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.law.of_material import RUBBER
from palpate.core.mesh.surface import Surface
from palpate.core.shape.felt import loads_of
from palpate.core.shape.meeting import settled

Array = NDArray[np.float64]

POISSON_RATIO = 0.49
DEPTHS = (0.5, 1.0)
MOST = 0.01


def change_of_volume(body: SoftBody, moved: Array) -> float:
    """Of what the surface encloses, as a share; ``moved`` (n, 3) of the free surface nodes."""
    places = body.mesh.nodes.copy()
    places[body.compliance.free_surface] += moved
    now, before = (
        Surface(nodes, body.mesh.surface_triangles).signed_volume
        for nodes in (places, body.mesh.nodes)
    )
    return now / before - 1.0


def drawn(bench: Bench) -> Iterator[tuple[str, Array, Array]]:
    """Presses and strokes: name, linear and *Real* displacements."""
    body, radius = bench.body, BALL_EDGES * bench.solid.edge
    for number, place in enumerate(places_on(body, 2, np.random.default_rng(1999)), start=1):
        for share in DEPTHS:
            pose = Pose.at(place.position - (1.0 - share) * radius * place.axis)
            touch = press_tool(body, sphere(radius), pose)
            met = settled(body, bench.shape, loads_of([touch]), 1.0)
            yield f"ball {number}, {share:g}", met.linear, met.displacements
    for name, held, shares in strokes(bench):
        answer = held.answer(shares, 1.0)
        yield name, answer.displacements, shaped(bench, answer).displacements


def main() -> int:
    """Print the table; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=list(BODIES))
    print(f"{'volume, %':<32}{'linear':>9}{'real':>9}")
    kept = []
    for name in parser.parse_args().bodies:
        bench = Bench.of(name, RUBBER, POISSON_RATIO)
        for told, linear, real in drawn(bench):
            changes = [change_of_volume(bench.body, moved) for moved in (linear, real)]
            press = f"{bench.name}, {told}"
            kept.append(abs(changes[1]) <= MOST)
            line = "".join(f"{100 * change:+9.2f}" for change in changes)
            print(f"{press:<32}{line}{'' if kept[-1] else '   CLAIM BROKEN'}", flush=True)
        bench.shape.close()
    print("the claim holds" if all(kept) else "the claim does NOT hold")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
