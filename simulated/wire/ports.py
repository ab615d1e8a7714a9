"""Choice of a simulated device's port."""

from __future__ import annotations

import sys
from pathlib import Path

from ...core.errors import PalpateError
from ...core.servo.socket_port import SCHEME, is_socket
from .device_port import DevicePort
from .local_socket import LocalSocket
from .pseudo_terminal import PseudoTerminal

RELEASE_AFTER_SECONDS = 0.5
ANY_SOCKET = f"{SCHEME}127.0.0.1:0"
HAS_PSEUDO_TERMINALS = sys.platform != "win32"


def device_port(link: str, release_after: float = RELEASE_AFTER_SECONDS) -> DevicePort:
    """Make a port: a socket if `link` names one, else a pseudo-terminal to which the path `link`
    leads, if there is one.

    Parameters
    ----------
    release_after : a host silent for so long is assumed gone, s; a socket is told.

    Raises
    ------
    PalpateError
        There cannot be such a port.
    """
    if is_socket(link) or not (link or HAS_PSEUDO_TERMINALS):
        return LocalSocket(link or ANY_SOCKET)
    if not HAS_PSEUDO_TERMINALS:
        raise PalpateError(
            "{link}: Windows has no links to ports; name a socket, such as {example}",
            link=link,
            example=ANY_SOCKET,
        )
    return PseudoTerminal(Path(link) if link else None, release_after)
