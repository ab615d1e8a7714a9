#!/usr/bin/env bash
# Blender as a module in Windows' Python, under wine:
# `blender_python.sh ROOT NUMBER BPY PYTHON'S ARGUMENTS...`, such as 313 and 5.2.3.
set -euo pipefail
root=$(realpath "$1") number=$2 bpy=$3
shift 3
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
exec "$(dirname "$(realpath "$0")")/enter.sh" "$root" wine "/windows/$(basename "$home")/python.exe" "$@"
