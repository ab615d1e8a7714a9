"""Bodies that give way with time, pressed in Blender."""

from __future__ import annotations

import numpy as np
import pytest
from soft_scene import begin_pressed, cube, part, wait


def test_a_preset_brings_its_relaxation_and_another_one_is_custom(palpate):
    thing = cube()
    assert thing.palpate.relaxation == "NONE"
    thing.palpate.material = "MEMORY_FOAM"
    assert thing.palpate.relaxation == "MEMORY_FOAM"
    thing.palpate.relaxation = "GEL"
    assert thing.palpate.material == "CUSTOM"
    thing.palpate.material = "PLUSH"
    assert thing.palpate.relaxation == "NONE"


def test_a_pressed_body_falls_to_the_force_of_the_elastic_one(sessions, states, thing):
    """One point needs no whole body unless it gives way with time."""
    read = part("addon.overlay.reading").reading
    session = begin_pressed(sessions, states, thing)
    elastic = read(session).force
    drawn = session.seen.displacements
    session.post(states.Moment.CANCEL)
    thing.palpate.relaxation = "FLESH"
    session = begin_pressed(sessions, states, thing)
    assert len(session.snapshot.remembered_nodes) >= 3
    assert read(session).force > elastic
    wait(session, lambda: read(session).force == pytest.approx(elastic, rel=0.05))
    largest = np.abs(drawn).max()
    np.testing.assert_allclose(session.seen.displacements, drawn, atol=0.02 * largest)
