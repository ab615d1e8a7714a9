"""Faults of the system: processes stopped and killed, plugs pulled, readers that stall."""

from __future__ import annotations

import itertools
import signal
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

from ...simulated_process import SimulatedDevice
from ..table import Row, counted
from .host import Host, device, eventually
from .pressing import Hand, press, strength
from .servo_host import RAMP_SECONDS
from .trials import trials

STOPPED_SECONDS = 1.0
STEADY_TICKS = 20
BURST_SECONDS = 0.050
RELEASE_SECONDS = 0.6
PERIOD = 1e-3
WATCHDOG_SECONDS = 0.020
SUSPENDED = f"SIGSTOP for {STOPPED_SECONDS:g} s, SIGCONT"
KILLED = "SIGKILL"
UNPLUGGED = "the plug pulled, and put back"
ROUNDING = 1e-9
DAMPING = 5e-3
"""What the coupling of devices with motors adds to the body's own force while nobody moves, N."""


@dataclass(frozen=True)
class Suspension:
    """A host that was stopped by a signal in the middle of a press, and went on."""

    before: list[dict[str, Any]]
    """Its ticks before it was stopped (see `servo_host.samples`)."""
    after: list[dict[str, Any]]
    """Those after it was."""
    counted: int
    """Faults called "suspended"."""
    device: dict[str, Any]
    """What the device said meanwhile."""

    @property
    def held_up_ms(self) -> float:
        """How long nobody had let the device look when it went limp; infinite where the force was
        gone before, as it is for a host that is held up.
        """
        if not self.before[-1]["output"] > 0.0:
            return float("inf")
        return float(self.device["limp_look"]) * 1e3

    @property
    def gap(self) -> float:
        """Time without a tick, s."""
        return float(self.after[0]["time"] - self.before[-1]["time"])

    @property
    def ramp(self) -> list[dict[str, Any]]:
        """From the first tick that allows force again until it is whole, if there is one."""
        comes = itertools.dropwhile(lambda tick: tick["state"] != "ramping", self.after)
        return list(itertools.takewhile(lambda tick: tick["state"] == "ramping", comes))

    def problems(self) -> list[str]:
        """The rules of docs/safety.md that were broken."""
        found = []
        if self.after[0]["output"] != 0.0 or self.after[0]["state"] != "fault":
            found.append("force in the first tick")
        begin = self.after[0]["time"]
        if any(tick["output"] > 0.0 for tick in self.after[:STEADY_TICKS]):
            found.append("force before the ticks were steady")
        found += self._ramp_problem()
        at_once = [tick for tick in self.after if tick["time"] - begin < BURST_SECONDS]
        if len(at_once) > BURST_SECONDS / PERIOD + 2:
            found.append("a burst of ticks")
        if self.counted < 1:
            found.append("not counted")
        return found + device_problems(self.device)

    def _ramp_problem(self) -> list[str]:
        if not self.ramp:
            return ["no ramp"]
        for number, tick in enumerate(self.ramp, start=1):
            allowed = number * PERIOD / RAMP_SECONDS * (tick["wanted"] + DAMPING) + ROUNDING
            if tick["output"] > allowed:
                return [
                    f"{tick['output']:.4f} N, {allowed:.4f} allowed in tick {number} of the ramp"
                ]
        return []


def device_problems(report: dict[str, Any]) -> list[str]:
    """Whether the device went limp as soon as it could see that nothing came."""
    found = []
    if not report["limp"] or strength(report) > 0.0:
        found.append("the device goes on")
    if report["limp_after"] > WATCHDOG_SECONDS + report["limp_look"] + ROUNDING:
        found.append("the watchdog is late")
    return found


def suspend(host: Host, hand: Hand, seconds: float = STOPPED_SECONDS) -> Suspension:
    """Stop a host in the middle of a press by a signal, and let it go on."""
    press(host, hand)
    host.samples()
    count = host.report()["faults"]["suspended"]
    host.signal(signal.SIGSTOP)
    time.sleep(seconds)
    meanwhile = hand.report()
    host.signal(signal.SIGCONT)
    eventually(lambda: host.report()["faults"]["suspended"] > count, "the host notices")
    eventually(lambda: host.report()["state"] == "touching", "the force is back")
    ticks = host.samples()
    # The first that is as long: a busy computer may hold the host up again.
    gaps = (now["time"] - last["time"] for last, now in itertools.pairwise(ticks))
    cut = next((i for i, gap in enumerate(gaps, start=1) if gap > 0.9 * seconds), 1)
    counted = host.report()["faults"]["suspended"] - count
    return Suspension(ticks[:cut], ticks[cut:], counted, meanwhile)


@dataclass(frozen=True)
class Ending:
    """What a device said when its host was gone."""

    device: dict[str, Any]

    @property
    def held_up_ms(self) -> float:
        """How long nobody had let the device look when it went limp."""
        return float(self.device["limp_look"]) * 1e3


def killed(host: Host) -> None:
    """Kill it."""
    host.signal(signal.SIGKILL)


def kill(port: str, hand: Hand, end: Callable[[Host], None] = killed) -> dict[str, Any]:
    """Kill a host in the middle of a press; what the device then says."""
    with Host(port) as host:
        press(host, hand)
        end(host)
        host.process.join()
    eventually(lambda: bool(hand.report()["limp"]), "the device goes limp")
    return hand.report()


def unplug(host: Host, hand: SimulatedDevice) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Pull the plug in the middle of a press, and put it back; the host's ticks, and the device."""
    press(host, hand)
    host.samples()
    hand.unplug()
    eventually(lambda: bool(host.report()["fault"] == "unplugged"), "the host notices")
    eventually(lambda: bool(hand.report()["limp"]), "the device goes limp")
    meanwhile = hand.report()
    hand.plug_in()
    press(host, hand)
    return host.samples(), meanwhile


def _limp(reports: list[dict[str, Any]], *others: str) -> str:
    slowest = max(reports, key=lambda report: report["limp_after"], default=None)
    limp = slowest and (
        f"limp after {slowest['limp_after'] * 1e3:.1f} ms, "
        f"looked {slowest['limp_look'] * 1e3:.1f} ms before"
    )
    return "; ".join(part for part in (limp, *others) if part)


def suspended_row(
    times: int,
    injected: str = SUSPENDED,
    place: Callable[[], AbstractContextManager[Hand]] = device,
) -> Row:
    """SIGSTOP for a second, SIGCONT."""
    with place() as hand, Host(hand.port) as host:
        tried = trials(times, lambda: suspend(host, hand))
    broken = Counter(problem for one in tried.judged for problem in one.problems())
    at_fault = [t["output"] for one in tried.judged for t in one.after if t["state"] == "fault"]
    back = [one.ramp[-1]["time"] - one.after[0]["time"] for one in tried.judged if one.ramp]
    return Row(
        injected=injected,
        times=len(tried.judged),
        told="suspended",
        force=max(at_fault, default=None),
        zero_ms=0.0,
        back_ms=max(back, default=0.0) * 1e3,
        note=_limp([one.device for one in tried.judged], tried.note),
        broken=counted(broken) or tried.unjudged,
    )


def killed_row(
    times: int,
    injected: str = KILLED,
    place: Callable[[], AbstractContextManager[Hand]] = device,
    end: Callable[[Host], None] = killed,
) -> Row:
    """SIGKILL: the host says no last word."""
    with place() as hand:

        def once() -> Ending:
            # The simulated port lets a host in when the last one has been silent for long.
            time.sleep(RELEASE_SECONDS)
            return Ending(kill(hand.port, hand, end))

        tried = trials(times, once)
    reports = [one.device for one in tried.judged]
    broken = Counter(problem for report in reports for problem in device_problems(report))
    return Row(
        injected=injected,
        times=len(reports),
        told="(no host)",
        zero_ms=max((report["limp_after"] for report in reports), default=float("inf")) * 1e3,
        note=_limp(reports, tried.note),
        broken=counted(broken) or tried.unjudged,
    )


def unplugged_row(times: int) -> Row:
    """The plug pulled, and put back."""
    reports, broken, most = [], Counter[str](), 0.0
    with device() as hand, Host(hand.port) as host:
        for _ in range(times):
            ticks, meanwhile = unplug(host, hand)
            reports.append(meanwhile)
            broken.update(device_problems(meanwhile))
            faulty = [tick["output"] for tick in ticks if tick["state"] == "fault"]
            most = max(most, *faulty)
            broken.update(["force without a device"] if any(faulty) else [])
        broken.update([] if host.report()["faults"]["unplugged"] == times else ["not counted"])
    return Row(
        injected=UNPLUGGED,
        times=times,
        told="unplugged",
        force=most,
        note=_limp(reports),
        broken=counted(broken),
    )


def process_rows(times: int, wanted: Callable[[str], bool]) -> Iterator[Row]:
    """Rows of hosts that are stopped, killed and unplugged; some seconds for each of `times`."""
    rows = {SUSPENDED: suspended_row, KILLED: killed_row, UNPLUGGED: unplugged_row}
    return (row(times) for injected, row in rows.items() if wanted(injected))
