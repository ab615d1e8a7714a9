#!/usr/bin/env bash
# A command in a root of make_root.sh: `enter.sh ROOT COMMAND...`. The folder that one stands in is there
# under its own path, drive Z: in wine: `enter.sh ROOT wine /windows/Python313/python.exe -c ...`.
# A program under wine has the root for itself: what it leaves is ended with it, such as a console of a
# child that was killed, which would hold open whatever reads what was printed.
# What is mounted for it is taken away by leave.sh; never delete a root before.
set -euo pipefail
root=$(realpath "$1")
shift
mounted() { mountpoint -q "$1"; }
mounted "$root/proc" || mount -t proc proc "$root/proc"
mounted "$root/dev" || { mount --rbind /dev "$root/dev" && mount --make-rslave "$root/dev"; }
# wine counts processors there.
mounted "$root/sys" || mount -t sysfs sys "$root/sys"
mkdir -p "$root$PWD"
# A folder that was deleted and made anew has left a mount of the one that was.
[ "$root$PWD" -ef "$PWD" ] || ! mounted "$root$PWD" || umount --lazy "$root$PWD"
mounted "$root$PWD" || mount --bind "$PWD" "$root$PWD"
# Of OpenMP no Windows has one by itself, so wine's is not taken either.
microsofts=ucrtbase,vcruntime140,vcruntime140_1,msvcp140,msvcp140_1,msvcp140_2,concrt140
exec chroot "$root" env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    XDG_RUNTIME_DIR=/tmp WINEPREFIX=/windows/prefix WINEARCH=win64 WINEDEBUG=-all \
    "WINEDLLOVERRIDES=mscoree=;mshtml=;vcomp140=n;$microsofts=n,b" \
    OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 MKL_NUM_THREADS=1 ${PALPATE_PACKAGE:+PALPATE_PACKAGE="$PALPATE_PACKAGE"} \
    bash -c 'cd "$1"; shift; status=0; "$@" || status=$?; [ "$1" != wine ] || wineserver --kill 2>/dev/null || true; exit $status' enter "$PWD" "$@"
