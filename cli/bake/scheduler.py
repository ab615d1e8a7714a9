"""Dask cluster as the workers of ``palpate bake --scheduler``."""

from __future__ import annotations

import importlib.metadata
import ipaddress
import logging
import secrets
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.bake.many import always
from ...core.errors import PalpateError
from ...core.files.small_text import json_value, read_small_text

if TYPE_CHECKING:
    from distributed import Client

CONNECT_SECONDS = 10
# Of a scheduler file.
MOST_FILE_BYTES = 10_000_000


@dataclass(frozen=True)
class StillWanted:
    """Callable within a task of the cluster: whether its results are still wanted.

    ``event`` is the name of a cluster-wide event, set once they are not.
    """

    event: str

    def __call__(self) -> bool:
        """Ask the scheduler."""
        from distributed import Event

        return not Event(self.event).is_set()


@dataclass(frozen=True)
class Workers:
    """Workers for bakes.

    Attributes
    ----------
    executor : of the tasks.
    count : tasks at once.
    threads : of BLAS for each task, unless the user gives another number.
    wanted : called by remote workers: whether their results are still wanted.
    """

    executor: Executor
    count: int
    threads: int = 1
    wanted: Callable[[], bool] = always


@contextmanager
def cluster(address: str) -> Iterator[Workers]:
    """Workers of the cluster whose scheduler is at ``address``, or described in a scheduler file,
    all with this version of Palpate. They already have their share of the machine's cores.

    Raises
    ------
    PalpateError
        Dask is not installed, nothing answers, there are no workers, or they have no Palpate or
        another one.
    """
    with _connected(address) as client:
        _warn_if_open(client)
        _refuse_other_palpates(client, address)
        from distributed import Event

        stop = Event(f"palpate-stop-{secrets.token_hex(8)}", client=client)
        try:
            yield Workers(
                # Not pure: else Dask would hash every mesh to find equal tasks.
                client.get_executor(pure=False),
                sum(client.nthreads().values()),
                wanted=StillWanted(stop.name),
            )
        except BaseException:
            # A cluster that is gone needs no notice.
            with suppress(OSError):
                stop.set()
            raise


@contextmanager
def _connected(address: str) -> Iterator[Client]:
    try:
        from distributed import Client
    except ImportError as missing:
        raise PalpateError(
            "--scheduler: Dask is not installed here; install it with "
            "'pip install palpate[scheduler]'"
        ) from missing
    # Connection errors are reported here, in one line.
    for name in list(logging.root.manager.loggerDict):
        if name.split(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)
    where = _address_in(Path(address)) if Path(address).is_file() else address
    try:
        client = Client(where, timeout=CONNECT_SECONDS)
    except (OSError, ValueError) as problem:
        reason = str(problem) or type(problem).__name__
        raise PalpateError(
            f"--scheduler: nothing answers at {address} ({reason}); "
            "start 'dask scheduler' and workers, and give the address it prints"
        ) from problem
    with client:
        try:
            client.wait_for_workers(1, timeout=CONNECT_SECONDS)
        except TimeoutError as problem:
            raise PalpateError(
                f"--scheduler: {address} has no workers; start some with 'dask worker {address}'"
            ) from problem
        yield client


def _address_in(file: Path) -> str:
    """Address in a scheduler file, as ``dask scheduler --scheduler-file`` writes it."""
    try:
        address = json_value(read_small_text(file, MOST_FILE_BYTES))["address"]
    except (ValueError, LookupError, TypeError) as problem:
        raise PalpateError(
            f"--scheduler: {file} is no scheduler file; give the one that "
            "'dask scheduler --scheduler-file' wrote, or the address it prints"
        ) from problem
    return str(address)


def _warn_if_open(client: Client) -> None:
    """Say who may run programs, where a network reaches the scheduler or its workers."""
    told = client.scheduler_info(n_workers=-1)
    for address in (told["address"], *told["workers"]):
        if is_open(address):
            print(
                f"palpate: warning: --scheduler: {address} can be reached from the network, and "
                "whoever reaches it can run any program there; start it with --host 127.0.0.1, on "
                "a closed network, or with TLS (docs/farm.md)",
                file=sys.stderr,
            )
            return


def is_open(address: str) -> bool:
    """Whether more than this computer reaches ``protocol://host:port`` without a certificate."""
    protocol, _, place = address.rpartition("://")
    host = place.rpartition(":")[0].strip("[]")
    if protocol in {"tls", "wss", "inproc"} or host == "localhost":
        return False
    try:
        return not ipaddress.ip_address(host).is_loopback
    except ValueError:
        # A name: what it stands for elsewhere is not known here.
        return True


def _refuse_other_palpates(client: Client, address: str) -> None:
    ours = installed_version()
    theirs = client.run(installed_version, on_error="return")
    for worker, version in theirs.items():
        if isinstance(version, BaseException):
            raise PalpateError(
                f"--scheduler: the worker {worker} cannot load Palpate ({version}); install "
                f"palpate {ours} where the workers of {address} run"
            )
        if version != ours:
            raise PalpateError(
                f"--scheduler: the worker {worker} has palpate {version}, and this is {ours}; "
                "install the same on both sides"
            )


def installed_version() -> str:
    """Version of Palpate on the machine of the call."""
    return importlib.metadata.version("palpate")
