#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: once.sh FOLDER COMPILER FLAGS...   precompiles what every file here includes; check.sh is given `-include FOLDER/once.hpp`
set -eu
folder=$1
shift
mkdir -p "$folder"
echo '#include "quadrant/base/literals.hpp"' >"$folder/once.hpp"
case $1 in *clang*) suffix=pch ;; *) suffix=gch ;; esac
precompile() { "$@" -x c++-header -o "$folder/once.hpp.$suffix" "$folder/once.hpp"; }
# g++ 12 saves it at an address that it draws, and breaks off ("in gt_pch_save") where that is taken: it draws again.
precompile "$@" || precompile "$@"
