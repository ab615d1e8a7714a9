"""The whole loop, in real time: what hums when a motor feels a stiff body itself is quiet."""

import time
from itertools import pairwise

import pytest
from palpate_servo import LinkDevice, Servo

from palpate.core.servo.settings import Coupling, Settings
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

# Over the middle of a triangle of the cube's top (50 mm).
ABOVE = (0.026, 0.024, 0.055)
PRESSED = (0.026, 0.024, 0.035)
STIFF = 300_000.0
"""Pa; several thousand N/m on this cube."""


def shaken(cube, eventually, coupling):
    """What friction takes of the device in 0.3 s while its hand rests, J: the least of four times.

    A machine that is busy elsewhere delays a force now and then. That makes a knock, but no hum: a
    hum is there in every one of them. One that holds it up for so long that the device is let go
    tells nothing of either, and all is done once more.
    """
    taken = eventually(lambda: taken_by_friction(cube, eventually, coupling), seconds=60.0)
    return min(after - before for before, after in pairwise(taken))


def taken_by_friction(cube, eventually, coupling):
    """What it has taken so far, five times, J; None if the device was let go."""
    late = SimulatedOptions(
        rest=ABOVE,
        mass=0.06,
        damping=0.2,
        coulomb=0.03,
        resolution_um=20,
        force_step=1e-3,
        delay=0.5e-3,
        jitter=0.2e-3,
        hand_stiffness=60.0,
        hand_damping=0.3,
    )
    with (
        SimulatedDevice(late) as device,
        Servo(cube.native, Settings(STIFF), ramp_seconds=0.05, max_speed=100.0) as servo,
    ):
        if coupling is not None:
            servo.set(Settings(STIFF, coupling=Coupling(**coupling)))
        servo.start(LinkDevice(device.port))
        eventually(lambda: servo.snapshot().state == "free")
        faults = servo.counters()["faults"]
        device.move_hand(PRESSED, 0.2)
        eventually(lambda: device.report()["largest_force"] > 0.5)
        time.sleep(0.5)
        taken = []
        for _ in range(5):
            report = device.report()
            assert report["target"] == pytest.approx(PRESSED)
            taken.append(report["taken_by_viscous_friction"] + report["taken_by_coulomb_friction"])
            time.sleep(0.3)
        return taken if servo.counters()["faults"] == faults else None


@pytest.mark.in_time
def test_a_stiff_body_that_shakes_a_late_device_is_quiet_by_default(cube, eventually):
    bare = {"stiffness": float("inf"), "damping": 0.0, "passivity_control": False}
    humming = shaken(cube, eventually, bare)
    assert humming > 2e-3
    assert shaken(cube, eventually, None) < 0.02 * humming
