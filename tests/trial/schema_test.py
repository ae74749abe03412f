#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What quadrant-gap trial --json wrote, against docs/schema/trial.schema.json: schema_test.py TRIAL.json ..."""
import copy
import json
import pathlib
import sys

import jsonschema

schema = json.loads((pathlib.Path(__file__).resolve().parents[2] / "docs/schema/trial.schema.json").read_text(encoding="utf-8"))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for path in sys.argv[1:]:
    trial = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    if faults := [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in validator.iter_errors(trial)]:
        sys.exit(f"{path}: {faults}")
    for key in ("truth_sha256", "cases", "coverage", "false_blame"):  # what a reader needs must be there
        less = copy.deepcopy(trial)
        del less[key]
        if validator.is_valid(less):
            sys.exit(f"a trial without {key} is accepted")
    if validator.is_valid(trial | {"colour": 1}) or validator.is_valid(trial | {"box": {"right": -1, "of": 1}}):
        sys.exit("a trial with a key of no meaning, or with a negative count, is accepted")
    print(f"{path}: as the schema says")
