#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: components.sh CXX FOLDER FLAGS...
# The HAL components on a stub of HAL: no LinuxCNC is needed. With it: run.sh.
set -eu
cxx=$1 out=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
for name in components table; do
    $cxx "$@" -O0 -isystem "$here/stub" -I"$here/../../examples" "$here/$name.cc" -o "$out/$name"
    "$out/$name"
done
