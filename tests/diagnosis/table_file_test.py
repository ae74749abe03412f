#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
# Long: main() writes and compares one kind of table after the other.
"""Parquet and HDF5 files (tables/, by other writers than ours) through `quadrant-gap import`: what is in them, and damaged.
usage: table_file_test.py PROGRAM"""
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

TABLES = pathlib.Path(__file__).parent / "tables"
MAP = '{"schema": "quadrant.import/1", "header": 1, "separator": ",", "time": {"column": "t_s", "unit": "s"}, "axes": {"x": ' \
      '{"reference": {"column": "x_ref_m", "unit": "m"}, "position": {"column": "x_pos_m", "unit": "m"}, ' \
      '"command": {"column": "%s", "unit": "V"}}}}'


def single(v):
    return struct.unpack("f", struct.pack("f", v))[0]


def main(program):
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def expect(good, what):
            nonlocal bad
            bad += not good
            print("ok  " if good else "BAD ", what)

        def run(path, *options):
            (folder / "out.csv").unlink(missing_ok=True)
            return subprocess.run([program, "import", "--unchecked", "--quiet", *options, str(path), str(folder / "out.csv")],
                                  capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)

        def rows():
            lines = (folder / "out.csv").read_text().split()
            return lines[0].split(","), [[float(c) for c in line.split(",")] for line in lines[1:]]

        for file in ("snappy.parquet", "gzip.parquet", "plain_pages_2.parquet", "hyparquet.parquet", "packed.h5", "level73.mat"):
            done = run(TABLES / file)
            if done.returncode:
                expect(False, f"{file}: {done.stderr}")
                continue
            names, values = rows()
            at = {n: names.index(n) for n in ("t_s", "x_ref_m", "x_pos_m", "x_cmd_V")}
            narrow = file != "hyparquet.parquet"  # the command as a single
            good = len(values) == 400
            for k, row in enumerate(values):
                s = k * 1e-3
                u = 10 * math.cos(20 * s)
                good = good and abs(row[at["t_s"]] - s) < 1e-12 and abs(row[at["x_ref_m"]] - 0.01 * math.sin(20 * s)) < 1e-15
                good = good and abs(row[at["x_pos_m"]] - round(1e4 * math.sin(20 * s)) * 1e-6) < 1e-15
                good = good and abs(row[at["x_cmd_V"]] - (single(u) if narrow else u)) < (1e-6 if narrow else 1e-14)
            expect(good, f"{file}: every number")
        # Numbers of other kinds, no value, and what is left out.
        for file in ("snappy.parquet", "packed.h5"):
            (folder / "map.json").write_text(MAP % "count")
            done = run(TABLES / file, "--map", str(folder / "map.json"))
            if file == "packed.h5":
                names, values = rows()
                expect([r[names.index("x_cmd_V")] for r in values[:3]] == [-200, -199, -198], "whole numbers, signed")
            else:
                names, values = rows()
                left = [r[names.index("x_cmd_V")] for r in values]
                # Each fifth row has none: those rows are left out, the others stay as they are.
                expect(done.returncode == 0 and left == [k - 200 for k in range(400) if k % 5 != 4], f"no value: {left[:6]}")
            (folder / "map.json").write_text(MAP % "on")
            done = run(TABLES / file, "--map", str(folder / "map.json"))
            names, values = rows()
            expect([r[names.index("x_cmd_V")] for r in values[:8]] == [0, 1, 1, 1, 1, 1, 1, 0], f"{file}: flags")
            (folder / "map.json").write_text(MAP % "note")
            done = run(TABLES / file, "--map", str(folder / "map.json"))
            expect(done.returncode == 2 and "note" in done.stderr, f"{file}: text is no column: {done.stderr.strip()}")
        for file, words in (("zstd.parquet", "is compressed with zstd: write it with snappy, gzip or none"),
                            ("latest.h5", "write it with libver='earliest'"), ("lzf.h5", "is packed by filter 32000")):
            done = run(TABLES / file)
            expect(done.returncode == 2 and words in done.stderr, done.stderr.strip())
        # A transposed matrix, or damage that asks for as much.
        wide = bytearray((TABLES / "level73.mat").read_bytes())
        wide[12968:12974] = b"positi"  # the second size of a dataset
        (folder / "wide.mat").write_bytes(wide)
        done = run(folder / "wide.mat")
        expect(done.returncode == 2 and "is one column too many: 10000 are read" in done.stderr, done.stderr.strip())
        # Damaged: refused with one line, or read where the damage is in numbers; never a crash.
        for file in ("snappy.parquet", "gzip.parquet", "packed.h5", "level73.mat"):
            contents = (TABLES / file).read_bytes()
            refused = 0
            tries = [contents[:n] for n in range(9, len(contents), len(contents) // 12)]
            for n in range(16, len(contents), len(contents) // 40):
                tries.append(contents[:n] + bytes([contents[n] ^ 0xff]) + contents[n + 1:])
            for k, damaged in enumerate(tries):
                at = folder / ("damaged" + pathlib.Path(file).suffix)
                at.write_bytes(damaged)
                done = run(at)
                if done.returncode not in (0, 2) or len(done.stderr.strip().split("\n")) != 1:
                    expect(False, f"{file}, damage {k}: exit code {done.returncode}: {done.stderr}")
                refused += done.returncode == 2
            expect(refused >= 13, f"{file}: {refused} of {len(tries)} damaged ones are refused")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main(sys.argv[1])
