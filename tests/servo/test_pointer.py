"""The servo led by a pointer, end to end, and its life as a thread."""

import gc
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
from palpate_servo import STATES, Pointer, Servo
from palpate_servo.harness import BareTimer

from palpate.core.servo.settings import Settings

ABOVE = np.array([0.02, 0.03, 0.055])
PRESSED = np.array([0.021, 0.029, 0.047])
ASIDE = np.array([0.03, 0.0, 0.0])
MODULUS = 10_000.0


@pytest.fixture
def servo(cube):
    with Servo(cube.native, Settings(MODULUS), ramp_seconds=0.05) as servo:
        yield servo


def at(servo, place):
    return lambda: bool(np.all(servo.snapshot().probe == place))


def rests(shot):
    """Whether nothing brakes the finger any more: the force is that of the nodes."""
    return np.allclose(shot.contact_force, -shot.nodal_forces.sum(axis=0), rtol=1e-13, atol=0)


def test_a_servo_that_has_stopped_takes_as_many_tools_as_it_is_given(cube, servo):
    servo.start(Pointer(ABOVE))
    servo.stop()
    for _ in range(9):
        servo.set_tool(None)


def test_pressing_gives_the_formulas_force_and_leaving_gives_none(cube, servo, eventually):
    servo.start(Pointer(ABOVE))
    eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
    servo.set_target(PRESSED)
    eventually(at(servo, PRESSED), servo.snapshot)
    eventually(lambda: not servo.snapshot().limited, "the ramp ends")
    eventually(lambda: rests(servo.snapshot()), "the brake has gone")
    shot = servo.snapshot()
    assert (shot.state, shot.touching, shot.fault) == ("touching", True, "")
    np.testing.assert_allclose(shot.proxy, [*PRESSED[:2], 0.05], atol=1e-15)
    np.testing.assert_array_equal(shot.triangle, cube.triangles[shot.triangle_index])
    blocks = MODULUS * cube.blocks[shot.triangle]
    expected = shot.alpha[:, None] * (blocks @ (shot.probe - shot.proxy))
    np.testing.assert_allclose(shot.nodal_forces, expected, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(shot.contact_force, -expected.sum(axis=0), rtol=1e-9)
    servo.set_target(ABOVE)
    eventually(at(servo, ABOVE), servo.snapshot)
    shot = servo.snapshot()
    assert (shot.state, shot.triangle_index) == ("free", -1)
    assert not shot.output_force.any()
    assert not shot.nodal_forces.any()


def test_the_probe_glides_and_never_jumps(cube, eventually):
    with Servo(cube.native, Settings(MODULUS), glide_speed=0.2) as servo:
        servo.start(Pointer(ABOVE))
        servo.set_target(ABOVE + ASIDE)
        eventually(at(servo, ABOVE + ASIDE))
        steps = np.linalg.norm(np.diff(servo.samples()["probe"], axis=0), axis=1)
    assert steps.max() <= 0.2e-3 * (1 + 1e-9)
    assert (steps > 0).sum() >= 150


def test_restart_sets_the_probe_down_without_a_sweep_through_the_body(servo, eventually):
    servo.start(Pointer(ABOVE))
    eventually(lambda: servo.snapshot().tick > 0)
    below = ABOVE * [1, 1, -1]
    servo.set_target(below, restart=True)
    servo.set_target(below + ASIDE)  # A newer target must not hide the restart.
    eventually(at(servo, below + ASIDE))
    samples = servo.samples()
    assert set(samples["state"]) <= {STATES.index("ramping"), STATES.index("free")}
    assert not samples["force"].any()
    assert np.linalg.norm(np.diff(samples["probe"], axis=0), axis=1).max() > 0.1


def test_a_move_right_after_setting_down_does_not_hide_where(servo, eventually):
    """Both arrive before the thread looks once; only the newest target is seen."""
    servo.start(Pointer(ABOVE + np.array([0, 0, 0.03])))
    eventually(lambda: servo.snapshot().state == "free")
    for push in range(50):
        inside = PRESSED + np.array([0, 0, -1e-5 * push])
        servo.set_target(ABOVE, restart=True)
        servo.set_target(inside)
        eventually(lambda inside=inside: np.allclose(servo.snapshot().probe, inside, atol=1e-9))
        assert servo.snapshot().touching, push


def test_set_down_inside_nothing_is_felt_until_it_was_outside(servo, eventually):
    servo.start(Pointer(PRESSED))
    eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
    assert servo.snapshot().reason == "inside the body"
    for place, state in ((ABOVE, "free"), (PRESSED, "touching")):
        servo.set_target(place)
        eventually(at(servo, place))
        assert servo.snapshot().state == state


def test_snapshots_are_never_torn(cube):
    with Servo(cube.native, Settings(MODULUS), rate_hz=8000, glide_speed=20) as servo:
        servo.start(Pointer(ABOVE))
        rng = np.random.default_rng(3)
        seen = touching = 0
        last = -1
        while seen < 3000:
            if seen % 10 == 0:
                servo.set_target(ABOVE + rng.uniform(-1, 1, 3) * [0.02, 0.02, 0.01])
            shot = servo.snapshot()
            assert shot.tick >= last
            seen += shot.tick != last
            last = shot.tick
            if shot.touching:
                touching += 1
                corners = cube.nodes[shot.triangle]
                np.testing.assert_allclose(shot.alpha @ corners, shot.proxy, atol=1e-15)
                nodal, force = cube.native.contact(
                    shot.triangle_index, shot.alpha, shot.probe - shot.proxy, MODULUS
                )
                np.testing.assert_array_equal(shot.nodal_forces, nodal)
                brake = np.linalg.norm(shot.contact_force - force)
                assert brake <= np.linalg.norm(force) * (1 + 1e-12)
            else:
                np.testing.assert_array_equal(shot.probe, shot.proxy)
    assert touching > 100


def test_every_tick_is_recorded_until_the_ring_is_full(cube, eventually):
    with Servo(cube.native, Settings(MODULUS), record_seconds=0.1) as servo:
        servo.start(Pointer(ABOVE))
        eventually(lambda: servo.counters()["samples_lost"] > 10)
        samples = servo.samples()
        assert len(samples) == 100
        np.testing.assert_array_equal(samples["tick"], np.arange(1, 101))
        assert np.all(np.diff(samples["time"]) > 0)
        assert samples["probe"].shape == (100, 3)
        eventually(lambda: len(servo.samples()) > 0, "the ring is free again")


def test_counters_agree_with_each_other(servo, eventually):
    servo.start(Pointer(ABOVE))
    eventually(lambda: servo.counters()["ticks"] > 300)
    servo.stop()
    counters = servo.counters()
    assert sum(count for _, count in counters["histogram"]) == counters["ticks"]
    lateness = counters["lateness_us"]
    assert lateness["p50"] <= lateness["p99"] <= lateness["p99_9"] <= lateness["max"]
    assert counters["late_ticks"] == counters["late_over_200_us"]
    assert counters["late_over_10_us"] >= counters["late_over_50_us"]
    assert list(counters["stages_us"]) == ["read", "proxy", "contact", "write"]
    stages = counters["stages_us"].values()
    assert all(0.0 < times["mean"] <= times["max"] for times in stages)
    assert all(0.0 < times["p99"] <= times["max"] for times in stages)
    assert sum(times["mean"] for times in stages) <= counters["busy_us"]["mean"]
    assert counters["realtime"].startswith(("fifo", "rtkit", "none: ", "multimedia", "time"))
    assert counters["rate_hz"] == 1000
    assert not any(counters["faults"].values())
    assert servo.snapshot().tick in (counters["ticks"], counters["ticks"] - 1)


def test_stopping_is_idempotent_and_starting_again_works(servo, eventually):
    servo.stop()
    assert not servo.running
    assert servo.snapshot().state == "stopped"
    for _ in range(3):
        servo.start(Pointer(ABOVE))
        assert servo.running
        eventually(lambda: servo.snapshot().state == "free")
        with pytest.raises(RuntimeError, match="runs already"):
            servo.start(Pointer(ABOVE))
        servo.stop()
        servo.stop()
        assert not servo.running
        assert servo.snapshot().state == "stopped"
    with pytest.raises(RuntimeError, match=r"start\(Pointer"):
        servo.set_target(ABOVE)


def test_two_servos_run_side_by_side(cube, eventually):
    with (
        Servo(cube.native, Settings(MODULUS)) as one,
        Servo(cube.native, Settings(2 * MODULUS), rate_hz=500) as two,
    ):
        for servo in (one, two):
            servo.start(Pointer(ABOVE))
            servo.set_target(PRESSED)
        for servo in (one, two):
            eventually(at(servo, PRESSED))
            eventually(lambda servo=servo: rests(servo.snapshot()), "the brake has gone")
        np.testing.assert_allclose(
            2 * one.snapshot().contact_force, two.snapshot().contact_force, rtol=1e-12
        )


def test_a_forgotten_servo_ends_with_its_object(cube):
    servo = Servo(cube.native, Settings(MODULUS))
    servo.start(Pointer(ABOVE))
    del servo
    gc.collect()


def test_leaving_the_interpreter_with_a_running_servo_does_not_hang():
    script = """
        import numpy as np, palpate_servo as ps
        from palpate.core.servo.settings import Settings
        nodes = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
        triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        body = ps.Body(nodes, triangles, np.tile(np.eye(3), (4, 1, 1)))
        servos = [ps.Servo(body, Settings(1.0)) for _ in range(3)]
        for servo in servos:
            servo.start(ps.Pointer([2, 2, 2]))
        timer = ps.harness.BareTimer(1000)
        print("leaving")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "leaving\n", "")


def test_a_bare_timer_counts_what_it_did():
    timer = BareTimer(1000)
    time.sleep(0.2)
    counters = timer.stop()
    # Its thread may begin late, on a busy machine by tens of milliseconds.
    assert counters["ticks"] + counters["missed"] >= 150
    with pytest.raises(ValueError, match="from 100 to 8000"):
        BareTimer(50)


@pytest.mark.parametrize(
    ("setting", "reason"),
    [
        ({"rate_hz": 99}, "rate_hz"),
        ({"rate_hz": 8001}, "rate_hz"),
        ({"max_force": 0.0}, "max_force"),
        ({"max_slew": float("nan")}, "max_slew"),
        ({"ramp_seconds": 0.0}, "ramp_seconds is 0; it must be from 0.05 to 3600 seconds"),
        ({"ramp_seconds": 0.049}, "ramp_seconds"),
        ({"record_seconds": 60.1}, r"from 0 to 60.*start_recording"),
        ({"record_seconds": float("nan")}, "record_seconds is NaN"),
        ({"max_speed": float("inf")}, "max_speed"),
        ({"young_modulus": -1.0}, "young_modulus"),
    ],
)
def test_settings_without_sense_are_refused(cube, setting, reason):
    options = {"young_modulus": 1.0} | setting
    modulus = options.pop("young_modulus")
    with pytest.raises(ValueError, match=reason):
        Servo(cube.native, Settings(modulus), **options)
