"""Words of a stroke: amounts in the scene's units, forces with a prefix where they are large."""

from __future__ import annotations

import pytest
from soft_scene import part


@pytest.mark.parametrize(
    ("force", "words"),
    [
        (0.0, "0 N"),
        (0.00355, "0.00355 N"),
        (151.4, "151 N"),
        (999.6, "1 kN"),
        (1514.0, "1.51 kN"),
        (-2000.0, "-2 kN"),
        (2.5e6, "2.5 MN"),
        (7.0e9, "7e+03 MN"),
    ],
)
def test_a_force_has_three_digits(palpate, force, words):
    assert part("operators.reporting.quantities").newtons(force) == words
