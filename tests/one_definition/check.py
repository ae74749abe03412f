# SPDX-License-Identifier: BSL-1.0
"""usage: check.py WORK COMPILER FLAGS...
One program with the lanes of three instruction sets, each compiled in its own translation unit. Of two functions with the
same name the linker keeps one, for all callers: none that an old processor may call may hold new instructions.
  - the baseline's object holds no AVX;
  - a function of the other objects that the linker may share holds no AVX, or the object's own set stands in its name;
  - the program gives the same results in every set that this processor has, the AVX-512 object linked first."""
import pathlib
import platform
import re
import subprocess
import sys

here = pathlib.Path(__file__).parent
work = pathlib.Path(sys.argv[1])
compiler = sys.argv[2:]
sets = {"baseline": [], "avx2": ["-mavx2", "-mfma"], "avx512": ["-mavx512f"]}


def run(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def build(source, name, flags):
    made = work / f"{name}.o"
    run(*compiler, "-O2", "-ffp-contract=off", *flags, "-c", source, "-o", made)
    return made


def functions(made):
    """Name of each function and whether it holds AVX or AVX-512 instructions (all of their names begin with v)."""
    out, name = {}, None
    for line in run("objdump", "-d", "--no-show-raw-insn", made).splitlines():
        if head := re.match(r"[0-9a-f]+ <(.+)>:$", line):
            name = head[1]
            out.setdefault(name, False)
        elif re.match(r"\s+[0-9a-f]+:\s+v", line):
            out[name] = True
    return out


def shared(made):
    """Names that the linker merges: weak and unique ones."""
    return {row.split()[-1] for row in run("nm", "--defined-only", made).splitlines() if row.split()[-2] in "WwVvu"}


def tags(names):
    """The instruction sets in these names, as the numbers of isa::x86."""
    return {number for name in names for number in re.findall(r"(?:3x86I|lane_setI.*?)Lj(\d+)E", name)}


def may_crash(made):
    own = tags(functions(made))
    return [n for n, wide in functions(made).items() if wide and n in shared(made) and not (own & tags([n]))]


def main():
    if platform.machine() != "x86_64":
        print("no x86-64 processor: skipped")
        return 77
    work.mkdir(parents=True, exist_ok=True)
    bad = work / "bad.cpp"
    bad.write_text("inline double twice(double x) { return x + x; }\ndouble (*keep)(double) = twice;\n")
    caught = may_crash(build(bad, "bad", sets["avx2"]))
    if len(caught) != 1 or "twice" not in caught[0]:
        print(f"FAILED: the check does not see an inline function under -mavx2: {caught}")
        return 1

    made = {name: build(here / "step.cpp", name, [*flags, f"-Drun=run_{name}"]) for name, flags in sets.items()}
    failures = [f"the baseline holds AVX: {name}" for name, wide in functions(made["baseline"]).items() if wide]
    seen = {}
    for name, each in made.items():
        own = tags(functions(each))
        if len(own) != 1 or own & set(seen.values()):
            failures.append(f"{name}: names carry the sets {own}, where one of its own is due")
        seen[name] = next(iter(own), None)
        failures += [f"{name}: shared with other sets: {function}" for function in may_crash(each)]
    for failure in failures:
        print("FAILED:", failure)
    program = work / "program"
    run(*compiler, "-O2", here / "main.cpp", made["avx512"], made["avx2"], made["baseline"], "-o", program)
    ran = subprocess.run([program], capture_output=True, text=True)
    print(ran.stdout, end="")
    return 1 if failures or ran.returncode else 0


sys.exit(main())
