"""Every module can be imported on Windows, which has no POSIX: that stands behind a check."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import importlib, pkgutil, signal, sys, types
import multiprocessing.connection, subprocess, tempfile, asyncio, concurrent.futures.process
import numpy, scipy.linalg.blas, scipy.optimize, scipy.sparse.linalg, scipy.spatial
import psutil, serial.tools.list_ports, threadpoolctl, trimesh, plyfile, palpate_servo

for name in ("fcntl", "termios", "tty", "pty", "resource", "pwd", "grp", "syslog"):
    sys.modules[name] = None
for name in ("_winapi", "msvcrt"):
    sys.modules[name] = types.ModuleType(name)
for name in ("SIGKILL", "SIGSTOP", "SIGCONT", "SIGQUIT", "SIGHUP"):
    delattr(signal, name)
sys.platform = "win32"

def modules(name):
    package = importlib.import_module(name)
    for found in pkgutil.walk_packages(package.__path__, name + "."):
        importlib.import_module(found.name)
        yield found.name

print(sum(1 for room in ("core", "simulated", "cli") for _ in modules("palpate." + room)))
"""
MODULES_AT_LEAST = 150


def test_every_module_is_imported_where_there_is_no_posix():
    done = subprocess.run([sys.executable, "-c", PROGRAM], check=False, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()
    assert int(done.stdout) > MODULES_AT_LEAST
