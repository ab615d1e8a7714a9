"""Workers stop when their results are no longer wanted, also where a file being read cannot go."""

import contextlib
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from palpate.core.bake.lease import lease
from palpate.core.files.windows import patience


def test_a_lease_is_seen_while_it_is_held(tmp_path):
    with lease(tmp_path) as sign:
        assert sign.is_seen()
    assert not sign.is_seen()
    assert list(tmp_path.iterdir()) == []


def test_workers_stop_though_the_lease_cannot_be_removed(tmp_path, monkeypatch):
    def refused(path, missing_ok=False):
        raise PermissionError(13, "a worker reads it", str(path))

    monkeypatch.setattr(patience, "PAUSES", ())
    with contextlib.suppress(PermissionError), lease(tmp_path) as sign:
        monkeypatch.setattr(Path, "unlink", refused)
        assert sign.is_seen()
    assert sign.path.exists()
    assert not sign.is_seen()


def test_a_lease_that_workers_read_all_the_time_goes(tmp_path):
    with ThreadPoolExecutor(4) as readers:
        for _ in range(20):
            done = threading.Event()
            with lease(tmp_path) as sign:
                looks = [readers.submit(_look_until, done, sign) for _ in range(4)]
                assert sign.is_seen()
                threading.Timer(0.05, done.set).start()
            assert not sign.path.exists()
            assert all(look.result() is None for look in looks)


def _look_until(done, sign):
    while not done.is_set():
        sign.is_seen()
