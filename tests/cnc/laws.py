#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every control law on the mill, play left out: the rows of the table in docs/cnc.md, and whether those there still hold.
laws.py PROGRAM SCRATCH"""
import copy
import json
import pathlib
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
mill = json.loads((root / "examples/programs/quadrant_cnc/mill.json").read_text())
del mill["axes"]["z"]
laws = {
    "pid": mill["axes"]["x"]["control"],
    "p_pi": {"position_gain_per_s": 60, "gain_V_s_per_m": 400, "integral_gain_V_per_m": 25000, "acceleration_gain_V_s2_per_m": 1.58},
    "sliding_mode": {"sliding_per_s": 200, "gain_V_s_per_m": 300, "adaptation_V_per_m": 30000},
    "lead_lag": {"crossover_Hz": 25},
    "pole_placement": {"natural_Hz": 20, "observer_Hz": 35},
    "zero_phase": {"natural_Hz": 20, "observer_Hz": 35},
    "generalized_predictive": {"effort_m_per_V": 3e-5},
    "state_feedback": {"position_gain_V_per_m": 6e4, "velocity_gain_V_s_per_m": 400, "encoder_noise_m": 4e-7, "drift_V": 30},
}
documented = {}
for row in (root / "docs/cnc.md").read_text(encoding="utf-8").splitlines():
    cells = [cell.strip(" `") for cell in row.strip("|").split("|")]
    if cells[0] in laws and len(cells) == 7:
        documented[cells[0]] = list(map(float, cells[1:]))
faults = 0
for name, keys in laws.items():
    figures = []
    for feedforward in (None, {"scale": 0.9}):
        machine = copy.deepcopy(mill)
        for axis in machine["axes"].values():
            axis["drive"]["backlash_m"] = 0
            axis["control"] = {**keys, "law": name}
            if feedforward:
                axis["friction_feedforward"] = feedforward
        (scratch / "law.json").write_text(json.dumps(machine))
        ran = subprocess.run([program, "run", "--cnc", scratch / "law.json", "--path", root / "examples/path/diamond.nc", "--json"],
                             stdout=subprocess.PIPE, check=True)
        out = json.loads(ran.stdout)
        figures += [1e6 * e for e in (out["axes"]["x"]["error_max_m"], out["axes"]["y"]["error_max_m"], out["contour_error_max_m"])]
    print(f"| `{name}` | " + " | ".join(f"{f:.3g}" for f in figures) + " |")
    if name not in documented or any(abs(f - d) > 0.05 * f + 0.3 for f, d in zip(figures, documented[name])):
        print(f"docs/cnc.md says otherwise: {documented.get(name)}")
        faults = 1
sys.exit(faults)
