# SPDX-License-Identifier: BSL-1.0
# Run it in examples/data: what is missing from machine.json, and the machine file with it.
import quadrant
found = quadrant.diagnose("log.csv", "machine.json", holdout="holdout.csv")
print(found)
found.apply().save("better.json")
found.save_report("report.html")
