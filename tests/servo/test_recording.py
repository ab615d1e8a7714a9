"""Recording every tick beside everything else that is asked of the servo."""

import numpy as np
import pytest
from palpate_servo import STATES, Pointer, Servo

from palpate.core.servo.settings import Settings

MODULUS = 10_000.0
ABOVE, PRESSED = (0.02, 0.03, 0.055), (0.02, 0.03, 0.047)


@pytest.fixture
def servo(cube):
    with Servo(cube.native, Settings(MODULUS), ramp_seconds=0.05) as servo:
        yield servo


def is_whole(ticks, first=None):
    return (np.diff(ticks) == 1).all() and first in (None, ticks[0])


def same(one, other):
    # Bit by bit, for what is not a number equals nothing.
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def test_before_the_start_it_records_from_the_first_tick_to_the_last(servo, eventually):
    assert servo.start_recording(10.0) == 10_000 * 144
    assert not servo.is_recording
    servo.start(Pointer(ABOVE))
    assert servo.is_recording
    servo.set_target(PRESSED)
    eventually(lambda: servo.snapshot().touching, servo.snapshot)
    servo.stop()
    recording = servo.recording()
    assert is_whole(recording["tick"], first=1)
    assert recording["tick"][-1] == servo.snapshot().tick
    assert (np.diff(recording["time"]) > 0.0).all()
    assert STATES[recording["state"][-1]] in ("ramping", "touching")
    assert recording["force"][-1].any()
    assert servo.recording_lost == 0
    assert not servo.is_recording


def test_samples_and_the_recording_both_hold_every_tick(servo, eventually):
    servo.start_recording()
    servo.start(Pointer(ABOVE))
    taken = [servo.samples()]

    def look():
        taken.append(servo.samples())
        return servo.counters()["ticks"] > 300

    eventually(look)
    servo.stop()
    taken.append(servo.samples())
    assert same(np.concatenate(taken), servo.recording())


def test_it_begins_and_ends_while_the_servo_runs(servo, eventually):
    servo.start(Pointer(ABOVE))
    assert len(servo.recording()) == 0
    eventually(lambda: servo.counters()["ticks"] > 20)
    servo.start_recording(600.0)
    with pytest.raises(RuntimeError, match="stop_recording first"):
        servo.start_recording()
    eventually(lambda: len(servo.recording()) > 20)
    servo.stop_recording()
    servo.stop_recording()
    recording = servo.recording()
    assert is_whole(recording["tick"])
    assert recording["tick"][0] > 20
    ticks = servo.counters()["ticks"]
    eventually(lambda: servo.counters()["ticks"] > ticks + 20)
    assert same(servo.recording(), recording)


def test_a_new_start_records_nothing_unless_asked(servo, eventually):
    servo.start_recording()
    servo.start(Pointer(ABOVE))
    eventually(lambda: len(servo.recording()) > 5)
    servo.stop()
    assert len(servo.recording()) > 5
    servo.start(Pointer(ABOVE))
    eventually(lambda: servo.counters()["ticks"] > 20)
    assert len(servo.recording()) == 0


def test_asked_and_thought_better_of_before_the_start(servo, eventually):
    servo.start_recording()
    servo.stop_recording()
    servo.start(Pointer(ABOVE))
    eventually(lambda: servo.counters()["ticks"] > 20)
    assert len(servo.recording()) == 0


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf"), 3601.0])
def test_a_time_without_sense_is_refused(servo, seconds):
    with pytest.raises(ValueError, match="seconds"):
        servo.start_recording(seconds)
