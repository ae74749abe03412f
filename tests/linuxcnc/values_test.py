#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What the panel writes into an INI file: the values that were chosen, and not a byte besides.   usage: values_test.py SOURCE_DIR"""
import pathlib
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(source / "examples/linuxcnc/panel"))
import values  # noqa: E402

ini = ("# [JOINT_0] in a comment\r\n[JOINT_0]\nDELAY = 0.0004 # measured\n  PLANT_GAIN=4.1\n# DELAY = 9\nP = 5.45\n"
       "[JOINT_1]\nDELAY = 0.0004\nNAME = a # b\n")
lines = ("# x.json: values\n\n[JOINT_0]\n# axis x\nDELAY = 0.0012\nPLANT_GAIN = 4.10001\nBACKLASH = 0.02\n[JOINT_1]\nDELAY = 0.0004\n"
         "NAME = a\n\n# --- HAL file ---\nsetp quadrant-axis.0.delay 0.0012\n[JOINT_1]\nDELAY = 7\n")
found = values.changes(ini, lines)
assert found == [("JOINT_0", "DELAY", "0.0004", "0.0012")], found
assert values.changes(ini, lines, least=1e-7)[1] == ("JOINT_0", "PLANT_GAIN", "4.1", "4.10001")
new = values.with_changes(ini, found)
assert new == ini.replace("DELAY = 0.0004 # measured", "DELAY = 0.0012 # measured"), new
assert values.with_changes(ini, []) == ini
shipped = (source / "examples/linuxcnc/machine/quadrant.ini").read_text()
assert values.with_changes(shipped, []) == shipped
entries = {(s, k): v for _, s, k, v in values.sections(shipped)}
assert entries["JOINT_1", "NOTCH_WIDTH"] == "0.17" and entries["TRAJ", "COORDINATES"] == "X Y"
with tempfile.TemporaryDirectory() as folder:
    real, link = pathlib.Path(folder) / "real.ini", pathlib.Path(folder) / "link.ini"
    real.write_text(ini, newline="")
    real.chmod(0o640)
    link.symlink_to(real)
    before = values.save(link, new)
    assert link.is_symlink() and real.read_bytes() == new.encode() and before.read_bytes() == ini.encode()
    assert real.stat().st_mode & 0o777 == 0o640
    assert sorted(p.name for p in pathlib.Path(folder).iterdir()) == ["link.ini", "real.ini", "real.ini.before"]
print("ok: values of an INI file")
