"""The paper's cube, baked, for devices to touch; and how long a hand takes to come to rest."""

import math
from contextlib import ExitStack

import pytest
from terminals import foreign_device, silent_port, terminal  # noqa: F401

from palpate.core.body import body_file


@pytest.fixture(scope="session")
def cube(cube_body):
    return cube_body


@pytest.fixture(scope="session")
def baked_file(cube, tmp_path_factory):
    path = tmp_path_factory.mktemp("body") / "cube.npz"
    body_file.save(cube, path)
    return str(path)


@pytest.fixture(scope="session")
def settled(eventually):
    """Wait for the device's report once the hand is at `target` and 20 reports are alike."""

    def wait(device, target, within=1e-6):
        resting = []

        def still():
            report = device.report()
            if report["target"] != pytest.approx(target) or (
                resting and math.dist(report["position"], resting[-1]["position"]) > within
            ):
                resting.clear()
            resting.append(report)
            return resting[-1] if len(resting) > 20 else None

        return eventually(still)

    return wait


@pytest.fixture
def started():
    """Keeps devices and servos until the test ends: `started(SimulatedDevice(...))`."""
    with ExitStack() as running:
        yield running.enter_context
