"""What the compiler is told for each system."""

from __future__ import annotations

from pathlib import Path

import pytest
from package_all import sums, table
from platforms import PLATFORMS
from servo_wheel import apple_stubs, elf
from servo_wheel.compiling import command, settings
from servo_wheel.target import TARGETS

REPOSITORY = Path("/somewhere/checkout")


def told(platform, work, home="/somebody/.cargo"):
    return dict(settings(TARGETS[platform], REPOSITORY, work, {"CARGO_HOME": home}))


def test_every_platform_has_a_target_whose_wheels_it_takes():
    assert set(TARGETS) == set(PLATFORMS)
    for name, target in TARGETS.items():
        wheel = f"palpate_servo-0.1.0-cp311-abi3-{target.tag}.whl"
        assert [other for other, one in PLATFORMS.items() if one.runs(wheel)] == [name]


def test_no_path_of_the_machine_goes_into_the_image(tmp_path):
    variables = told("linux-x64", tmp_path)
    for flags, separator in (("CARGO_ENCODED_RUSTFLAGS", "\x1f"), ("TARGET_CFLAGS", " ")):
        mapped = [flag.split("=", 1)[1] for flag in variables[flags].split(separator)]
        assert mapped == [
            "/somebody/.cargo=/cargo",
            "/somewhere/checkout=/palpate",
            f"{tmp_path}=/target",
        ]


def test_only_macos_gets_stubs_of_frameworks(tmp_path):
    assert "apple-frameworks" not in told("windows-x64", tmp_path)["CARGO_ENCODED_RUSTFLAGS"]
    assert "MACOSX_DEPLOYMENT_TARGET" not in told("linux-x64", tmp_path)
    assert told("macos-arm64", tmp_path)["MACOSX_DEPLOYMENT_TARGET"] == "11.0"
    for name in apple_stubs.FRAMEWORKS:
        stub = tmp_path / "apple-frameworks" / f"{name}.framework" / f"{name}.tbd"
        assert f"Frameworks/{name}.framework" in stub.read_text(encoding="utf-8")


@pytest.mark.parametrize("platform", ["linux-x64", "linux-arm64"])
def test_linux_is_compiled_for_the_glibc_of_blender(platform):
    call = command(TARGETS[platform], REPOSITORY, Path("out"), "python")
    assert call[call.index("--compatibility") + 1] == "manylinux_2_28"


def test_a_newer_glibc_than_the_tag_says_is_found():
    assert elf.minor("manylinux_2_34_x86_64") > elf.minor("manylinux_2_28_x86_64")
    assert elf.minor("linux_x86_64") > elf.minor("manylinux_2_28_x86_64")


def test_packages_are_told_in_a_table_and_by_their_digests(tmp_path):
    assert table([("a", "bc"), ("def", "g")]) == "a    bc\ndef  g"
    (tmp_path / "b.zip").write_bytes(b"")
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    assert sums([tmp_path / "b.zip"]) == f"{empty}  b.zip\n"
