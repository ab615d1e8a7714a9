"""A stand-in for RealtimeKit on a private bus: ``python realtime_kit.py grant|nice|refuse|silent``.

It grants as the real one does: only to a process whose RLIMIT_RTTIME is low enough, with the
scheduler's own calls, so it needs the right to. It says "ready" when it may be asked.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from jeepney import HeaderFields, MessageType, new_error, new_method_return
from jeepney.bus_messages import message_bus
from jeepney.io.blocking import DBusConnection, open_dbus_connection

if TYPE_CHECKING:
    from jeepney.low_level import Message

NAME = "org.freedesktop.RealtimeKit1"
PROPERTIES = {
    "MaxRealtimePriority": ("i", 7),
    "MinNiceLevel": ("i", -15),
    "RTTimeUSecMax": ("x", 150_000),
}


def rttime_limits(pid: int) -> tuple[str, str]:
    """Soft and hard limit of a process, us, as /proc has them."""
    for line in Path(f"/proc/{pid}/limits").read_text().splitlines():
        if line.startswith("Max realtime timeout"):
            soft, hard = line.split()[3:5]
            return soft, hard
    raise RuntimeError("the kernel tells no limit")


def caller(bus: DBusConnection, message: Message) -> int:
    """The process that sent a message."""
    sender = message.header.fields[HeaderFields.sender]
    reply = bus.send_and_get_reply(message_bus.GetConnectionUnixProcessID(sender))
    return int(reply.body[0])


def refusal(message: Message, words: str) -> Message:
    """An error as D-Bus services send them."""
    return new_error(message, "org.freedesktop.DBus.Error.AccessDenied", "s", (words,))


def answer(bus: DBusConnection, message: Message, mode: str) -> Message:
    """What the service says to one call."""
    member = message.header.fields[HeaderFields.member]
    if member == "Get":
        return new_method_return(message, "v", (PROPERTIES[message.body[1]],))
    pid = caller(bus, message)
    thread, level = message.body
    if not Path(f"/proc/{pid}/task/{thread}").exists():
        return refusal(message, "no thread of yours")
    if member == "MakeThreadRealtime" and mode == "grant":
        hard = rttime_limits(pid)[1]
        if hard == "unlimited" or int(hard) > PROPERTIES["RTTimeUSecMax"][1]:
            return refusal(message, "RLIMIT_RTTIME is too high")
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(thread, policy, os.sched_param(level))
    elif member == "MakeThreadHighPriority" and mode == "nice":
        os.setpriority(os.PRIO_PROCESS, thread, level)
    else:
        return refusal(message, "not today")
    return new_method_return(message)


def main() -> None:
    """Serve until the bus ends."""
    mode = sys.argv[1]
    bus = open_dbus_connection("SYSTEM")
    bus.send_and_get_reply(message_bus.RequestName(NAME))
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    while True:
        message = bus.receive()
        if message.header.message_type is MessageType.method_call and mode != "silent":
            bus.send(answer(bus, message, mode))


if __name__ == "__main__":
    main()
