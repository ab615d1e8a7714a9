"""Make the extension's package for one platform: the files Blender needs, with all wheels inside.

The real-time thread `palpate_servo` is compiled, so its wheel must be handed in; a package without
it would install and then not press, and is therefore refused:

    python release/build_extension.py --platform linux-x64 \
        --servo-wheel build/servo/palpate_servo-0.1.0-cp311-abi3-linux_x86_64.whl \
        --blender .venv-bpy-5.2.3 --output build/packages

Needs Babel, which reads the translations, pip, and a Blender (or bpy) for its extension tool.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import blender_tool
import bundled_libraries
import bundled_wheels
import reproducible_zip
import translations
from blenders import pythons_on
from bundled_wheels import PackagingError
from extension_files import extension_files
from package_check import faults, runs_on
from package_manifest import package_manifest
from platforms import PLATFORMS, Platform, this_platform

REPOSITORY = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Order:
    """What package is to be made.

    Attributes
    ----------
    pythons : versions such as `3.11`, for each of which wheels are bundled.
    blender : a folder that holds a Blender or a bpy module.
    name : file name of the package; empty for one of identity, version and platform.
    """

    platform: Platform
    pythons: tuple[str, ...]
    blender: Path
    output: Path = REPOSITORY / "build" / "packages"
    wheel_cache: Path = REPOSITORY / "build" / "wheels"
    name: str = ""


def package_of(order: Order, servo_wheel: Path | None) -> Path:
    """Make one package, and let Blender's own tool validate it.

    Raises
    ------
    PackagingError
        It cannot be whole.
    """
    servo = _servo_wheel(servo_wheel, order.platform, order.pythons)
    wheels = {
        path.name: path
        for version in order.pythons
        for path in bundled_wheels.fetch(order.platform, version, order.wheel_cache)
    }
    return _package(order, [*wheels.values(), servo])


def main(arguments: list[str] | None = None) -> int:
    """Make one package and print its path; return 2 with one message when it cannot be whole."""
    order, servo_wheel = _order(arguments)
    try:
        package = package_of(order, servo_wheel)
    except PackagingError as error:
        print(f"build_extension: {error}", file=sys.stderr)
        return 2
    print(f"{package} ({package.stat().st_size / 1e6:.1f} MB, Python {', '.join(order.pythons)})")
    if order.platform.without:
        absent = ", ".join(sorted(order.platform.without))
        print(f"  without {absent}: there are no wheels for {order.platform.name}")
    return 0


def _order(arguments: list[str] | None) -> tuple[Order, Path | None]:
    """The package that a command line asks for, and the wheel of the servo for it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--platform", choices=sorted(PLATFORMS), default=this_platform())
    parser.add_argument("--servo-wheel", type=Path, help="palpate_servo, built for that platform")
    parser.add_argument(
        "--blender", type=Path, required=True, help="a folder that holds a Blender or bpy module"
    )
    parser.add_argument("--output", type=Path, default=Order.output)
    parser.add_argument("--wheel-cache", type=Path, default=Order.wheel_cache)
    parser.add_argument(
        "--python",
        nargs="+",
        metavar="X.Y",
        help="Python versions to bundle wheels for (default: those of release/blenders.mk)",
    )
    parser.add_argument(
        "--name", default="", help="the package's file name (default: id-version-platform.zip)"
    )
    options = parser.parse_args(arguments)
    platform = PLATFORMS[options.platform]
    return Order(
        platform,
        tuple(options.python or pythons_on(platform.name)),
        options.blender,
        options.output,
        options.wheel_cache,
        options.name,
    ), options.servo_wheel


def _servo_wheel(path: Path | None, platform: Platform, python_versions: Sequence[str]) -> Path:
    if path is None:
        message = (
            f"no palpate_servo wheel for {platform.name} was given (--servo-wheel), and without it "
            "the extension cannot press: `make package-all` compiles it for every platform, "
            "maturin for the one it runs on"
        )
        raise PackagingError(message)
    if not path.is_file():
        message = f"{path} does not exist: build it with `maturin build --release`"
        raise PackagingError(message)
    unfit = [version for version in python_versions if not runs_on(path.name, version)]
    if not path.name.startswith("palpate_servo-") or not platform.runs(path.name) or unfit:
        message = f"{path.name} is not a palpate_servo wheel for {platform.name}"
        raise PackagingError(message)
    return path


def _package(order: Order, wheels: list[Path]) -> Path:
    """Stage the files, let Blender's tool pack and validate them, and read the result back."""
    source = (REPOSITORY / "blender_manifest.toml").read_text(encoding="utf-8")
    identity = tomllib.loads(source)
    platform = order.platform
    name = order.name or (
        f"{identity['id']}-{identity['version']}-{platform.name.replace('-', '_')}.zip"
    )
    package = order.output / name
    stage = order.output / "stage" / package.stem
    shutil.rmtree(stage, ignore_errors=True)
    for relative in extension_files(REPOSITORY):
        (stage / relative).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(REPOSITORY / relative, stage / relative)
    (stage / translations.PACKAGED).write_text(translations.compiled(), encoding="utf-8")
    (stage / "wheels").mkdir()
    for wheel in wheels:
        shutil.copyfile(wheel, stage / "wheels" / wheel.name)
    manifest = package_manifest(source, platform.name, [wheel.name for wheel in wheels])
    (stage / "blender_manifest.toml").write_text(manifest, encoding="utf-8")

    tool = blender_tool.find_tool(order.blender)
    blender_tool.build(tool, stage, package)
    shutil.rmtree(stage)
    reproducible_zip.settle(package)
    blender_tool.validate(tool, package)
    wrong = faults(package, platform, order.pythons) or bundled_libraries.faults(package, platform)
    if wrong:
        package.unlink()
        raise PackagingError("the package is not whole: " + "; ".join(wrong))
    return package


if __name__ == "__main__":
    raise SystemExit(main())
