"""A file that somebody has open for a moment is waited for, one that stays open is told."""

import pytest

from palpate.core.files.windows.patience import PAUSES, patiently, remove_file, remove_folder


class Refusing:
    """Refuses so many times, as Windows does while a scanner reads."""

    def __init__(self, times, kind=PermissionError):
        self.times, self.kind, self.calls = times, kind, 0

    def __call__(self):
        self.calls += 1
        if self.calls <= self.times:
            raise self.kind


@pytest.mark.parametrize("times", [0, 1, len(PAUSES)])
def test_a_refusal_that_passes_is_waited_for(times):
    action, slept = Refusing(times), []
    patiently(action, slept.append)
    assert action.calls == times + 1
    assert slept == list(PAUSES[:times])


def test_a_refusal_that_stays_is_raised():
    action = Refusing(1000)
    with pytest.raises(PermissionError):
        patiently(action, lambda _: None)
    assert action.calls == len(PAUSES) + 1


def test_other_errors_are_not_waited_for():
    action, slept = Refusing(1, FileNotFoundError), []
    with pytest.raises(FileNotFoundError):
        patiently(action, slept.append)
    assert slept == []


def test_what_is_not_there_needs_no_removal(tmp_path):
    remove_file(tmp_path / "nothing")
    remove_folder(tmp_path / "nothing")
