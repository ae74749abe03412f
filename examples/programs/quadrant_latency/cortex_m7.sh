#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: cortex_m7.sh OUT.elf BOOST_INCLUDE      the directed calls of quadrant-latency --bound for a Cortex-M7 with double hardware,
# compiled as firmware is (-O2, no exceptions, no run-time types); QEMU's board mps2-an500 runs it
set -eu
out=$1 boost=$2
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
board=$root/examples/microcontroller
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/include"
ln -s "$boost/boost" "$dir/include/boost" # Boost alone: the host's other headers must not be seen
flags='-O2 -ffp-contract=off -mthumb -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -ffunction-sections -fdata-sections'
arm-none-eabi-gcc $flags -c "$board/startup.c" -o "$dir/startup.o"
arm-none-eabi-g++ -std=c++20 $flags -Wall -Wextra -Werror -fno-exceptions -fno-rtti "-I$root/include" -isystem "$dir/include" \
    -c "$here/cortex_m7.cpp" -o "$dir/cortex_m7.o"
arm-none-eabi-g++ $flags "$dir/cortex_m7.o" "$dir/startup.o" -T "$board/mps2.ld" --specs=rdimon.specs -Wl,--gc-sections -o "$out"
