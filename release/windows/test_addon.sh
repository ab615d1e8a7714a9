#!/usr/bin/env bash
# The package for Windows installed in Blender as a module, under wine:
# `test_addon.sh ROOT PACKAGE.zip NUMBER BPY [PYTEST ARGUMENTS...]`, such as 313 and 5.2.3.
set -euo pipefail
root=$(realpath "$1") package=$(realpath "$2") number=$3 bpy=$4
shift 4
mkdir -p "$root/windows/packages"
cp "$package" "$root/windows/packages/"
export PALPATE_PACKAGE="Z:\\windows\\packages\\$(basename "$package")"
# Without the checkout on the path, which `python -m pytest` would put there.
"$(dirname "$(realpath "$0")")/blender_python.sh" "$root" "$number" "$bpy" -c \
    'import sys; sys.path = [p for p in sys.path if p]; import pytest; sys.exit(pytest.main(sys.argv[1:]))' \
    -q -p no:cacheprovider --timeout 900 "$@"
