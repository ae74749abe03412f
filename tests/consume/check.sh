#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh by_subdirectory|by_package CMAKE COMPILER QUADRANT_BUILD WORK
# Builds the small project beside this script as a user would, in WORK, and looks at the number it prints.
set -eu
way=$1 cmake=$2 compiler=$3 quadrant_build=$4 work=$5
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
if [ "$way" = by_package ]; then
    "$cmake" --install "$quadrant_build" --prefix "$work/prefix" >"$work/install.txt"
    set -- -DCMAKE_PREFIX_PATH="$work/prefix"
else
    set --
fi
"$cmake" -S "$here/$way" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" "$@"
"$cmake" --build "$work/build"
printed=$("$work/build/one_notch")
echo "one_notch prints: $printed"
[ "$printed" = "gain at 330 Hz: 0.000, at 50 Hz: 0.998" ]
