"""Dropped, pressed, pinched, lifted anyhow: no body explodes, falls through or gains energy."""

import pytest
from referees.rest_trials import trial


@pytest.mark.parametrize("seed", range(33))
def test_a_body_in_any_hands_stays_sound(seed):
    outcome = trial(seed)
    assert outcome.holds, outcome
