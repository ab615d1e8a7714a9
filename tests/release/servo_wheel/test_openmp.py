"""The OpenMP of one thread for Windows: compiled, in the wheel, and what CoACD asks for."""

from __future__ import annotations

import zipfile
from pathlib import Path

from servo_wheel import openmp
from servo_wheel.target import TARGETS

REPOSITORY = Path(__file__).resolve().parents[3]


def test_it_lies_in_the_wheel_and_has_what_is_asked_for(tmp_path):
    wheel = tmp_path / "palpate_servo-0.1.0-cp311-abi3-win_amd64.whl"
    record = "palpate_servo-0.1.0.dist-info/RECORD"
    contents = []
    for _ in range(2):
        with zipfile.ZipFile(wheel, "w") as archive:
            archive.writestr(zipfile.ZipInfo(record), f"{record},,\n")
        openmp.add_to(wheel, REPOSITORY)
        contents.append(wheel.read_bytes())
    assert contents[0] == contents[1]
    with zipfile.ZipFile(wheel) as archive:
        image = archive.read(openmp.NAME)
        row, _ = archive.read(record).decode().splitlines()
    assert list(openmp.faults(image)) == []
    assert row.startswith(f"{openmp.NAME},sha256=")
    assert row.endswith(f",{len(image)}")


def test_only_windows_on_x64_has_a_coacd_that_asks_for_it():
    assert [name for name, one in TARGETS.items() if openmp.is_wanted(one)] == ["windows-x64"]
