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
    """The latest stage named in ``log``, with the pass while it improves."""
    reached = "reading the mesh"
    for words, meaning in STAGES.items():
        if words in log:
            reached = meaning
    passes = re.findall(r"/ pass (\d+) /", log)
    if reached == "improving tetrahedra" and passes:
        return Sentence(
            "{stage}, pass {number}", stage=Sentence(reached), number=int(passes[-1]) + 1
        )
    return Sentence(reached)
