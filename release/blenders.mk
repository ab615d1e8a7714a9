# The Blenders that packages are made for and tested in, for make and for release/blenders.py: their
# version (of bpy, as far as there is one), their Python, and the systems that they exist for.
# Official builds for Linux on ARM do not exist; distributions make them.

BLENDERS := 4.5.15 5.0.1 5.2.3

PYTHON_OF_4.5.15 := 3.11
PYTHON_OF_5.0.1 := 3.11
PYTHON_OF_5.2.3 := 3.13

# 5.0 ended the builds for Intel Macs.
SYSTEMS_OF_4.5.15 := linux-x64 linux-arm64 windows-x64 windows-arm64 macos-arm64 macos-x64
SYSTEMS_OF_5.0.1 := linux-x64 linux-arm64 windows-x64 windows-arm64 macos-arm64
SYSTEMS_OF_5.2.3 := linux-x64 linux-arm64 windows-x64 windows-arm64 macos-arm64
