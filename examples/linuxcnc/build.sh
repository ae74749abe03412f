#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: build.sh FOLDER          builds quadrant_axis.so, quadrant_xy.so and quadrant_plant.so there, for LinuxCNC's user space
#        build.sh --install       builds and copies them to LinuxCNC's modules (as root)
# CXX is the compiler (g++ when unset); CXXFLAGS come last.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
headers=/usr/include/linuxcnc
modules=/usr/lib/linuxcnc/modules
[ -e $headers/hal.h ] || { echo "build.sh: no $headers/hal.h: install linuxcnc-uspace-dev" >&2; exit 77; }
out=${1:?usage: build.sh FOLDER or build.sh --install}
if [ "$out" = --install ]; then
    [ -d $modules ] || { echo "build.sh: no $modules: install linuxcnc-uspace" >&2; exit 77; }
    out=$(mktemp -d)
    trap 'rm -rf "$out"' EXIT
fi
mkdir -p "$out"
for name in quadrant_axis quadrant_xy quadrant_plant; do
    ${CXX-g++} -std=c++20 -O2 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -DRTAPI -DUSPACE -fPIC \
        -fvisibility=hidden -shared -I"$here/../../include" -isystem $headers ${CXXFLAGS-} "$here/$name.cpp" -o "$out/$name.so"
    [ "$1" != --install ] || install -m 644 "$out/$name.so" $modules/
done
