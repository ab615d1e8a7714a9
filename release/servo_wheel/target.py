"""What `palpate_servo` is compiled for: a Rust target for each platform, and its oldest system."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Target:
    """One platform's way through the compiler.

    Attributes
    ----------
    platform : Blender's name for it.
    triple : Rust's name for it.
    tag : the platform tag of the wheel, which names the oldest system that it runs on.
    """

    platform: str
    triple: str
    tag: str

    @property
    def is_macos(self) -> bool:
        """Whether the image is a Mach-O one."""
        return self.tag.startswith("macosx")

    @property
    def is_linux(self) -> bool:
        """Whether the image is an ELF one."""
        return self.tag.startswith("manylinux")


# glibc 2.28 and macOS 11 are what Blender 4.5 asks for itself. Windows by zig's mingw: its import
# libraries are free, and its C runtime is that of Windows 10.
TARGETS = {
    target.platform: target
    for target in (
        Target("linux-x64", "x86_64-unknown-linux-gnu", "manylinux_2_28_x86_64"),
        Target("linux-arm64", "aarch64-unknown-linux-gnu", "manylinux_2_28_aarch64"),
        Target("windows-x64", "x86_64-pc-windows-gnu", "win_amd64"),
        Target("windows-arm64", "aarch64-pc-windows-gnullvm", "win_arm64"),
        Target("macos-arm64", "aarch64-apple-darwin", "macosx_11_0_arm64"),
        Target("macos-x64", "x86_64-apple-darwin", "macosx_11_0_x86_64"),
    )
}
MACOS_DEPLOYMENT_TARGET = "11.0"
