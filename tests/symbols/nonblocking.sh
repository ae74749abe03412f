#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: nonblocking.sh COMPILER FLAGS...   verbs.cpp read by a clang that knows [[clang::nonblocking]] (20 or newer): no verb of
# any block calls what throws, allocates or waits, by what the compiler infers of every function below it
set -eu
here=$(cd "$(dirname "$0")" && pwd)
effects='-Wfunction-effects -Werror=function-effects -fsyntax-only -x c++'
# A compiler that says nothing to an allocation would say nothing to a block.
# shellcheck disable=SC2086
if printf '%s\n' 'void f(int*& p) noexcept [[clang::nonblocking]] { p = new int; }' | "$@" $effects - 2>/dev/null; then
    echo "FAILED: $1 does not refuse an allocation in a function that is nonblocking"
    exit 1
fi
# shellcheck disable=SC2086
"$@" $effects "$here/verbs.cpp"
# shellcheck disable=SC2086
if "$@" $effects -DQUADRANT_ALLOCATES "$here/verbs.cpp" 2>/dev/null; then
    echo "FAILED: $1 does not refuse verbs.cpp with an allocation in a verb"
    exit 1
fi
echo "no verb throws, allocates or waits, says $("$1" --version | head -1)"
