#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: once.sh FOLDER COMPILER FLAGS...   precompiles what every file here includes; check.sh is given `-include FOLDER/once.hpp`
set -eu
folder=$1
shift
mkdir -p "$folder"
echo '#include "quadrant/base/literals.hpp"' >"$folder/once.hpp"
case $1 in *clang*) suffix=pch ;; *) suffix=gch ;; esac
"$@" -x c++-header -o "$folder/once.hpp.$suffix" "$folder/once.hpp"
