"""Imprints against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from palpate.core.errors import PalpateError
from palpate.core.imprint.imprint import Imprint
from palpate.core.imprint.yielding import Yielding, beneath

DOWN = np.array([[0.0, 0.0, -1.0]])
MILLIMETRE = Yielding(1e-3)
ways = arrays(np.float64, (4, 3), elements=st.floats(-1e-2, 1e-2, allow_subnormal=False))


def pressed(law, *depths, seconds=0.0):
    imprint = Imprint.none(1)
    for depth in depths:
        imprint = imprint.pressed(law, depth * DOWN, seconds)
    return imprint


@pytest.mark.parametrize("depth", [0.0, 5e-4, 1e-3, 1.5e-3, 4e-3])
def test_what_is_beyond_the_yield_depth_stays(depth):
    stayed = pressed(MILLIMETRE, depth, 0.0)
    np.testing.assert_allclose(stayed.left, max(depth - 1e-3, 0.0) * DOWN, rtol=0, atol=1e-18)
    np.testing.assert_allclose(stayed.seen(0.0 * DOWN), stayed.left, rtol=0, atol=1e-18)


def test_while_it_is_held_the_surface_is_where_it_is_pressed():
    held = pressed(MILLIMETRE, 1e-3, 2e-3, 4e-3)
    np.testing.assert_allclose(held.seen(4e-3 * DOWN), 4e-3 * DOWN, rtol=0, atol=1e-18)
    # Half the way back the tool has left the imprint behind.
    np.testing.assert_allclose(held.seen(1e-3 * DOWN), 3e-3 * DOWN, rtol=0, atol=1e-18)


def test_more_places_begin_without_an_imprint():
    more = pressed(MILLIMETRE, 3e-3).with_more(1)
    np.testing.assert_allclose(more.left, [[0, 0, -2e-3], [0, 0, 0]], rtol=0, atol=1e-18)


def test_an_elastic_surface_remembers_nothing():
    assert not pressed(Yielding(), 4e-3).left.any()
    np.testing.assert_array_equal(pressed(Yielding(), 4e-3).seen(1e-3 * DOWN), 1e-3 * DOWN)


def test_the_same_press_again_leaves_nothing_more_and_a_deeper_one_its_own():
    once = pressed(MILLIMETRE, 3e-3, 0.0)
    np.testing.assert_array_equal(pressed(MILLIMETRE, 3e-3, 0.0, 3e-3, 0.0).left, once.left)
    deeper = pressed(MILLIMETRE, 3e-3, 0.0, 5e-3, 0.0)
    np.testing.assert_allclose(deeper.left, pressed(MILLIMETRE, 5e-3).left, rtol=0, atol=1e-18)


def test_a_press_on_the_imprint_begins_there():
    first = pressed(MILLIMETRE, 3e-3, 0.0).settled()
    held = first.pressed(MILLIMETRE, 3e-3 * DOWN)
    np.testing.assert_allclose(held.seen(3e-3 * DOWN), 5e-3 * DOWN, rtol=0, atol=1e-18)
    np.testing.assert_allclose(held.left, 2 * 2e-3 * DOWN, rtol=0, atol=1e-18)
    # It meets the first one at the yield depth: nothing flows.
    light = first.pressed(MILLIMETRE, 1e-3 * DOWN)
    np.testing.assert_array_equal(light.left, first.left)


def test_memory_foam_forgets_half_in_the_logarithm_of_two():
    foam = Yielding(1e-3, forget=3.0)
    stayed = pressed(foam, 5e-3, 0.0).settled()
    half = stayed.pressed(foam, 0.0 * DOWN, 3.0 * math.log(2.0))
    np.testing.assert_allclose(half.left, 0.5 * stayed.left, rtol=1e-12)
    # In any number of steps.
    step = stayed
    for _ in range(7):
        step = step.pressed(foam, 0.0 * DOWN, 3.0 * math.log(2.0) / 7)
    np.testing.assert_allclose(step.left, half.left, rtol=1e-12)
    # Held down it forgets nothing.
    held = pressed(foam, *[5e-3] * 20, seconds=1.0)
    np.testing.assert_allclose(held.left, 4e-3 * DOWN, rtol=1e-12)


def test_a_bulge_from_a_press_beside_is_added_to_an_imprint():
    stayed = pressed(MILLIMETRE, 3e-3, 0.0)
    beside = stayed.pressed(MILLIMETRE, -5e-4 * DOWN)
    np.testing.assert_array_equal(beside.left, stayed.left)
    np.testing.assert_allclose(beside.seen(-5e-4 * DOWN), 1.5e-3 * DOWN, rtol=0, atol=1e-18)


def test_a_pull_stays_like_a_push():
    np.testing.assert_allclose(pressed(MILLIMETRE, -3e-3, 0.0).left, -2e-3 * DOWN, atol=1e-18)


@given(before=ways, moved=ways, depth=st.floats(1e-5, 1e-2))
def test_what_flows_goes_with_the_press_and_leaves_no_more_than_the_yield_depth(
    before, moved, depth
):
    law = Yielding(depth)
    after = law.grown(before, moved)
    sizes = np.linalg.norm(moved, axis=1)
    along = np.divide(moved, sizes[:, None], out=np.zeros_like(moved), where=sizes[:, None] > 0)
    flow = ((after - before) * along).sum(axis=1)
    # Work is lost, never won.
    assert (flow >= -1e-15).all()
    np.testing.assert_allclose(after - before, flow[:, None] * along, rtol=0, atol=1e-15)
    elastic = sizes - (after * along).sum(axis=1)
    assert (elastic[sizes > depth] <= depth + 1e-12).all()
    np.testing.assert_array_equal(after[sizes <= depth], before[sizes <= depth])
    np.testing.assert_allclose(law.grown(after, moved), after, rtol=0, atol=1e-15)


@given(plastic=ways, moved=ways)
def test_the_surface_is_never_above_its_imprint_nor_above_the_tool(plastic, moved):
    seen = beneath(plastic, moved)
    sizes = np.linalg.norm(plastic, axis=1)
    deep = (seen * plastic).sum(axis=1) / np.where(sizes > 0, sizes, 1.0)
    pressed_in = (moved * plastic).sum(axis=1) / np.where(sizes > 0, sizes, 1.0)
    assert (deep >= np.minimum(sizes, sizes + pressed_in) - 1e-15).all()
    assert (deep >= pressed_in - 1e-15).all()


@pytest.mark.parametrize("wrong", [{"depth": -1.0}, {"depth": math.inf}, {"forget": math.nan}])
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(PalpateError, match="give zero or more"):
        Yielding(**wrong)
