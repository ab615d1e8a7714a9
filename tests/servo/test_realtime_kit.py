"""Real-time priority by RealtimeKit, asked of a stand-in on a private bus."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SERVICE = Path(__file__).with_name("realtime_kit.py")
NEEDED = ("dbus-daemon", "setpriv")

pytestmark = [
    pytest.mark.skipif(
        not sys.platform.startswith("linux") or any(shutil.which(name) is None for name in NEEDED),
        reason=f"needs Linux with {' and '.join(NEEDED)}",
    ),
    pytest.mark.skipif(
        not hasattr(os, "geteuid") or os.geteuid() != 0,
        reason="needs root, for the stand-in grants what only root may grant",
    ),
]

CONFIGURATION = """<busconfig>
<type>system</type>
<listen>unix:path={socket}</listen>
<auth>EXTERNAL</auth>
<policy context="default">
<allow user="*"/><allow own="*"/><allow send_destination="*"/><allow receive_sender="*"/>
</policy>
</busconfig>
"""

# Asks for a thread that has nothing to do, and looks at it from outside.
ORDINARY_USER = """
import json, os, resource, time
from palpate_servo.harness import BareTimer
timer = BareTimer(1000)
while timer.counters()["realtime"] == "not asked yet":
    time.sleep(0.005)
(thread,) = (int(task) for task in os.listdir("/proc/self/task") if int(task) != os.getpid())
limits = resource.getrlimit(resource.RLIMIT_RTTIME)
told = timer.counters()["realtime"]
policy, nice = os.sched_getscheduler(thread), os.getpriority(os.PRIO_PROCESS, thread)
priority = os.sched_getparam(thread).sched_priority
if TAKE_BACK:
    os.sched_setscheduler(thread, os.SCHED_OTHER | os.SCHED_RESET_ON_FORK, os.sched_param(0))
print(json.dumps({"told": told, "policy": policy & ~os.SCHED_RESET_ON_FORK, "nice": nice,
    "priority": priority, "limits": limits, "told_later": timer.counters()["realtime"]}))
timer.stop()
"""


@pytest.fixture
def bus(tmp_path: Path) -> Iterator[dict[str, str]]:
    """The environment of whoever lives with a system bus of our own."""
    socket = tmp_path / "bus"
    configuration = tmp_path / "bus.conf"
    configuration.write_text(CONFIGURATION.format(socket=socket))
    daemon = subprocess.Popen(
        ["dbus-daemon", f"--config-file={configuration}", "--nofork", "--print-address"],
        stdout=subprocess.PIPE,
        text=True,
    )
    with daemon:
        assert daemon.stdout is not None
        assert daemon.stdout.readline(), "the bus has not started"
        yield {**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={socket}"}
        daemon.terminate()


def asked(environment: dict[str, str], *, take_back: bool = False) -> dict[str, Any]:
    """What a process without the right to real-time priority is told and gets."""
    program = ORDINARY_USER.replace("TAKE_BACK", str(take_back))
    dropped = ("--bounding-set=-sys_nice", "--inh-caps=-sys_nice")
    done = subprocess.run(
        ["setpriv", *dropped, sys.executable, "-c", program],
        env=environment,
        capture_output=True,
        text=True,
        timeout=30,
        check=True,
    )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.fixture
def kit(bus: dict[str, str]) -> Iterator[Callable[[str], None]]:
    """Starts the stand-in in a mode."""
    pytest.importorskip("jeepney", reason="needs the jeepney of the test extra")
    started: list[subprocess.Popen[str]] = []

    def start(mode: str) -> None:
        service = subprocess.Popen(
            [sys.executable, str(SERVICE), mode], env=bus, stdout=subprocess.PIPE, text=True
        )
        started.append(service)
        assert service.stdout is not None
        assert service.stdout.readline() == "ready\n"

    yield start
    for service in started:
        service.terminate()
        service.communicate()


def test_the_kit_gives_real_time_within_its_own_limits(bus, kit):
    kit("grant")
    found = asked(bus)
    assert found["told"] == found["told_later"] == "rtkit fifo 7"
    assert (found["policy"], found["priority"]) == (os.SCHED_FIFO, 7)
    # The signal, which takes the priority away, comes before the kill.
    assert found["limits"] == [75_000, 150_000]


def test_priority_that_was_taken_back_is_told(bus, kit):
    kit("grant")
    found = asked(bus, take_back=True)
    assert found["told"] == "rtkit fifo 7"
    assert found["told_later"].startswith("none: rtkit fifo 7 was taken back")


def test_a_kit_that_refuses_real_time_may_still_give_a_high_priority(bus, kit):
    kit("nice")
    found = asked(bus)
    assert found["told"] == "rtkit nice -11"
    assert (found["policy"], found["nice"]) == (os.SCHED_OTHER, -11)
    # What was limited for real time acts no more than the system allows to undo.
    assert found["limits"][0] == found["limits"][1]


@pytest.mark.parametrize(
    ("mode", "words"),
    [
        ("refuse", "RealtimeKit: not today; "),
        ("silent", "RealtimeKit: the bus does not answer in time; "),
        (None, "RealtimeKit: The name org.freedesktop.RealtimeKit1 was not provided"),
    ],
)
def test_a_kit_that_gives_nothing_is_told_with_a_remedy(bus, kit, mode, words):
    if mode is not None:
        kit(mode)
    found = asked(bus)
    assert found["told"].startswith("none: ")
    assert words in found["told"]
    assert "install rtkit" in found["told"]
    # The child begins as nice as these tests are.
    assert (found["policy"], found["nice"]) == (os.SCHED_OTHER, os.nice(0))


def test_a_system_without_a_bus_is_told_with_a_remedy(tmp_path):
    found = asked({**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={tmp_path / 'none'}"})
    assert found["told"].startswith("none: Operation not permitted")
    assert "install rtkit" in found["told"]
    assert found["limits"] == [-1, -1]
