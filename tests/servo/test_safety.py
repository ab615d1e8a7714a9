"""Every rule of docs/safety.md with its cause: the servo's ticks and the link's bytes, by hand."""

import re
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import palpate_servo
import pytest
from fault_injection import episodes
from fault_injection.causes import CAUSES, Outcome
from fault_injection.rows import print_rows
from fault_injection.servo_host import ABOVE, DEEP, cube
from fault_injection.virtual_press import VirtualPress
from palpate_servo import STATES, Pointer, Servo

from palpate.core.servo.settings import Settings

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "safety.md"
SILENT = next(cause for cause in CAUSES if cause.outcome is Outcome.SILENT)
HARMLESS = next(cause for cause in CAUSES if cause.outcome is Outcome.HARMLESS)


def seeded(seed):
    return Random(seed)  # noqa: S311 - which fault when, not secrets


@pytest.mark.parametrize("cause", CAUSES, ids=lambda cause: cause.name)
def test_each_cause_gives_what_the_rules_say(cause):
    press, dice = VirtualPress(cube()), seeded(cause.name)
    for _ in range(2):
        assert episodes.problems(cause, episodes.episode(press, cause, dice)) == []


def test_a_device_that_hears_nothing_more_is_limp_within_20_ms():
    row = episodes.killed_row(10, seeded("killed"))
    assert row.broken == ()
    assert row.device in ("limp 19.0 ms after it", "limp 20.0 ms after it")


@pytest.mark.parametrize(
    ("spoil", "problem"),
    [
        (lambda e: replace(e, during=[replace(e.during[0], output=0.1), *e.back]), "ticks after"),
        (lambda e: replace(e, during=[replace(s, felt=0.1) for s in e.during]), "motors go on"),
        (lambda e: replace(e, during=[replace(s, reason="") for s in e.during]), "never called"),
        (lambda e: replace(e, back=[e.back[0], *e.back[-1:] * 5]), "no ramp"),
    ],
)
def test_the_table_finds_a_broken_rule(spoil, problem):
    press, dice = VirtualPress(cube()), seeded("broken")
    episode = episodes.episode(press, SILENT, dice)
    while len(episode.during) < 3:
        episode = episodes.episode(press, SILENT, dice)
    assert any(problem in found for found in episodes.problems(SILENT, spoil(episode)))


def test_the_table_finds_a_fault_without_need_and_a_force_that_changed():
    episode = episodes.episode(VirtualPress(cube()), HARMLESS, seeded("harmless"))
    other = [replace(episode.during[0], output=episode.before.output + 1e-3)]
    found = episodes.problems(HARMLESS, replace(episode, during=other, counted=0, faults=1))
    assert len(found) == 3


def test_a_broken_rule_is_printed(capsys):
    print_rows("kept", [episodes.virtual_row(SILENT, 1, seeded("printed"))])
    assert "FAILED" not in capsys.readouterr().out
    broken = episodes.virtual_row(replace(SILENT, named="another name"), 1, seeded("printed"))
    print_rows("broken", [broken])
    assert "FAILED: never called 'another name' (1)" in capsys.readouterr().out


def test_the_force_limit_may_be_changed_while_a_body_is_touched(eventually):
    with Servo(cube(), Settings(1e4), ramp_seconds=0.01) as servo:
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
    assert tuple(VirtualPress(cube()).servo.counters()["faults"]) == palpate_servo.FAULTS
