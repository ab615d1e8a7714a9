"""`palpate servo --second-port`: two devices, each a process of its own, press one body."""

import json

import numpy as np
import pytest

from palpate.cli.main import main
from palpate.core.record.read_recording import read_recording
from palpate.core.record.recording import FINGER_COLUMN
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice


def pressing(x, way):
    return SimulatedOptions(
        rest=(x - 0.008 * way, 0.025, 0.025),
        at=(x, 0.025, 0.025),
        by=(0.004 * way, 0.0, 0.0),
        approach=0.5,
        period=1.0,
    )


@pytest.mark.in_time
@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_two_devices_press_and_are_recorded(baked_file, tmp_path, capsys, suffix):
    path = tmp_path / f"both.{suffix}"
    with (
        SimulatedDevice(pressing(0.0, 1.0)) as one,
        SimulatedDevice(pressing(0.05, -1.0)) as two,
    ):
        arguments = ["--port", one.port, "--second-port", two.port, "--seconds", "1.5", "--json"]
        assert main(["servo", baked_file, *arguments, "--record", str(path)]) == 0
    report = json.loads(capsys.readouterr().out)
    (other,) = report["other_fingers"]
    assert other["link"]["device"] is not None
    assert other["link"]["forces"] > 500
    assert not any(other["faults"][name] for name in ("nan", "wrong protocol", "internal error"))
    samples = read_recording(path).samples
    assert set(samples["finger"].tolist()) == {0, 1}
    forces = [samples["force"][samples["finger"] == finger] for finger in (0, 1)]
    assert len(forces[0]) == len(forces[1])
    assert forces[0][:, 0].min() < -0.01
    assert forces[1][:, 0].max() > 0.01
    together = (np.abs(forces[0]).max(axis=1) > 0) & (np.abs(forces[1]).max(axis=1) > 0)
    assert together.any()
    if suffix == "csv":
        with path.open() as file:
            assert file.readline().rstrip().endswith(FINGER_COLUMN)


def test_a_port_named_twice_is_refused(baked_file, capsys):
    with SimulatedDevice(pressing(0.0, 1.0)) as one:
        ports = ["--port", one.port, "--second-port", one.port]
        assert main(["servo", baked_file, *ports, "--seconds", "0.1"]) != 0
    assert "a port is named twice" in capsys.readouterr().err
