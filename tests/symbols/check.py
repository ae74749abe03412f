#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: check.py OBJECT      what every function of the object asks the linker for, those of verbs.cpp and all that they call

Fails when a verb of a block, or what it calls, asks for anything but mathematics and the copying of memory: an exception, memory,
a lock, the end of the program, a call whose target is not known."""
import re
import subprocess
import sys

# The last four end the program should an exception reach a `noexcept`: without a throw none does.
ALLOWED = re.compile(
    r"^(mem(cpy|move|set)|__(stack_chk_fail|sincos|sincosf)|_GLOBAL_OFFSET_TABLE_|"
    r"(exp|exp2|expm1|log|log1p|pow|sin|cos|sincos|tan|atan|atan2|asin|acos|hypot|cbrt|"
    r"sqrt|floor|ceil|trunc|round|lround|nearbyint|rint|fmod|remainder|fma|ldexp)(f|l)?|"
    r"__clang_call_terminate|_ZSt9terminatev|__cxa_begin_catch|__gxx_personality_v0)$")
DATA = re.compile(r"^(\.rodata|\.data|\.bss|\.LC|_ZL|_ZZ)")  # constants
VERBS = re.compile(r"(^|\W)(step|reset|settle|settle_both|applied|shift|ask|retune|\w+_(step|retune|settle|track))(<|\()")


def disassembled(path):
    """{function: set of what it asks for}; a part of a function that lies elsewhere counts as the function."""
    text = subprocess.run(["objdump", "-dr", "--no-show-raw-insn", path], check=True, capture_output=True, text=True).stdout
    asks, function = {}, None
    for line in text.splitlines():
        if begin := re.match(r"^[0-9a-f]+ <(.+)>:$", line):
            function = begin.group(1)
            asks.setdefault(function, set())
        elif relocation := re.match(r"^\s+[0-9a-f]+: R_\S+\s+(\S+)", line):
            name = re.sub(r"[-+]0x[0-9a-f]+$", "", relocation.group(1))
            asks[function].add(name)
        elif re.search(r"\s(call|jmp)q?\s+\*", line) and function is not None:
            asks[function].add("(a call through a pointer)")
    return asks


def plain(names):
    out = subprocess.run(["c++filt"], input="\n".join(names), check=True, capture_output=True, text=True).stdout
    return dict(zip(names, out.splitlines()))


def main():
    asks = disassembled(sys.argv[1])
    readable = plain(sorted(asks))
    by_section = {".text." + f: f for f in asks} | {".text.unlikely." + f: f for f in asks}
    verbs = [f for f in asks if VERBS.search(readable[f].replace("(anonymous namespace)::", "")) and not f.startswith("_GLOBAL__sub")]
    wrong, seen = {}, set()
    todo = [(f, f) for f in verbs]
    while todo:
        function, verb = todo.pop()
        if function in seen:
            continue
        seen.add(function)
        for name in asks[function]:
            name = by_section.get(name, name)
            if name in asks:
                todo.append((name, verb))
            elif not DATA.match(name) and not ALLOWED.match(name):
                wrong.setdefault(name, verb)
    for name, verb in sorted(wrong.items()):
        print(f"{plain([name])[name]}: asked for by {readable[verb][:300]}")
    print(f"{len(verbs)} verbs and {len(seen) - len(verbs)} functions behind them ask for {len(wrong)} things that they must not")
    return 1 if wrong or len(verbs) < 1000 else 0


sys.exit(main())
