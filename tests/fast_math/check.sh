#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh FILE PROGRAM COMPILER FLAGS...   compiles FILE with -O3 -ffast-math and runs it
set -eu
file=$1 program=$2
shift 2
"$@" -O3 -ffast-math -o "$program" "$file"
"$program"
