"""The firmware compiled for this machine, and programs that are talked to line by line."""

from __future__ import annotations

import os
import select
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Self

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

REPOSITORY = Path(__file__).resolve().parents[2]
FIRMWARE = REPOSITORY / "firmware"
HERE = Path(__file__).resolve().parent
LIBRARY = FIRMWARE / "palpate_link" / "src"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")


class Compiler:
    """The system's C++ compiler, with sanitizers where a program made with them runs."""

    def __init__(self, program: str, folder: Path) -> None:
        self.program = program
        self.folder = folder
        self.sanitizers: Sequence[str] = ()
        if self._runs_sanitized():
            self.sanitizers = SANITIZERS

    def command(self, sources: Sequence[Path], *options: str, standard: str = "c++17") -> list[str]:
        return [
            self.program,
            f"-std={standard}",
            *WARNINGS,
            f"-I{LIBRARY}",
            *options,
            *map(str, sources),
        ]

    def run(self, command: Sequence[str]) -> None:
        done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
        if done.returncode:
            pytest.fail(f"{' '.join(command)}\n{done.stderr}")

    def build(self, name: str, sources: Sequence[Path], *options: str) -> Path:
        program = self.folder / name
        self.run(self.command(sources, "-O1", "-g", *self.sanitizers, *options, f"-o{program}"))
        return program

    def _runs_sanitized(self) -> bool:
        source, program = self.folder / "empty.cpp", self.folder / "empty"
        source.write_text("int main() {}\n")
        command = [self.program, *SANITIZERS, str(source), f"-o{program}"]
        return all(
            subprocess.run(step, capture_output=True, timeout=60, check=False).returncode == 0
            for step in (command, [str(program)])
        )


class Talk:
    """A program that answers lines by lines. It ends with the `with` block."""

    def __init__(self, program: Path, *arguments: str) -> None:
        self._process = subprocess.Popen(
            [str(program), *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            bufsize=0,
        )
        self._unread = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        _, complaints = self._process.communicate(timeout=20)
        # A sanitizer that found something must not go by unnoticed.
        assert (self._process.returncode, complaints) == (0, b"")

    def tell(self, line: str) -> None:
        self._process.stdin.write(line.encode() + b"\n")

    def answer(self) -> str:
        descriptor = self._process.stdout.fileno()
        while b"\n" not in self._unread:
            if not select.select([descriptor], [], [], 20.0)[0]:
                pytest.fail("the program has not answered for 20 s")
            piece = os.read(descriptor, 1 << 16)
            if not piece:
                pytest.fail(f"the program has ended: {self._process.stderr.read().decode()}")
            self._unread += piece
        line, self._unread = self._unread.split(b"\n", 1)
        return line.decode()

    def ask(self, line: str) -> str:
        self.tell(line)
        return self.answer()


@pytest.fixture(scope="session")
def compiler(tmp_path_factory: pytest.TempPathFactory) -> Compiler:
    names = [os.environ.get("CXX", ""), "c++", "g++", "clang++"]
    program = next((found for name in names if name and (found := shutil.which(name))), None)
    if program is None:
        pytest.skip("no C++ compiler here (CXX, c++, g++, clang++)")
    return Compiler(program, tmp_path_factory.mktemp("firmware"))


@pytest.fixture(scope="session")
def checker_program(compiler: Compiler) -> Path:
    return compiler.build("checker", [HERE / "checker.cpp"])


@pytest.fixture
def checker(checker_program: Path) -> Iterator[Talk]:
    with Talk(checker_program) as talk:
        yield talk


@pytest.fixture(scope="session")
def board_program(compiler: Compiler) -> Path:
    if os.name != "posix":
        pytest.skip("needs pseudo-terminals")
    return compiler.build("board", [FIRMWARE / "host" / "main.cpp"])


@pytest.fixture(scope="session")
def sketch_program(compiler: Compiler) -> Path:
    """The sketch with its places filled in, as a maker would: the other files are untouched."""
    folder = compiler.folder / "filled_in"
    shutil.copytree(FIRMWARE / "palpate_device", folder)
    shutil.copytree(HERE / "filled_in", folder, dirs_exist_ok=True)
    arduino = HERE / "arduino"
    return compiler.build("sketch", [HERE / "sketch_runner.cpp"], f"-I{arduino}", f"-I{folder}")


@pytest.fixture(scope="session")
def start_talk() -> type[Talk]:
    return Talk
