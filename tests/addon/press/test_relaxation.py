"""Bodies that give way with time, pressed in Blender."""

from __future__ import annotations

import bpy
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


def test_a_preset_brings_its_law_which_stays_and_needs_no_bake(palpate, sessions, states, thing):
    drawn = part("operators.object.drawn_body")
    chosen, scene = thing.palpate, bpy.context.scene

    def law():
        return drawn.open_body(thing, scene).body.law

    chosen.shape = "ROTATION_STRAIN"
    chosen.material = "CUSTOM"
    assert law() == "rubber"
    found, ratio = {}, chosen.poisson_ratio
    for material, expected in (("PU_FOAM_SOFT", "foam"), ("STUFFING", "fibres")):
        chosen.material = material
        # The same body of another law: only its ratio would need a bake.
        chosen.poisson_ratio, chosen.young_modulus = ratio, 1000.0
        assert (chosen.material, law()) == ("CUSTOM", expected)
        pressed = part("operators.press.press_once").press_once(
            thing, scene, (0.0, 0.0, 0.05), (0.0, 0.0, -0.015), keep=False
        )
        found[expected] = np.linalg.norm(pressed.force)
    assert found["foam"] < 0.8 * found["fibres"]
    assert drawn.open_body(thing, scene).body is drawn.open_body(thing, scene).body
    chosen.law = "porridge"
    with pytest.raises(part("core.errors").PalpateError, match="porridge"):
        law()


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
