"""Dropped, pressed, pinched, lifted anyhow: no body explodes, falls through or gains energy."""

import pytest
from referees.rest_trials import trial

# Hands pinch a bar by its edges on the floor: 41 times weight and size came out of it in a tick.
PINCHED_BY_EDGES = 174
# Hands that stop turned a bar in the tick before by milliradians, but not how far it gave way with
# it: 2.5e-4 and 1.3e-4 of weight times size came out of it.
TURNED_IN_HANDS = (102, 742)
# A plate goes up past the edge by which it pushes: its normal turned to and fro with the point that
# it pushed, and how far aside it may push was found by the pushes which that turned.
PAST_AN_EDGE = (375, 459, 471, 491)
# So many points stick that friction was not found.
MANY_STICK = 835
# A cube comes to stand on its tip, which gives way beneath its elements.
ON_ITS_TIP = 312
# A slab falls over from its edge, for longer than a second.
FALLING_OVER = 151
OFTEN_THROWN = [
    *range(6),
    PINCHED_BY_EDGES,
    *TURNED_IN_HANDS,
    *PAST_AN_EDGE,
    MANY_STICK,
    ON_ITS_TIP,
    FALLING_OVER,
]
RARELY_THROWN = range(6, 33)


@pytest.mark.parametrize(
    "seed",
    [*OFTEN_THROWN, *(pytest.param(seed, marks=pytest.mark.at_length) for seed in RARELY_THROWN)],
)
def test_a_body_in_any_hands_stays_sound(seed):
    outcome = trial(seed)
    assert outcome.holds, outcome


# Of each kind with hands one of each of two shapes.
@pytest.mark.parametrize("seed", [1, 2, 3, 9, 10, 11])
def test_so_it_does_where_one_more_hand_steadies_it(seed):
    outcome = trial(seed, steady=True)
    assert outcome.holds, outcome
