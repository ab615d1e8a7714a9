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

needed() { # what pyproject.toml asks for, but for what only Linux has
    "$python" - <<'PYTHON'
import tomllib
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
extras = project["optional-dependencies"]
asked = project["dependencies"] + extras["test"] + extras["scheduler"] + ["colorama", "matplotlib"]
print(*(one for one in asked if not one.startswith("palpate") and "linux" not in one), sep="\n")
PYTHON
}

[ -d "$packages/distributed" ] || needed | install --requirement /dev/stdin
install --no-deps --force-reinstall "$wheel"
# What an editable install would do: the checkout as `palpate`, with its version.
mkdir -p "$packages/palpate-0.dist-info" "$root/windows/checkout"
printf 'Metadata-Version: 2.1\nName: palpate\nVersion: 0\n' >"$packages/palpate-0.dist-info/METADATA"
ln -sfn "$PWD" "$root/windows/checkout/palpate"
echo 'Z:\windows\checkout' >"$packages/palpate.pth"
"$enter" "$root" wine "/windows/$(basename "$home")/python.exe" -m pytest -q -p no:cacheprovider \
    --timeout 900 -rs "$@"
