"""Every rule of docs/safety.md with its cause: the servo's ticks and the link's bytes, by hand."""

import re
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import palpate_servo
import pytest
from palpate_servo import STATES, Pointer, Servo

from palpate.core.body.body_file import save
from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.table import Table
from palpate.simulated.attack.target import ABOVE, DEEP, baked_target, cube, cube_target
from palpate.simulated.attack.virtual import episodes
from palpate.simulated.attack.virtual.cause import Outcome
from palpate.simulated.attack.virtual.causes import CAUSES, HAPLY_CAUSES
from palpate.simulated.attack.virtual.haply_press import HaplyPress
from palpate.simulated.attack.virtual.shot import Said
from palpate.simulated.attack.virtual.virtual_press import VirtualPress

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "safety.md"
SILENT = next(cause for cause in CAUSES if cause.outcome is Outcome.SILENT)
HARMLESS = next(cause for cause in CAUSES if cause.outcome is Outcome.HARMLESS)


TARGET = cube_target()


def seeded(seed):
    return Random(seed)  # noqa: S311 - which fault when, not secrets


def link_press(rate_hz=1000):
    return VirtualPress(TARGET, rate_hz=rate_hz)


def press_of_protocol_1(rate_hz):
    return VirtualPress(TARGET, rate_hz=rate_hz, protocol=link.FIRST_PROTOCOL)


def haply_press(_):
    return HaplyPress(TARGET)


def rows(make, causes):
    for cause in causes:
        yield pytest.param(make, cause, id=f"{make.__name__}: {cause.name}")


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        *rows(link_press, CAUSES),
        *rows(press_of_protocol_1, [c for c in CAUSES if link.FIRST_PROTOCOL in c.protocols]),
        *rows(haply_press, HAPLY_CAUSES),
    ],
)
def test_each_cause_gives_what_the_rules_say(make, cause):
    assert episodes.attacked(make, cause, 4, 7).broken == ()


@pytest.mark.parametrize("name", ["a FAULT of the device", "jump in a burst of 2 to 16 STATE"])
def test_a_baked_body_is_attacked_as_the_cube_is(name, cube_body, tmp_path):
    save(cube_body, tmp_path / "cube.npz")
    target = baked_target(tmp_path / "cube.npz")
    cause = next(cause for cause in CAUSES if cause.name == name)
    row = episodes.attacked(lambda rate: VirtualPress(target, rate_hz=rate), cause, 3, 7)
    assert row.broken == ()


def test_the_same_seed_gives_the_same_row_and_another_seed_others():
    drawn = []

    def inject(press, dice):
        drawn.append(dice.random())
        return SILENT.inject(press, dice)

    cause = replace(SILENT, inject=inject)
    first, again, _ = (episodes.attacked(link_press, cause, 2, seed) for seed in (1, 1, 2))
    assert first == again
    assert drawn[:2] == drawn[2:4]
    assert len(set(drawn)) == 4


def test_a_device_that_hears_nothing_more_is_limp_within_20_ms():
    row = episodes.unheard(link_press, 10, 7)
    assert row.broken == ()
    assert 19.0 - 1e-6 <= row.zero_ms <= 20.0 + 1e-6


@pytest.mark.parametrize(
    ("spoil", "problem"),
    [
        (lambda e: replace(e, during=[replace(e.during[0], output=0.1), *e.back]), "after the"),
        (lambda e: replace(e, during=[replace(s, felt=0.1) for s in e.during]), "motors go on"),
        (lambda e: replace(e, during=[replace(s, reason="") for s in e.during]), "never called"),
        (lambda e: replace(e, back=[e.back[0], *e.back[-1:] * 5]), "no ramp"),
        (lambda e: replace(e, during=[replace(s, said=Said()) for s in e.during]), "not said"),
        (lambda e: replace(e, during=[replace(s, said=Said(1)) for s in e.during]), "must be none"),
        (lambda e: replace(e, back=[replace(e.back[0], said=Said(hollow=1))]), "motors off"),
        (lambda e: replace(e, back=[replace(e.back[0], felt=3.01)]), "largest force"),
        (lambda e: replace(e, back=[replace(e.back[0], felt_slew=510.0)]), "slew"),
    ],
)
def test_the_table_finds_a_broken_rule(spoil, problem):
    press, dice = link_press(), seeded("broken")
    episode = episodes.episode(press, SILENT, dice)
    while len(episode.during) < 3:
        episode = episodes.episode(press, SILENT, dice)
    assert episodes.problems(SILENT, episode) == []
    assert any(problem in found for found in episodes.problems(SILENT, spoil(episode)))


def test_the_table_finds_a_fault_without_need_and_a_force_that_changed():
    episode = episodes.episode(link_press(), HARMLESS, seeded("harmless"))
    other = [replace(episode.during[0], output=episode.before.output + 1e-3)]
    found = episodes.problems(HARMLESS, replace(episode, during=other, counted=0, faults=1))
    assert len(found) == 3


def test_the_table_finds_a_jump_that_is_felt_and_a_hand_that_is_refused():
    hover = next(cause for cause in CAUSES if cause.outcome is Outcome.UNFELT)
    episode = episodes.episode(link_press(), HARMLESS, seeded("felt"))
    assert "felt" in episodes.problems(hover, episode)
    assert "a fault without need" in episodes.problems(
        replace(hover, outcome=Outcome.UNNOTICED), replace(episode, faults=1)
    )


def test_a_device_that_never_comes_back_breaks_the_row():
    def inject(press, _):
        press.flags = link.StateFlag.FAULT
        return [press.tick()]

    row = episodes.attacked(link_press, replace(SILENT, inject=inject), 1, 1)
    assert row.broken == ("no force ever again (1)",)


def test_a_broken_rule_is_printed():
    kept = Table("kept", (episodes.attacked(link_press, SILENT, 1, 7),))
    assert not kept.broken
    assert not any("FAILED" in line for line in kept.lines())
    row = episodes.attacked(link_press, replace(SILENT, named="another name"), 1, 7)
    broken = Table("broken", (row,))
    assert broken.broken
    assert any("FAILED: never called 'another name' (1)" in line for line in broken.lines())


def test_the_force_limit_may_be_changed_while_a_body_is_touched(eventually):
    with Servo(cube(), Settings(1e4), ramp_seconds=0.05) as servo:
        servo.start(Pointer(ABOVE))
        eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
        servo.set_target(DEEP)
        eventually(lambda: np.allclose(servo.snapshot().probe, DEEP), servo.snapshot)
        whole = servo.snapshot().contact_force[2]
        for limit, given in ((0.5 * whole, 0.5 * whole), (None, whole), (2.0 * whole, whole)):
            servo.set(Settings(1e4, max_force=limit))
            reached = lambda given=given: np.isclose(servo.snapshot().output_force[2], given)  # noqa: E731
            eventually(reached, servo.snapshot)
        with pytest.raises(ValueError, match="max_force"):
            servo.set(Settings(1e4, max_force=0.0))


def test_a_body_replaced_while_it_is_touched_is_silent_named_and_ramps(eventually):
    with Servo(cube(), Settings(1e4), ramp_seconds=0.1) as servo:
        servo.start(Pointer(ABOVE))
        eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
        servo.set_target(DEEP)
        eventually(lambda: np.allclose(servo.snapshot().probe, DEEP), servo.snapshot)
        assert servo.snapshot().output_force.any()
        old = servo.snapshot()
        servo.set_body(cube(0.049), Settings(2e4))
        shot = servo.snapshot()
        assert (old.body, shot.body) == (0, 1)
        assert (shot.state, shot.reason) == ("ramping", "body replaced")
        eventually(lambda: servo.snapshot().reason == "inside the body", servo.snapshot)
        servo.set_target(ABOVE)
        eventually(lambda: np.allclose(servo.snapshot().probe, ABOVE), servo.snapshot)
        servo.set_target(DEEP)
        eventually(lambda: np.allclose(servo.snapshot().probe, DEEP), servo.snapshot)
        # 100 N/m at 10 kPa, so 200 now, and the top is a millimetre lower.
        expected = 200.0 * (0.049 - DEEP[2])
        np.testing.assert_allclose(servo.snapshot().output_force, [0, 0, expected], atol=1e-9)
        with pytest.raises(ValueError, match="young_modulus"):
            servo.set_body(cube(), Settings(float("nan")))


def test_a_body_set_before_the_start_is_the_one_that_is_touched(eventually):
    with Servo(cube(), Settings(1e4)) as servo:
        servo.set_body(cube(0.045), Settings(3e4))
        assert (servo.snapshot().state, servo.snapshot().reason) == ("stopped", "not started")
        servo.start(Pointer(ABOVE))
        eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
        servo.set_target(DEEP)
        eventually(lambda: np.allclose(servo.snapshot().probe, DEEP), servo.snapshot)
        expected = 300.0 * (0.045 - DEEP[2])
        np.testing.assert_allclose(servo.snapshot().contact_force, [0, 0, expected], atol=1e-9)
        servo.stop()
        assert (servo.snapshot().state, servo.snapshot().reason) == ("stopped", "asked to stop")


def test_names_are_unique_and_all_of_them_are_documented():
    document = DOCUMENT.read_text(encoding="utf-8")
    told = set(re.findall(r"`([^`]+)`", document))
    for names in (STATES, palpate_servo.FAULTS, palpate_servo.REASONS, palpate_servo.LIMITERS):
        assert len(set(names)) == len(names)
        assert set(names) <= told
    assert tuple(link_press().servo.counters()["faults"]) == palpate_servo.FAULTS
