#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-gap has no absolute scale: a log and its machine file that are transformed together, exactly, keep verdict,
claims and values. Lengths, times, volts and forces times a factor, the sign of the axis, another zero of position and
time, other names of the axes, rotary in place of linear. A log that is cropped, or exchanged with its hold-out log,
is another log of the same machine: no other name may reach 0.5 there.
usage: transform.py PROGRAM SHARED [NAME ...]     exit code 77: the practice logs are not there
NAME: of practice logs; without one, two of them, and with QUADRANT_TESTS=all nine."""
import json, os, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal, getcontext
from fractions import Fraction

getcontext().prec = 50  # every product and sum below is exact
DEFAULT = ["003", "021"]
ALL = ["003", "005", "007", "012", "013", "014", "017", "021", "024"]
WORDS = {"m": "rad", "N": "Nm", "kg": "kg_m2", "mass": "inertia", "force": "torque", "length": "angle"}

# --- dimensions, from the unit that every key and column carries: exponents of length, time, force and volt -----------
UNITS = {"m": (1, 0, 0, 0), "s": (0, 1, 0, 0), "N": (0, 0, 1, 0), "V": (0, 0, 0, 1), "Hz": (0, -1, 0, 0),
         "kg": (-1, 2, 1, 0), "s2": (0, 2, 0, 0), "rad": (0, 0, 0, 0)}


def dimension(key):
    words, run = key.split("_"), []
    while words and (words[-1] in UNITS or words[-1] == "per"):
        run.insert(0, words.pop())
    out, side = [0, 0, 0, 0], 1
    for word in run:
        if word == "per":
            side = -1
        else:
            out = [a + side * b for a, b in zip(out, UNITS[word])]
    return out


def renamed(key, words):
    return "_".join(words.get(w, w) for w in key.split("_")) if not key.endswith("phase_rad") else key


class Similarity:
    """x -> sign * length * x + offset, t -> time * t + begin; forces and volts times their factors and the sign."""

    def __init__(self, name, length="1", time="1", force="1", volt="1", sign=1, offset="0", begin="0", axes=None,
                 rotary=False):
        self.name, self.sign, self.rotary, self.axes = name, sign, rotary, axes or {}
        self.by = [Decimal(v) for v in (length, time, force, volt)]
        self.offset, self.begin = Decimal(offset), Decimal(begin)

    def factor(self, key):
        out = Fraction(1)
        for base, exponent in zip(self.by, dimension(key)):
            out *= Fraction(base) ** exponent
        return out

    def axis(self, name):
        return self.axes.get(name, name)

    def key(self, key):
        return renamed(key, WORDS) if self.rotary else key

    def value(self, key, x):
        if isinstance(x, list):
            return [self.value(key, v) for v in x]
        if not isinstance(x, (int, float)) or isinstance(x, bool):
            return x
        odd = key in ("constant_force_N", "mean_N") or key.endswith("_asymmetry")
        return (self.sign if odd else 1) * (x if self.factor(key) == 1 else float(Fraction(x) * self.factor(key)))

    def box(self, node, box=""):
        """One box of an axis: tolerances and names have no unit, everything else is scaled by its key."""
        out = {}
        for key, v in node.items():
            if isinstance(v, dict):
                out[self.key(key)] = self.box(v, key)
            else:
                out[self.key(key)] = v if box == "tolerance" else self.value(key, v)
        return out

    def machine(self, machine):
        """Of the keys that refer to a place only those are known here that the practice files have: none. A zero that moves
        adds a constant to a spring; a phase turns with it."""
        for axis in machine["axes"].values():
            for key in ("spring_N_per_m", "cogging_N", "friction_position_amplitude", "ripple"):
                assert key not in axis["plant"], f"{key} refers to the zero of the position"
        # A line has no weight that turns: what only an angle can have would be one more suspect, not another machine.
        only = {"excluded_effects": machine.get("excluded_effects", []) + ["gravity"]} if self.rotary else {}
        return {**machine, **only, "sample_period_s": self.value("sample_period_s", machine["sample_period_s"]),
                "axes": {self.axis(a): self.box(v) for a, v in machine["axes"].items()}}

    def cell(self, key, text):
        if key == "t_s":
            return Decimal(text) * self.by[1] + self.begin
        out = self.sign * Decimal(text) * self.by[0 if key.endswith("_m") else 3]
        return out + self.offset * self.by[0] if key.endswith("_m") else out

    def log(self, header, rows):
        keys, names = [], []
        for name in header:
            axis, _, key = name.partition("_")
            keys.append("t_s" if name == "t_s" else key)
            names.append("t_s" if name == "t_s" else f"{self.axis(axis)}_{self.key(key)}")
        lines = [",".join(names)]
        for row in rows:
            lines.append(",".join(f"{self.cell(k, c):f}" for k, c in zip(keys, row)))
        return "\n".join(lines) + "\n"


def similarities(axes):
    for factor in ("0.001", "0.01", "10", "100", "1000"):
        yield Similarity(f"lengths x {factor}", length=factor)
    for factor in ("0.1", "4", "10"):
        yield Similarity(f"time x {factor}", time=factor)
    for factor in ("0.001", "0.002", "1000"):
        yield Similarity(f"volts x {factor}", volt=factor)
    for factor in ("0.001", "1000"):
        yield Similarity(f"forces x {factor}", force=factor)
    yield Similarity("turned over", sign=-1)
    yield Similarity("another zero of the position", offset="0.7")
    yield Similarity("another zero of the time", begin="1000")
    if len(axes) > 1:
        yield Similarity("axes exchanged", axes=dict(zip(axes, reversed(axes))))
    yield Similarity("renamed", axes={a: f"feed{len(axes) - i}" for i, a in enumerate(axes)})
    yield Similarity("rotary", rotary=True)
    yield Similarity("small, fast, weak, turned over and elsewhere", length="0.001", time="0.1", force="0.001",
                     volt="0.002", sign=-1, offset="0.7", begin="1000")


# --- the program -------------------------------------------------------------------------------------------------------
def read_csv(path):
    with open(path) as f:
        header, *rows = [line.split(",") for line in f.read().split("\n") if line]
    return header, rows


def diagnose(program, machine, log, holdout):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("machine.json", json.dumps(machine)), ("log.csv", log), ("holdout.csv", holdout)):
            with open(f"{folder}/{name}", "w") as f:
                f.write(text)
        run = subprocess.run([program, "diagnose", "--quiet", "--machine", f"{folder}/machine.json", "--log",
                              f"{folder}/log.csv", "--holdout", f"{folder}/holdout.csv", "--json",
                              f"{folder}/d.json"], capture_output=True, text=True, timeout=600)
        if run.returncode != 0:
            return run.stderr.strip()
        with open(f"{folder}/d.json") as f:
            return json.load(f)


def claims(d):
    return {(c["axis"], c["effect"]) for c in d["causes"] if c["probability"] >= 0.5}


def differences(base, s, d):
    """What an exact transformation changed; empty: nothing."""
    if isinstance(d, str):
        return [d]
    out = []
    if d["verdict"] != base["verdict"]:
        out.append(f"{d['verdict']}, was {base['verdict']}")
    for axis, a in base["axes"].items():
        if d["axes"][s.axis(axis)]["verdict"] != a["verdict"]:
            out.append(f"axis {axis}: {d['axes'][s.axis(axis)]['verdict']}, was {a['verdict']}")
    before = {(s.axis(c["axis"]), c["effect"]): c for c in base["causes"]}
    after = {(c["axis"], c["effect"]): c for c in d["causes"]}
    was = {(s.axis(axis), name) for axis, name in claims(base)}
    if claims(d) != was:
        out.append(f"claims {sorted(claims(d))}, were {sorted(was)}")
        return out
    for which in claims(d):
        p, q = before[which], after[which]
        # What the owner excludes still speaks against a name, and only a rotary axis has gravity: a spring is less
        # sure there.
        if s.rotary and which[1] == "position_spring" and q["probability"] < p["probability"]:
            continue
        if abs(p["probability"] - q["probability"]) > 0.05:
            out.append(f"{which[1]} at {q['probability']:.3f}, was {p['probability']:.3f}")
        key, value = next(iter(p["parameters"].items()))
        if isinstance(value.get("value"), list) or key.endswith("phase_rad"):
            continue
        wanted = s.value(key.split(".")[-1], value["value"])
        got = q["parameters"][".".join(s.key(k) for k in key.split("."))]["value"]
        width = abs(s.value(key.split(".")[-1], value["ci95"][1] - value["ci95"][0]))
        if abs(got - wanted) > max(0.1 * width, 1e-3 * abs(wanted)):
            out.append(f"{key} {got:.6g}, wanted {wanted:.6g} ({width:.2g} wide)")
    return out


def other_names(base, allowed, d):
    if isinstance(d, str):
        return [d]
    new = {name for _, name in claims(d)} - {name for _, name in claims(base)} - allowed
    return [f"claims {sorted(new)}"] if new else []


def main(program, shared, *names):
    practice = os.path.join(shared, "gap", "practice")
    if not os.path.isdir(practice):
        print(f"SKIPPED: no {practice}")
        return 77
    with open(f"{practice}/truth.json") as f:
        truth = json.load(f)
    bad = tried = 0
    with ThreadPoolExecutor(2) as pool:
        for name in names or (ALL if os.environ.get("QUADRANT_TESTS") == "all" else DEFAULT):
            with open(f"{practice}/{name}/machine.json") as f:
                machine = json.load(f)
            logs = [read_csv(f"{practice}/{name}/{which}.csv") for which in ("log", "holdout")]
            (header, log), (_, holdout) = logs
            same = Similarity("as it is")

            def run(s, log=log, holdout=holdout):
                return diagnose(program, s.machine(machine), s.log(header, log), s.log(header, holdout))

            n = len(log) // 10
            crops = {"its first tenth cropped": (log[n:], holdout), "its last tenth cropped": (log[:-n], holdout),
                     "log and hold-out exchanged": (holdout, log)}
            exact = list(similarities(list(machine["axes"])))
            base = pool.submit(run, same)
            transformed = [pool.submit(run, s) for s in exact]
            others = [pool.submit(run, same, *rows) for rows in crops.values()]
            base = base.result()
            allowed = set(truth[name]["accept"]) | set(truth[name]["truth"].split("+"))
            print(f"{name} {truth[name]['truth']}: {base['verdict']}, claims {sorted(claims(base))}", flush=True)
            results = [(s.name, differences(base, s, f.result())) for s, f in zip(exact, transformed)]
            results += [(what, other_names(base, allowed, f.result())) for what, f in zip(crops, others)]
            for what, wrong in results:
                tried += 1
                bad += bool(wrong)
                if wrong:
                    print(f"  BAD {what}: {'; '.join(wrong)}", flush=True)
    print(f"{tried - bad} of {tried} transformations keep the answer")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
