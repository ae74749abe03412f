#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh OBJECT COMPILER FLAGS...   compiles verbs.cpp and looks at what its functions ask the linker for
set -eu
here=$(cd "$(dirname "$0")" && pwd)
object=$1
shift
effects=
case $1 in *clang*) echo 'void f() noexcept [[clang::nonblocking]];' | "$1" -std=c++20 -Wfunction-effects -Werror -fsyntax-only -x c++ - 2>/dev/null &&
    effects='-Wfunction-effects -Werror=function-effects' ;; esac
# shellcheck disable=SC2086
"$@" -O2 -ffunction-sections $effects -c -o "$object" "$here/verbs.cpp"
exec python3 "$here/check.py" "$object"
