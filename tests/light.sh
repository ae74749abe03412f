#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: light.sh LIST COMPILER FLAGS...   fails when a header named in LIST pulls in one of the heavy ones.
set -u
list=$1
shift
heavy='/iostream$|/chrono$|/bits/chrono\.h$|boost/units/io\.hpp$|/Eigen/|/eigen3/'
read_by() { # what a file with these includes reads, one path a line
    "$@" -x c++ -M - | tr -s ' \\' '\n\n'
}
all=$(sed 's/.*/#include "&"/' "$list" | read_by "$@") || exit 1
printf '%s\n' "$all" | grep -Eq "$heavy" || exit 0
while read -r header; do
    found=$(printf '#include "%s"\n' "$header" | read_by "$@" | grep -E "$heavy" | tr '\n' ' ')
    [ -z "$found" ] || echo "$header reads $found"
done <"$list"
exit 1
