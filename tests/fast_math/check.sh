#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh FILE PROGRAM COMPILER FLAGS...   compiles FILE with -O3 -ffast-math and runs it
set -eu
file=$1 program=$2
shift 2
$(command -v ccache || true) "$@" -O3 -ffast-math -c -o "$program.o" "$file"
"$@" -O3 -ffast-math -o "$program" "$program.o" # which turns subnormal numbers off at the start
"$program"
