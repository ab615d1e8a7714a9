"""``palpate devices``: haptic devices on this computer, and a simulated one."""

from __future__ import annotations

import argparse
import dataclasses
import json

from ...core.servo.port_error import named
from ...core.servo.ports import BAUD, Port, check_baud, list_ports
from ...simulated import device_process
from ...simulated.hand.options import add_simulated_options, simulated_options
from . import attack

HELP = "list haptic devices, simulate one, or attack"
DESCRIPTION = "List the serial ports and the haptic devices that answer there."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "--port",
        nargs="+",
        action="extend",
        default=[],
        metavar="PATH",
        help="ask these ports too, whatever they are",
    )
    parser.add_argument(
        "--baud",
        type=int,
        default=BAUD,
        metavar="BITS",
        help="speed of the lines, as the devices have it (default: %(default)s)",
    )
    below = parser.add_subparsers(title="simulate and attack", metavar="COMMAND")
    simulate = below.add_parser(
        "simulate",
        help="be a device on a pseudo-terminal until Ctrl-C",
        description="Be a device on a pseudo-terminal, held by a hand that moves by itself.",
    )
    device_process.add_haply_option(simulate)
    add_simulated_options(simulate)
    simulate.add_argument(
        "--json", action="store_true", default=argparse.SUPPRESS, help="print as JSON lines"
    )
    simulate.set_defaults(run=run_simulate)
    hostile = below.add_parser("attack", help=attack.HELP, description=attack.DESCRIPTION)
    attack.add_options(hostile)
    hostile.add_argument(
        "--json", action="store_true", default=argparse.SUPPRESS, help="print the tables as JSON"
    )


def run(arguments: argparse.Namespace) -> int:
    """List all ports and their devices."""
    check_baud(arguments.baud)
    ports = list_ports(arguments.port, baud=arguments.baud)
    if arguments.json:
        print(json.dumps({"ports": [dataclasses.asdict(port) for port in ports]}))
        return 0
    if not ports:
        print("no serial ports; plug a device in, or try 'palpate devices simulate'")
    for port in ports:
        print(_line(port))
        if port.warning:
            print(f"  {port.warning}")
    return 0


def run_simulate(arguments: argparse.Namespace) -> int:
    """Simulate until stopped."""
    options = simulated_options(arguments)
    device_process.run(options, haply=arguments.haply, json_lines=arguments.json)
    return 0


def _line(port: Port) -> str:
    words = dict.fromkeys((port.vendor, port.product or port.description, port.usb_id))
    what = " ".join(word for word in words if word)
    answer = port.reason
    if port.hello is not None:
        hello = port.hello
        answer = f"{hello.name}: {hello.axes} axes, {hello.largest_force:g} N, {hello.rate_hz} Hz"
        if port.tells_orientation:
            answer += ", tells its orientation"
        if port.round_trip_ms is not None:
            answer += f", round trip {port.round_trip_ms:.1f} ms"
    return f"{named(port.path)}  {f'[{what}]  ' if what else ''}{answer}"
