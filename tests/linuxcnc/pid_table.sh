#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: pid_table.sh FOLDER [--write]     (QUADRANT_TESTS=all, and linuxcnc-uspace; else says so: 77)
# Runs LinuxCNC's component pid itself and compares what it answers with tests/control/linuxcnc_pid.table, which the unit test
# of the block reads. --write: makes that table.
set -eu
module=/usr/lib/linuxcnc/modules/pid.so
skip() { echo "SKIPPED: LinuxCNC's pid: $*"; exit 77; }
[ "${2-}" = --write ] || [ "${QUADRANT_TESTS-}" = all ] || skip "only with QUADRANT_TESTS=all"
[ -e $module ] || skip "no $module: apt-get install linuxcnc-uspace"
here=$(cd "$(dirname "$0")" && pwd)
table=$here/../control/linuxcnc_pid.table
mkdir -p "$1"
${CXX-g++} -std=c++20 -O1 -Wall -Wextra -rdynamic "$here/pid_table.cc" -ldl -o "$1/pid_table"
"$1/pid_table" $module >"$1/linuxcnc_pid.table"
if [ "${2-}" = --write ]; then cp "$1/linuxcnc_pid.table" "$table"; fi
cmp "$1/linuxcnc_pid.table" "$table"
echo "$(grep -c -v case "$table") samples of LinuxCNC's pid are those of the table"
