"""`palpate servo --check-timing` needs nothing, and tells nothing of the user."""

import getpass
import json
import platform

import pytest

from palpate.cli.main import main


def run(capsys, *options):
    with pytest.raises(SystemExit) as end:
        main(["servo", *options, "--check-timing"])
    return end.value.code, *capsys.readouterr()


def test_it_tells_what_the_computer_is_and_how_ticks_were_kept(capsys):
    code, out, _ = run(capsys, "--seconds", "0.5", "--json")
    report = json.loads(out)
    assert code == 0
    assert report["rate_hz"] == 1000
    assert report["ticks"] > 100
    assert report["seconds"] >= 0.5
    assert {"p50", "p99", "max"} <= set(report["lateness_us"])
    assert report["machine"].startswith(platform.machine())
    assert isinstance(report["realtime"], str)
    assert set(report["stages_us"]) >= {"contact"}
    for private in (platform.node(), getpass.getuser()):
        assert f'"{private}"' not in out


def test_people_get_a_table(capsys):
    code, out, _ = run(capsys, "--seconds", "0.2", "--rate", "500")
    assert code == 0
    assert "tick, us" in out


def test_no_time_is_refused(capsys):
    code, _, error = run(capsys, "--seconds", "0")
    assert code == 2
    assert "--seconds" in error
