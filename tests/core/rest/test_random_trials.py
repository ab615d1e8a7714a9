"""Dropped, pressed, pinched, lifted anyhow: no body explodes, falls through or gains energy."""

import pytest
from referees.rest_trials import trial

# Hands pinch a bar by its edges on the floor: 41 times weight and size came out of it in a tick.
PINCHED_BY_EDGES = 174
OFTEN_THROWN = [*range(6), PINCHED_BY_EDGES]
RARELY_THROWN = range(6, 33)


@pytest.mark.parametrize(
    "seed",
    [*OFTEN_THROWN, *(pytest.param(seed, marks=pytest.mark.at_length) for seed in RARELY_THROWN)],
)
def test_a_body_in_any_hands_stays_sound(seed):
    outcome = trial(seed)
    assert outcome.holds, outcome
