"""A hostile host at a device: what the device makes of it, judged by docs/link.md."""

from __future__ import annotations

import contextlib
import itertools
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from random import Random

import serial

from ....core.errors import PalpateError
from ....core.servo import link
from ....core.servo.ports import check_port
from ..table import Row, Table, counted, is_chosen
from .conversation import FORCE_EVERY, TIMES, Conversation
from .hostile_words import ATTACKS, Attack

LIMP, OTHER_PROTOCOL = 1, 2
SILENCE_MS = 20.0
DRIVE_SECONDS = 0.03
ATTACK_SECONDS = (0.1, 0.15)
"""Longer than 20 ms, and than computers and lines take."""
GRACE_SECONDS = 0.06
FOREIGN_SECONDS = 0.05
HELD_UP_SECONDS = 0.012
"""Who falls silent or deaf for longer cannot blame the device."""
HELD_UP = "this computer, the line or the device was held up: not judged"
TRIES = 20
FOREIGN = "HELLO of another protocol"


@dataclass(frozen=True)
class HostAttack:
    """How a device at a port is attacked."""

    path: str
    times: int = 20
    seed: int = 1
    largest_force: float = 0.2
    """Asked for at the most, N."""
    only: tuple[str, ...] = ()
    """Parts of injections' names."""
    allowance_ms: float = 10.0
    """For the line and this computer, beside two STATE."""
    baud: int = 115200


@contextlib.contextmanager
def _opened(attack: HostAttack) -> Iterator[serial.Serial]:
    check_port(attack.path)
    try:
        with serial.Serial(
            attack.path, attack.baud, timeout=0, write_timeout=1.0, exclusive=True
        ) as port:
            yield port
    except serial.SerialException as error:
        raise PalpateError(
            "{port}: it failed while it was attacked ({reason}); plug the device in again",
            port=attack.path,
            reason=str(error),
        ) from error


def host_table(attack: HostAttack, say: Callable[[str], None]) -> Table:
    """Attack the device at the port; a row for each kind.

    Raises PalpateError when the port cannot be used or nothing answers.
    """
    with _opened(attack) as port:
        talk = Conversation(port, round(attack.largest_force * 1e3), Random())  # noqa: S311
        return table_of(talk, attack, say)


def table_of(talk: Conversation, attack: HostAttack, say: Callable[[str], None]) -> Table:
    """Attack the device that one talks with, as `host_table`; `attack.path` is not used."""
    hello = talk.greet()
    name, protocol = hello.name, hello.protocol
    rows = []
    try:
        for one in ATTACKS:
            if not is_chosen(one.name, attack.only) or (one.only_second and not talk.is_second):
                continue
            say(f"{name}: {one.name}")
            rows.append(_row(talk, attack, one))
        if is_chosen(FOREIGN, attack.only):
            say(f"{name}: {FOREIGN}")
            rows.append(_foreign_row(talk, attack))
    finally:
        _let_go(talk)
    title = f"A hostile host at {name!r}, which speaks protocol {protocol}"
    return Table(title, tuple(rows))


def _let_go(talk: Conversation) -> None:
    with contextlib.suppress(serial.SerialException):
        for _ in range(3):
            talk.sequence = (talk.sequence + 1) % link.SEQUENCES
            talk.say(b"\0" + link.encode(link.Force(talk.sequence, (0, 0, 0), 0, _answer(talk))))
            talk.listen(FORCE_EVERY)


def _answer(talk: Conversation) -> link.Answer | None:
    return link.Answer(talk.device_time) if talk.is_second else None


def _row(talk: Conversation, attack: HostAttack, one: Attack) -> Row:
    broken: Counter[str] = Counter()
    told: Counter[str] = Counter()
    slowest = 0.0
    for number in range(attack.times):
        for _ in range(TRIES):
            talk.dice = Random(f"{attack.seed} {one.name} {number}")  # noqa: S311 - no secrets
            found, limp_ms = _try(talk, one, attack.allowance_ms)
            if talk.longest_pause < HELD_UP_SECONDS:
                break
        else:
            found = [HELD_UP]
        broken.update(found)
        told.update(f"FAULT {fault.code}" for fault, _ in talk.faults)
        slowest = max(slowest, limp_ms)
    return Row(
        injected=one.name,
        times=attack.times,
        told=next((name for name, _ in told.most_common(1)), "STATE"),
        zero_ms=slowest or None,
        broken=counted(broken),
    )


def _try(talk: Conversation, one: Attack, allowance_ms: float) -> tuple[list[str], float]:
    """Drive, attack, and let the device go limp; what it did wrong, and when it went, ms."""
    talk.greet()
    talk.longest_pause = 0.0
    talk.drive(DRIVE_SECONDS)
    talk.forget()
    said = _say_for(talk, one)
    while_attacked = [fault.code for fault, _ in talk.faults]
    talk.listen(GRACE_SECONDS)
    found = [] if talk.states[1:] else ["no STATE any more"]
    steps = {
        (after.sequence - before.sequence) % link.SEQUENCES
        for before, after in itertools.pairwise(talk.states)
    }
    if steps - {1}:
        found.append("STATE lost or repeated")
    if one.is_heard and while_attacked:
        found.append("limp although it was driven")
    if not one.is_heard and LIMP not in while_attacked:
        found.append("heard what must not count as heard")
    limp = [place for fault, place in talk.faults if fault.code == LIMP]
    if len(limp) > 1 and not one.heard_when_limp:
        found.append("limp is said more than once")
    if not limp:
        found.append("limp is not said")
        return found + _obeys_problems(talk), 0.0
    then = talk.states[min(limp[0], len(talk.states) - 1)]
    # Before that, if this computer was held up.
    limp_ms = ((then.device_time_us - said + TIMES // 2) % TIMES - TIMES // 2) * 1e-3
    period_ms = 1e3 / talk.hello.rate_hz if talk.hello and talk.hello.rate_hz else 1.0
    if limp_ms > SILENCE_MS + 2.0 * period_ms + allowance_ms:
        found.append("limp too late")
    return found + _obeys_problems(talk), limp_ms


def _say_for(talk: Conversation, one: Attack) -> int:
    """Say hostile words for a while; the device's time when what it may hear was said last."""
    said = talk.drive(FORCE_EVERY)
    for _ in range(int(talk.dice.uniform(*ATTACK_SECONDS) / FORCE_EVERY)):
        words = one.words(talk)
        if one.is_heard:
            said = talk.device_time
        talk.say(words)
        talk.listen(FORCE_EVERY)
    return said


def _obeys_problems(talk: Conversation) -> list[str]:
    """Whether the next sound FORCE is obeyed whatever its number: it ends with limpness again."""
    pause = talk.longest_pause
    talk.say(b"\0")
    talk.longest_pause = pause
    talk.sequence = talk.dice.randrange(link.SEQUENCES)
    talk.forget()
    talk.drive(DRIVE_SECONDS)
    if talk.is_second and talk.states[-1].taken is None:
        return ["it forgets its protocol"]
    talk.listen(GRACE_SECONDS, lambda: bool(talk.faults))
    codes = [fault.code for fault, _ in talk.faults]
    return [] if codes == [LIMP] else ["it does not obey again"]


def _foreign_row(talk: Conversation, attack: HostAttack) -> Row:
    """HELLO of another protocol: it is named, nothing streams, no FORCE is obeyed; then ours."""
    broken: Counter[str] = Counter()
    for number in range(attack.times):
        talk.dice = Random(f"{attack.seed} foreign {number}")  # noqa: S311 - as above
        broken.update(_foreign_problems(talk))
    talk.greet()
    return Row(
        injected=FOREIGN,
        times=attack.times,
        told=f"FAULT {OTHER_PROTOCOL}",
        broken=counted(broken),
    )


def _foreign_problems(talk: Conversation) -> list[str]:
    talk.greet()
    talk.drive(DRIVE_SECONDS)
    talk.forget()
    protocol = talk.dice.randint(link.PROTOCOL + 1, 255)
    named = talk.hello
    talk.hello = None
    talk.say(link.frame(bytes([1, protocol])))
    talk.listen(GRACE_SECONDS, lambda: bool(talk.faults))
    found = [] if talk.is_greeted() else ["it does not name itself"]
    talk.hello = named
    if [fault for fault, _ in talk.faults] != [link.Fault(OTHER_PROTOCOL, protocol)]:
        found.append("FAULT 2 is not said")
    talk.listen(FORCE_EVERY)
    talk.forget()
    heard = len(talk.states)
    talk.say(talk.force())
    talk.listen(FOREIGN_SECONDS)
    if len(talk.states) > heard:
        found.append("STATE for a host that cannot read it")
    if talk.faults:
        found.append("FORCE of a foreign host obeyed")
    return found
