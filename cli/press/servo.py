"""``palpate servo``: run the native thread against a device, without Blender."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.body import body_file
from ...core.errors import PalpateError
from ...core.machine.stop_signals import stopped_by_signals
from ...core.record.recording import check_recording_path, check_room, write_recording
from ...core.servo.firming import Firming
from ...core.servo.port_error import PortError
from ...core.servo.ports import BAUD, check_baud, check_port
from ...core.servo.session import STATES, LinkDevice, servo_on
from ...core.servo.settings import Settings
from ...core.shape.shapes import shape
from ...simulated.simulated_process import SimulatedDevice
from ..body.body_argument import add_body, add_young, modulus_of
from ..body.shape_option import add_shape, shape_of
from ..rest.floor_options import add_floor
from ..rest.laid_body import LaidBody, laid_body
from ..rest.laid_scene import laid_scene
from ..scene.scene_file import is_scene
from .from_above import highest_place, press_from_above, vector
from .haply import add_haply_options, connect_haply
from .servo_report import Felt, for_people, servo_report
from .timing_check import add_check_timing

if TYPE_CHECKING:
    from ...core.servo.session import FingerCounters, Servo

HELLO_SECONDS = 5.0
LOOK_EVERY_SECONDS = 0.02
LONGEST_RECORDING_SECONDS = 3600.0

HELP = "touch a body with a device, at 1 kHz"
DESCRIPTION = (
    "Run the real-time thread between a device and a body, then print what was "
    "felt and how its deadlines were kept. Ctrl-C ends it with zero force."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser, or_scene=True)
    device = parser.add_mutually_exclusive_group(required=True)
    device.add_argument("--port", metavar="PORT", help="a device that speaks the link")
    device.add_argument(
        "--simulate", action="store_true", help="a simulated device that presses from above"
    )
    add_haply_options(parser, device)
    parser.add_argument(
        "--baud",
        type=int,
        metavar="BITS",
        help="speed of the line, as the device has it; leave it out for USB of the device's own, "
        f"where it has no meaning (default: {BAUD})",
    )
    parser.add_argument(
        "--second-port",
        action="append",
        default=[],
        metavar="PORT",
        help="another device that speaks the link, which presses the same body; repeatable",
    )
    parser.add_argument(
        "--mode",
        choices=("consistent", "paper"),
        default="consistent",
        help="contact inside triangles: its point moves by exactly the finger's displacement "
        "(consistent, the default), or as in the paper",
    )
    add_shape(
        parser,
        ("real", "linear"),
        "by what the body presses back: the material's own law, found while it is pressed, or "
        "linear elasticity",
    )
    parser.add_argument(
        "--seconds",
        type=float,
        default=10.0,
        metavar="S",
        help="how long to run (default: %(default)g)",
    )
    parser.add_argument(
        "--rate", type=int, default=1000, metavar="HZ", help="ticks a second (default: %(default)s)"
    )
    add_check_timing(parser)
    add_young(parser)
    add_floor(parser)
    parser.add_argument(
        "--record", type=Path, metavar="FILE", help="write every tick to FILE.csv or FILE.npz"
    )


def run(arguments: argparse.Namespace) -> int:
    """Load, connect, touch for some seconds, report."""
    check_baud(arguments.baud)
    if not 0.0 < arguments.seconds < math.inf:
        raise PalpateError("--seconds: the time must be more than 0 s and have an end")
    if arguments.record is not None:
        _check_recording(arguments.record, arguments.seconds)
    others: list[str] = arguments.second_port
    laid = _laid(arguments, 1 + len(others))
    body, tools = laid.body, laid.tools
    young_modulus = modulus_of(arguments, body)
    with ExitStack() as stack:
        simulated = None
        port = arguments.haply if arguments.port is None else arguments.port
        if arguments.simulate:
            tool = tools[0] if tools else None
            hand = press_from_above(body, young_modulus, laid.placement, tool)
            simulated = stack.enter_context(SimulatedDevice(hand))
            port = simulated.port
        _check_ports([port, *others])
        stopped = stack.enter_context(stopped_by_signals())
        settings = Settings(young_modulus, mode=arguments.mode)
        made = shape(body, shape_of(arguments))
        stack.callback(made.close)
        made.wait_for(np.zeros(0, dtype=np.int64))
        servo = servo_on(laid.native, settings, rate_hz=arguments.rate, prop=laid.prop)
        laid.equip(servo)
        firming = Firming(servo, body)
        stack.callback(firming.close)
        stack.callback(servo.stop)
        _add_fingers(servo, others, arguments.baud)
        if arguments.record is not None:
            _start_recording(servo, arguments.record, arguments.seconds)
        if arguments.haply is not None:
            _, at, _ = highest_place(body)
            connect_haply(servo, arguments, vector(laid.placement.to_world(at)), stopped)
        else:
            _connect(servo, port, arguments.baud, stopped)
        for finger, other in enumerate(others, start=1):
            _await_greeting(servo, finger, other, stopped)

        def follow() -> None:
            firming.follow(servo.snapshot(), made, young_modulus)

        report = _touch(servo, port, arguments.seconds, stopped, follow)
        if simulated is not None:
            report["simulated_device"] = simulated.stop()
        report["young_modulus"] = young_modulus
        try:
            if arguments.record is not None:
                report["recording"] = _write_recording(arguments.record, servo)
        finally:
            # The report survives a file that cannot be written.
            print(json.dumps(report) if arguments.json else for_people(report))
    return 0


def _laid(arguments: argparse.Namespace, fingers: int) -> LaidBody:
    if is_scene(arguments.body):
        return laid_scene(arguments, fingers)
    body = body_file.load(arguments.body)
    return laid_body(arguments, body, modulus_of(arguments, body), whole=fingers > 1)


def _check_recording(path: Path, seconds: float) -> None:
    check_recording_path(path)
    if seconds + HELLO_SECONDS > LONGEST_RECORDING_SECONDS:
        longest = LONGEST_RECORDING_SECONDS - HELLO_SECONDS
        raise PalpateError(f"--record: a recording ends after {longest:g} s; give fewer --seconds")


def _start_recording(servo: Servo, path: Path, seconds: float) -> None:
    most_bytes = servo.start_recording(seconds + HELLO_SECONDS)
    # Checked before the session: a full disk would show only after it.
    check_room(path, most_bytes)
    sys.stderr.write(f"recording; takes up to {most_bytes / 1e6:.0f} MB of memory\n")


def _write_recording(path: Path, servo: Servo) -> dict[str, object]:
    samples = servo.recording()
    write_recording(path, samples, STATES, servo.counters()["rate_hz"])
    ticks = len(np.unique(samples["tick"]))
    return {"file": str(path), "ticks": ticks, "lost": servo.recording_lost}


def _connect(servo: Servo, port: str, baud: int | None, stopped: Sequence[int]) -> None:
    try:
        servo.start(LinkDevice(port, baud=baud))
    except OSError as error:
        raise PalpateError(str(error)) from error
    _await_greeting(servo, 0, port, stopped)


def _check_ports(ports: Sequence[str]) -> None:
    for port in ports:
        if not port.strip():
            raise PalpateError("--port: its name is empty; see 'palpate devices' for names")
        check_port(port)
    if len(set(ports)) < len(ports):
        raise PalpateError("--second-port: a port is named twice; give each device its own")


def _add_fingers(servo: Servo, ports: Sequence[str], baud: int | None) -> None:
    for port in ports:
        try:
            servo.add(LinkDevice(port, baud=baud))
        except (OSError, ValueError) as error:
            raise PalpateError(f"--second-port: {error}") from error


def _await_greeting(servo: Servo, finger: int, port: str, stopped: Sequence[int]) -> None:
    def counters() -> FingerCounters:
        return servo.counters()["fingers"][finger]

    deadline = time.monotonic() + HELLO_SECONDS
    while counters()["link"]["device"] is None and not stopped:
        if counters()["faults"]["wrong protocol"]:
            break
        if time.monotonic() > deadline:
            raise PortError(
                port,
                f"does not answer HELLO within {HELLO_SECONDS:g} s; check that it is a haptic "
                "device that speaks Palpate's link",
            )
        time.sleep(LOOK_EVERY_SECONDS)
    if counters()["faults"]["wrong protocol"]:
        raise PortError(
            port,
            "speaks another version of the link than this Palpate; update the older of the two",
        )


def _touch(
    servo: Servo,
    port: str,
    seconds: float,
    stopped: Sequence[int],
    follow: Callable[[], None],
) -> dict[str, Any]:
    felt = Felt()
    begin = time.monotonic()
    while not stopped and time.monotonic() < begin + seconds and servo.running:
        time.sleep(LOOK_EVERY_SECONDS)
        follow()
        felt.take(servo.samples())
    last = servo.snapshot()
    servo.stop()
    felt.take(servo.samples())
    return {
        **servo_report(felt, last, servo.counters(), port),
        "seconds": time.monotonic() - begin,
        "interrupted": bool(stopped),
    }
