#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: qemu.sh WORK BOOST_INCLUDE      (QUADRANT_TESTS=all; else, or without the tools, it says so and returns 77)
# Builds every block and the example firmware for Cortex-M4F and Cortex-M7, runs both under QEMU, compares them with the
# host, looks for what firmware does not want to link, and prints the table of docs/microcontroller.md.
set -eu
[ "${QUADRANT_TESTS-}" = all ] || { echo "SKIPPED: the microcontroller under QEMU: only with QUADRANT_TESTS=all"; exit 77; }
for tool in arm-none-eabi-g++ qemu-system-arm; do
    command -v $tool >/dev/null || { echo "SKIPPED: no $tool (Debian: gcc-arm-none-eabi" \
        "libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm)"; exit 77; }
done
work=$1 boost=$2
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
example=$root/examples/microcontroller
documented=$root/docs/microcontroller.md
rm -rf "$work"
mkdir -p "$work/include"
ln -s "$boost/boost" "$work/include/boost" # Boost alone: the host's other headers must not be seen
cd "$work"

plain='-O2 -ffp-contract=off -ffunction-sections -fdata-sections -Wall -Wextra -Werror'
cpp="-std=c++20 $plain -Wpedantic -Wshadow -Wdouble-promotion -fno-exceptions -fno-rtti -I$root/include -isystem $work/include"
m4='-mthumb -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard'
m7='-mthumb -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard'
link="-T $example/mps2.ld --specs=rdimon.specs -Wl,--gc-sections"
on_board() { # BOARD PROGRAM
    timeout 120 qemu-system-arm -M "$1" -icount shift=0 -nographic -semihosting-config enable=on,target=native \
        -kernel "$2" </dev/null
}
failed=0

# Every block, in float and in double.
# long double is double on ARM, and literals such as 5.03_mm are worked out in it: the same here.
host_flags=-mlong-double-64
g++ $cpp $host_flags -I"$root/tests" "$here/every_block.cpp" -o every_block
./every_block >every_block.txt
for target in m4 m7; do
    eval "cpu=\$$target"
    board=mps2-an386
    [ $target = m4 ] || board=mps2-an500
    arm-none-eabi-gcc $cpu $plain -c "$example/startup.c" -o startup_$target.o
    arm-none-eabi-g++ $cpu $cpp -Wno-double-promotion -I"$root/tests" -c "$here/every_block.cpp" -o every_block_$target.o
    arm-none-eabi-g++ $cpu every_block_$target.o startup_$target.o $link -o every_block_$target.elf
    on_board $board every_block_$target.elf >every_block_$target.txt
    python3 "$here/compare.py" every_block.txt every_block_$target.txt $target || failed=1
done

# The firmware: the same commands, nothing linked that allocates or unwinds, sizes and instructions.
echo "| loop, two axes | processor | number | code and constants, bytes | RAM, bytes | instructions per sample and axis |"
echo "|---|---|---|---|---|---|"
for loop in plain with_observer with_memory; do
    for case in 'm4 mps2-an386 float Cortex-M4F' 'm4 mps2-an386 double Cortex-M4F' 'm7 mps2-an500 float Cortex-M7' \
        'm7 mps2-an500 double Cortex-M7'; do
        set -- $case
        eval "cpu=\$$1"
        chosen="-DSERVO_LOOP=$loop -DSERVO_NUMBER=$3"
        out=${loop}_$1_$3
        host=${loop}_$3
        if [ ! -x $host ]; then
            g++ $cpp $host_flags $chosen -c "$example/servo_axis.cpp" -o $host.o
            gcc -std=c11 $plain $chosen -c "$example/main.c" -o $host.main.o
            g++ $host.o $host.main.o -o $host
            ./$host | grep -v '^instructions' >$host.commands
        fi
        arm-none-eabi-g++ $cpu $cpp $chosen -c "$example/servo_axis.cpp" -o $out.o
        if arm-none-eabi-nm -u $out.o | grep -E 'malloc|calloc|free|_Zn|_Zd|locale|ios|stream|Unwind|cxa|throw|terminate|abort'; then
            echo "FAILED: $out.o needs what stands above"
            failed=1
        fi
        # All that firmware links for an axis: no start-up code, no I/O.
        arm-none-eabi-gcc $cpu $plain $chosen "-I$example" -c "$here/bare.c" -o $out.bare.o
        arm-none-eabi-gcc $cpu $out.bare.o $out.o startup_$1.o -T "$example/mps2.ld" -nostartfiles -Wl,--gc-sections -lm -o $out.bare.elf
        arm-none-eabi-gcc -std=c11 $cpu $plain $chosen -c "$example/main.c" -o $out.main.o
        arm-none-eabi-gcc $cpu $out.o $out.main.o startup_$1.o $link -lm -o $out.elf
        on_board $2 $out.elf >$out.txt
        grep -v '^instructions' $out.txt | cmp - $host.commands || { echo "FAILED: $out: not the host's commands"; failed=1; }
        count=$(sed -n 's/^instructions per sample and axis: //p' $out.txt)
        sizes=$(arm-none-eabi-size $out.bare.elf | awk 'NR == 2 { print $1 + $2 " | " $2 + $3 }')
        row="| $loop | $4 | $3 |"
        echo "$row $sizes | $count |"
        before=$(sed -n "s/^$row .* | \([0-9]*\) |\$/\1/p" "$documented")
        if [ -z "$before" ] || [ "$count" -gt $((before + before / 10)) ]; then
            echo "FAILED: more than a tenth above the documented ${before:-(none)}"
            failed=1
        fi
    done
done
exit $failed
