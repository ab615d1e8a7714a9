"""Dropped, pressed, pinched, lifted anyhow: no body explodes, falls through or gains energy."""

import pytest
from referees.rest_trials import trial

RARELY_THROWN = range(6, 33)


@pytest.mark.parametrize(
    "seed",
    [*range(6), *(pytest.param(seed, marks=pytest.mark.at_length) for seed in RARELY_THROWN)],
)
def test_a_body_in_any_hands_stays_sound(seed):
    outcome = trial(seed)
    assert outcome.holds, outcome
