#!/usr/bin/env bash
# The servo's own tests under wine: `test_native.sh ROOT [CARGO'S ARGUMENTS...]`, in the repository.
set -euo pipefail
root=$(realpath "$1")
shift
enter=$(dirname "$(realpath "$0")")/enter.sh
triple=x86_64-pc-windows-gnu
[ -d "$(rustc --print target-libdir --target "$triple")" ] || rustup target add "$triple"
# cargo starts tests in the crate, and some read the documents beside it.
"$enter" "$root" true
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER=x86_64-w64-mingw32-gcc-posix
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER="$enter $root wine"
exec cargo test --quiet --locked --manifest-path native/Cargo.toml --target "$triple" --features harness "$@"
