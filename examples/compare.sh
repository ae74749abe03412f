#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: compare.sh EXPECTED PROGRAM ARGS...   fails when the program fails or prints something else.
set -u
expected=$1
shift
printed=$("$@") || exit
printf '%s\n' "$printed" | diff -u "$expected" -
