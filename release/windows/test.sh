#!/usr/bin/env bash
# Tests in Windows' Python under wine: `test.sh ROOT SERVO_WHEEL NUMBER [PYTEST ARGUMENTS...]`, in the
# repository. NUMBER is that of the Python, such as 313; the wheel is one with the harness.
set -euo pipefail
root=$(realpath "$1") wheel=$(realpath "$2") number=$3
shift 3
enter=$(dirname "$(realpath "$0")")/enter.sh
home=$root/windows/Python$number packages=$root/windows/Python$number/Lib/site-packages
python=${PYTHON:-python3}

install() { # PIP ARGUMENTS...
    "$python" -m pip install --quiet --disable-pip-version-check --no-compile --upgrade --only-binary=:all: \
        --platform win_amd64 --implementation cp --python-version "${number:0:1}.${number:1}" \
        --target "$packages" "$@" 2> >(grep -v 'as the .root. user' >&2 || true)
}

needed() { # what pyproject.toml asks for on Windows
    "$python" - <<'PYTHON'
import tomllib
from packaging.requirements import Requirement
WINDOWS = {"sys_platform": "win32", "os_name": "nt", "platform_system": "Windows", "platform_machine": "AMD64"}
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
extras = project["optional-dependencies"]
for line in [*project["dependencies"], *extras["test"], *extras["scheduler"], "colorama", "matplotlib"]:
    asked = Requirement(line)
    if not asked.name.startswith("palpate") and (asked.marker is None or asked.marker.evaluate(WINDOWS)):
        # pip would look at the system that it runs on.
        asked.marker = None
        print(asked)
PYTHON
}

asked=$(needed)
if [ "$asked" != "$(cat "$packages/asked.txt" 2>/dev/null)" ]; then
    install --requirement /dev/stdin <<<"$asked"
    echo "$asked" >"$packages/asked.txt"
fi
install --no-deps --force-reinstall "$wheel"
# What an editable install would do: the checkout as `palpate`, with its version.
mkdir -p "$packages/palpate-0.dist-info" "$root/windows/checkout"
printf 'Metadata-Version: 2.1\nName: palpate\nVersion: 0\n' >"$packages/palpate-0.dist-info/METADATA"
ln -sfn "$PWD" "$root/windows/checkout/palpate"
echo 'Z:\windows\checkout' >"$packages/palpate.pth"
# Before others, or devices and servos wait for each other longer than either allows.
nice -n -15 "$enter" "$root" wine "/windows/$(basename "$home")/python.exe" -m pytest -q -p no:cacheprovider \
    --timeout 900 -rs "$@"
