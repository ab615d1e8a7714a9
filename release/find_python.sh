#!/usr/bin/env bash
# Print the path of a Python of one version: `release/find_python.sh 3.13 [PREFERRED]`.
# Looks at PREFERRED, then on PATH, then at pyenv's; a pyenv shim that leads nowhere is passed over.
set -euo pipefail
version=$1
candidates=("${2:-python3}" "python$version")
if command -v pyenv >/dev/null; then
    candidates+=("$(pyenv root)/versions/$version".*/bin/python)
fi
for candidate in "${candidates[@]}"; do
    found=$("$candidate" -c 'import sys; print("%d.%d" % sys.version_info[:2], sys.executable)' 2>/dev/null) || continue
    if [ "${found%% *}" = "$version" ]; then
        echo "${found#* }"
        exit
    fi
done
echo "find_python.sh: no Python $version here; install it, or name one with PYTHON=" >&2
exit 1
