"""The check of a release tells of every step, also after one that fails."""

import subprocess

import pytest
import release_check
from release_check import main, steps
from release_table import COLUMNS, cells_of, closing_line, verdict

LINT, CORE = "make lint", "make test-core"


@pytest.fixture
def ran(monkeypatch, tmp_path):
    """Commands that were run, of which lint fails; one part of the tests keeps a report."""
    commands = []
    monkeypatch.setattr(release_check, "REPORTS", tmp_path)
    monkeypatch.setattr(release_check, "commit", lambda: "a")
    (tmp_path / "lint.txt").write_text("of a run before\n")

    def run(command, **_):
        commands.append(" ".join(command))
        if command[-1] == "test-core":
            (tmp_path / "test-core.txt").write_text("...\n3000 passed in 100 s\n\n")
        return subprocess.CompletedProcess(command, int(command[-1] == "lint"))

    return commands, run


def words(out, beginning):
    """The words of the line that begins so, after its beginning."""
    (line,) = [line for line in out.splitlines() if line.startswith(beginning)]
    return line.removeprefix(beginning).replace("not yet", "not-yet").split()


def test_one_that_fails_is_told_and_the_others_still_run(ran, capsys):
    commands, run = ran
    assert main([LINT, CORE], run) == 1
    assert commands == [LINT, CORE]
    out = capsys.readouterr().out
    assert words(out, LINT) == ["failed", "0.0"]
    assert " ".join(words(out, CORE)) == "passed 0.0 3000 passed in 100 s"


def test_a_table_tells_of_every_system_and_blender(ran, capsys):
    _, run = ran
    main([CORE, "make package-all SYSTEMS=macos-x64"], run)
    out = capsys.readouterr().out
    core = COLUMNS.index("core")
    assert words(out, "linux-x64      4.5.15")[core] == "passed"
    assert words(out, "windows-x64    4.5.15")[core] == "not-yet"
    assert words(out, "macos-x64      4.5.15") == ["passed", *["cannot"] * 6]


def test_what_passed_is_not_run_again_until_something_changes(ran, capsys, monkeypatch):
    commands, run = ran
    main([LINT, CORE], run)
    commands.clear()
    assert main([], run) == 1
    assert LINT in commands
    assert CORE not in commands
    assert "3000 passed" in capsys.readouterr().out
    monkeypatch.setattr(release_check, "commit", lambda: "b")
    commands.clear()
    main([], run)
    assert CORE in commands


def test_two_calls_side_by_side_leave_each_other_what_they_found(ran, capsys):
    _, run = ran

    def beside(command, **_):
        main(["make test-servo"], run)
        return run(command)

    main([CORE], beside)
    capsys.readouterr()
    main([LINT], run)
    out = capsys.readouterr().out
    assert words(out, CORE)[0] == words(out, "make test-servo")[0] == "passed"


def test_nothing_holds_of_files_that_are_in_no_commit(ran, monkeypatch):
    commands, run = ran
    monkeypatch.setattr(release_check, "commit", lambda: "")
    main([CORE], run)
    main([], run)
    assert commands.count(CORE) == 2


def test_a_failure_speaks_only_against_what_it_is_of():
    cells = {cell.column: cell for cell in cells_of("linux-x64", ["installs", "add-on"], "5.2.3")}
    installs = cells_of("linux-x64", ["installs"], "5.2.3", "tests/addon/test_installation.py")[0]
    report = "FAILED tests/addon/stroke/test_a.py::test_b - Error\n1 failed, 700 passed in 9 s\n"
    assert verdict("failed", installs, report) == "passed"
    assert verdict("failed", cells["add-on"], report) == "failed"
    assert verdict("failed", installs, "no package\n") == "failed"
    own = "ERROR tests/addon/test_installation.py::test_c\n1 error, 700 passed in 9 s\n"
    assert verdict("failed", installs, own) == "failed"


def test_of_cargo_all_programs_are_told():
    line = "test result: {}. {} passed; {} failed; 1 ignored; 0 measured\n"
    report = line.format("ok", 85, 0) + line.format("FAILED", 19, 2) + "Doc-tests palpate_servo\n"
    assert closing_line(report) == "104 passed, 2 failed"
    assert closing_line("...\n3000 passed in 100 s\n\n") == "3000 passed in 100 s"
    of_blender = "2 failed, 776 passed in 17.3s (0:00:17)\nError: Not freed memory blocks: 60\n"
    assert closing_line(of_blender) == "2 failed, 776 passed in 17.3s (0:00:17)"


def test_what_cannot_be_run_is_no_failure_and_is_not_run(ran, capsys, monkeypatch):
    commands, run = ran
    monkeypatch.setattr(release_check.os, "geteuid", lambda: 1000, raising=False)
    assert main(["make test-windows-native"], run) == 0
    assert commands == []
    assert "needs root" in capsys.readouterr().out


def test_every_step_is_a_target_that_there_is():
    makefile = (release_check.REPOSITORY / "Makefile").read_text(encoding="utf-8")
    for step in steps():
        of_a_blender = step.name.startswith(
            ("make test-addon-", "make test-windows-addon-", "make demo-windows-")
        )
        if step.command[0] == "make" and not of_a_blender:
            assert f"\n{step.command[1]}:" in makefile, step.name
