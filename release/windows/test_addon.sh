#!/usr/bin/env bash
# The package for Windows installed in Blender as a module, under wine:
# `test_addon.sh ROOT PACKAGE.zip NUMBER BPY [PYTEST ARGUMENTS...]`, such as 313 and 5.2.3.
set -euo pipefail
root=$(realpath "$1") package=$(realpath "$2") number=$3 bpy=$4
shift 4
here=$(dirname "$(realpath "$0")")
home=$root/windows/Python$number-bpy-$bpy
python=${PYTHON:-python3}

# Blender alone with pytest: what the extension imports must come from its own wheels.
if [ ! -d "$home/Lib/site-packages/hypothesis" ]; then
    rm -rf "$home"
    cp -a "$root/windows/Python$number" "$home"
    rm -rf "$home/Lib/site-packages"
    # bpy asks for its own Python, and pip looks at the one that it runs in.
    "$python" -m pip install --quiet --disable-pip-version-check --no-compile --only-binary=:all: \
        --platform win_amd64 --implementation cp --python-version "${number:0:1}.${number:1}" \
        --ignore-requires-python --target "$home/Lib/site-packages" "bpy==$bpy" pytest pytest-timeout hypothesis colorama
fi
mkdir -p "$root/windows/packages"
cp "$package" "$root/windows/packages/"
export PALPATE_PACKAGE="Z:\\windows\\packages\\$(basename "$package")"
# Without the checkout on the path, which `python -m pytest` would put there.
"$here/enter.sh" "$root" wine "/windows/$(basename "$home")/python.exe" -c \
    'import sys; sys.path = [p for p in sys.path if p]; import pytest; sys.exit(pytest.main(sys.argv[1:]))' \
    -q -p no:cacheprovider "$@"
