"""Progress of fTetWild, read from its log."""

from __future__ import annotations

import re

from ..sentence import Sentence

# Words of its log in order of appearance, and the stages they stand for.
STAGES = {
    "Starting tetrahedralization": "reading the mesh",
    "collapsing": "simplifying the surface",
    "triangle insertion start": "inserting the surface",
    "initializing...": "improving tetrahedra",
    "postprocessing": "finishing",
}


def stage(log: str) -> Sentence:
    """The latest stage named in ``log``, with the pass and worst energy while it improves.

    fTetWild stops once the worst energy has fallen to 10, which is the only progress it shows.
    """
    reached = "reading the mesh"
    for words, meaning in STAGES.items():
        if words in log:
            reached = meaning
    passes = re.findall(r"/ pass (\d+) /", log)
    energies = re.findall(r"max_energy = ([0-9.e+]+)", log)
    if reached == "improving tetrahedra" and passes and energies:
        return Sentence(
            "{stage}, pass {number}, worst energy {energy:.0f} (goal 10)",
            stage=Sentence(reached),
            number=int(passes[-1]) + 1,
            energy=float(energies[-1]),
        )
    return Sentence(reached)
