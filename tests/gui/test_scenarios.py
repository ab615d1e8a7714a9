"""Every scenario in scenarios/ holds in a real Blender with a window."""

from __future__ import annotations

import pytest


# The first one asked for starts Blender and plays them all; each has its own time limit there.
@pytest.mark.timeout(0)
def test_scenario(windowed_blender, scenario):
    outcome = windowed_blender.outcomes[scenario]
    print("\n".join(outcome.pictures))
    if outcome.failure:
        pytest.fail(outcome.failure, pytrace=False)
