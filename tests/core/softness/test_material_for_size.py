"""Materials that suit a size: about as stiff under a fingertip whatever the size is."""

from __future__ import annotations

import pytest

from palpate.core.softness.scales.for_size import RADIUS, STIFFNESS, material_for
from palpate.core.softness.scales.materials import MATERIALS


@pytest.mark.parametrize("diagonal", [0.02, 0.05, 0.1, 0.3, 1.0, 3.5])
def test_a_fingertip_meets_about_the_wanted_stiffness(diagonal):
    young = MATERIALS[material_for(diagonal)].young_modulus
    assert 1 / 5 < 2 * young * RADIUS * diagonal / STIFFNESS < 5


def test_small_things_are_firmer_than_large_ones():
    found = [MATERIALS[material_for(size)].young_modulus for size in (0.01, 0.1, 0.5, 2.0, 30.0)]
    assert found == sorted(found, reverse=True)
    assert len(set(found)) > 2
