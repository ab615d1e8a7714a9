#!/usr/bin/env bash
# Ends wine in a root and takes away what enter.sh mounted: `leave.sh ROOT`, before it is deleted.
set -euo pipefail
root=$(realpath "$1")
chroot "$root" env WINEPREFIX=/windows/prefix wineserver --kill 2>/dev/null || true
findmnt --noheadings --list --output TARGET | { grep "^$root/" || true; } | sort --reverse |
    while read -r place; do umount --lazy "$place"; done
