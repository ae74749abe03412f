#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh FILE COMPILER FLAGS...
# FILE must compile with -DMEND and must not compile without. The first error must point into FILE, and of each line
# "// MUST SAY: words | other words" in it one of the alternatives must stand in what the compiler says. The first error with
# its notes, without the paths of this repository, must fit the bytes of "// AT MOST: gcc 2300, clang 7400" (9000 without).
set -u
export LC_ALL=C
file=$1
shift
if ! said=$("$@" -DMEND -S -o /dev/null "$file" 2>&1); then
    printf '%s\nthe mended form does not compile: the test would prove nothing\n' "$said"
    exit 1
fi
if said=$("$@" -S -o /dev/null "$file" 2>&1); then
    echo "it compiles"
    exit 1
fi
complain() {
    printf '%s\n%s\n' "$said" "$1"
    exit 1
}
printf '%s\n' "$said" | grep 'error: ' | head -n 1 | grep -qF "$file:" || complain "the first error is not in $file"
demands=$(sed -n 's|^// MUST SAY: ||p' "$file")
[ -n "$demands" ] || complain "$file has no line '// MUST SAY: ...'"
printf '%s\n' "$demands" | while IFS= read -r demand; do
    printf '%s\n' "$said" | grep -qF "$(printf '%s\n' "$demand" | sed 's/ | /\n/g')" || exit 1
done || complain "this message does not say: $demands"

kind=gcc
case $1 in *clang*) kind=clang ;; esac
root=$(cd "$(dirname "$0")/../.." && pwd)
bytes=$(printf '%s\n' "$said" | sed "s|$root/||g" | awk '/error: / { if (++n == 2) exit } n == 1' | wc -c)
budget=$(sed -n "s|^// AT MOST: .*$kind \([0-9]*\).*|\1|p" "$file")
echo "$bytes of ${budget:=9000} bytes"
[ "$bytes" -le "$budget" ] || complain "the first error is longer than its budget"
