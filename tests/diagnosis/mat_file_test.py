#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
# Long: main() writes and compares one kind of MAT file after the other.
"""MAT-files through `quadrant-gap import`: as MATLAB saves them with -v6 and -v7, and damaged.
usage: mat_file_test.py PROGRAM"""
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

DOUBLE, SINGLE, INT16 = (6, 9, "d"), (7, 7, "f"), (10, 3, "h")  # class of the variable, type of its numbers, struct's letter
CELL, STRUCT, CHAR = 1, 2, 4


def element(order, kind, data, small=False):
    if small and len(data) <= 4:
        word = len(data) << 16 | kind
        return struct.pack(order + "I", word) + data.ljust(4, b"\0")
    return struct.pack(order + "II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def variable(name, columns, as_=DOUBLE, order="<", flags=0, row=False):
    """Columns of numbers under a name; `row`: one of them lies on its side."""
    kind, stored, letter = as_
    count = len(columns[0])
    shape = (1, count) if row else (count, len(columns))
    numbers = [v for c in columns for v in c]
    parts = [element(order, 6, struct.pack(order + "II", flags | kind, 0)), element(order, 5, struct.pack(order + "ii", *shape)),
             element(order, 1, name.encode(), small=True), element(order, stored, struct.pack(f"{order}{len(numbers)}{letter}", *numbers))]
    return element(order, 14, b"".join(parts))


def lying(name, rows):
    """A matrix whose rows are the signals."""
    numbers = [v for column in zip(*rows) for v in column]
    parts = [element("<", 6, struct.pack("<II", 6, 0)), element("<", 5, struct.pack("<ii", len(rows), len(rows[0]))),
             element("<", 1, name.encode()), element("<", 9, struct.pack(f"<{len(numbers)}d", *numbers))]
    return element("<", 14, b"".join(parts))


def text_variable(name, kind=CHAR):
    parts = [element("<", 6, struct.pack("<II", kind, 0)), element("<", 5, struct.pack("<ii", 1, 2)), element("<", 1, name.encode()),
             element("<", 4, "ab".encode("utf-16-le"))]
    return element("<", 14, b"".join(parts))


def holding(name, parts, fields=(), shape=(1, 1), length=None):
    """A structure with these fields, or without any a cell, of one element or an array of them; its parts one after the other."""
    head = [element("<", 6, struct.pack("<II", STRUCT if fields else CELL, 0)), element("<", 5, struct.pack("<ii", *shape)),
            element("<", 1, name.encode())]
    if fields:
        longest = max(map(len, fields)) + 1 if length is None else length
        head += [element("<", 5, struct.pack("<i", longest), small=True),
                 element("<", 1, b"".join(f.encode().ljust(longest, b"\0") for f in fields))]
    return element("<", 14, b"".join(head + list(parts)))


def object_variable(name):
    """An object of a class, as MATLAB saves it: no dimensions, then the name, its system and its class."""
    parts = [element("<", 6, struct.pack("<II", 17, 0))] + [element("<", 1, part) for part in (name.encode(), b"MCOS", b"SerialLink")]
    return element("<", 14, b"".join(parts))


def mat(variables, packed=False, order="<", text=b"MATLAB 5.0 MAT-file, Platform: GLNXA64", version=0x0100):
    head = text.ljust(124, b" ") + struct.pack(order + "H", version) + (b"IM" if order == "<" else b"MI")
    if packed:
        squeezed = [zlib.compress(v) for v in variables]
        variables = [struct.pack(order + "II", 15, len(z)) + z for z in squeezed]
    return head + b"".join(variables)


def motion(rows=400):
    t = [k * 1e-3 for k in range(rows)]
    x = [0.01 * math.sin(20 * s) for s in t]
    return t, x, [round(1e6 * v) * 1e-6 for v in x], [10 * math.cos(20 * s) for s in t]


def record(order="<", row=False):
    t, ref, pos, u = motion()
    return [object_variable("arm"), text_variable("note"), variable("gain", [[3.0]], order=order), variable("t_s", [t], order=order, row=row),
            variable("x_ref_m", [ref], order=order), variable("x_pos_m", [pos], order=order), variable("x_cmd_V", [u], order=order)]


def main(program):
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        at, out = pathlib.Path(folder) / "in.mat", pathlib.Path(folder) / "out.csv"

        def run(contents, *options):
            at.write_bytes(contents)
            out.unlink(missing_ok=True)
            return subprocess.run([program, "import", "--unchecked", "--quiet", *options, str(at), str(out)], capture_output=True, text=True,
                                  stdin=subprocess.DEVNULL)

        def expect(good, what):
            nonlocal bad
            bad += not good
            print("ok  " if good else "BAD ", what)

        t, ref, pos, u = motion()
        csv = "t_s,x_ref_m,x_pos_m,x_cmd_V\n" + "".join(f"{a!r},{b!r},{c!r},{d!r}\n" for a, b, c, d in zip(t, ref, pos, u))
        run(csv.encode())
        expected = out.read_text()
        native = [v for v in record() if b"note" not in v]
        for name, contents in (("-v6", mat(record())), ("-v7, compressed", mat(record(), packed=True)), ("rows on their side", mat(record(row=True))),
                               ("of a big-endian computer", mat([variable(n, [v], order=">") for n, v in
                                                                 zip(("t_s", "x_ref_m", "x_pos_m", "x_cmd_V"), (t, ref, pos, u))], order=">")),
                               ("without texts", mat(native))):
            done = run(contents)
            expect(done.returncode == 0 and out.read_text() == expected, f"{name}: as from CSV {done.stderr.strip()}")

        # A matrix and integers, through a map.
        told = pathlib.Path(folder) / "map.json"
        told.write_text("""{"schema": "quadrant.import/1", "header": 1, "time": {"column": "time", "unit": "s"}, "axes": {"x": {
            "position": {"column": "counts", "unit": "m", "scale": 1e-6}, "reference": {"column": "drive_1", "unit": "m"},
            "command": {"column": "drive_2", "unit": "V"}}}}""")
        done = run(mat([variable("time", [t]), variable("counts", [[round(1e6 * v) for v in pos]], INT16), variable("drive", [ref, u], SINGLE)],
                       packed=True), "--map", str(told))
        columns = out.read_text().splitlines()[0] if out.exists() else ""
        expect(done.returncode == 0 and columns == "t_s,x_ref_m,x_pos_m,x_cmd_V", f"a matrix and integers through a map {done.stderr.strip()}")

        # What a structure holds, as Simulink saves its scopes; a matrix that lies on its side, as "To File" writes it; a cell.
        scope = holding("signals", [variable("", [ref]), text_variable(""), variable("", [pos]), text_variable("")], ("values", "label"), (1, 2))
        named = ["rec.time", "rec.signals_1.values", "rec.signals_2.values", "rec.u"]
        for what, columns, contents in (
                ("a structure with time", named, mat([holding("rec", [variable("", [t]), scope, element("<", 14, b""), variable("", [u])],
                                                              ("time", "signals", "empty", "u"))], packed=True)),
                ("a matrix on its side", [f"ans_{k}" for k in range(1, 5)], mat([lying("ans", (t, ref, pos, u))])),
                ("a cell", [f"log_{k}" for k in range(1, 5)], mat([holding("log", [variable("", [v]) for v in (t, ref, pos, u)], shape=(4, 1))]))):
            told.write_text("""{"schema": "quadrant.import/1", "header": 1, "time": {"column": "%s", "unit": "s"}, "axes": {"x": {
                "reference": {"column": "%s", "unit": "m"}, "position": {"column": "%s", "unit": "m"},
                "command": {"column": "%s", "unit": "V"}}}}""" % tuple(columns))
            done = run(contents, "--map", str(told))
            expect(done.returncode == 0 and out.read_text() == expected, f"{what}: as from CSV {done.stderr.strip()}")

        # A file holds more than the log: what the map does not name may be of any length.
        beside = [variable("drive", [[7.0] * 900]), variable("short", [[1.0, 2.0]]), *native]
        told.write_text("""{"schema": "quadrant.import/1", "header": 1, "time": {"column": "t_s", "unit": "s"}, "axes": {"x": {
            "position": {"column": "x_pos_m", "unit": "m"}, "reference": {"column": "x_ref_m", "unit": "m"},
            "command": {"column": "x_cmd_V", "unit": "V"}}}}""")
        done = run(mat(beside), "--map", str(told))
        expect(done.returncode == 0 and out.read_text() == expected, f"variables of other lengths beside the log {done.stderr.strip()}")
        told.write_text(told.read_text().replace("x_cmd_V", "drive"))
        done = run(mat(beside), "--map", str(told))
        expect(done.returncode == 2 and ":402:" in done.stderr and "t_s has no more rows, x_cmd_V goes on" in done.stderr and not out.exists(),
               f"a longer one in the log: {done.stderr.strip()[-110:]}")

        # What is refused says the file and the byte.
        whole, packed = mat(record()), mat(record(), packed=True)
        first = 128 + len(object_variable("arm")) + len(text_variable("note")) + len(variable("gain", [[3.0]]))
        broken = bytearray(packed)
        broken[-40] ^= 0x55
        wrong_size = bytearray(whole)
        wrong_size[first + 24 + 8:first + 24 + 12] = struct.pack("<i", 399)  # the first of the dimensions of t_s
        deep = variable("", [t])
        for _ in range(17):
            deep = holding("", [deep], ("a",))
        complex_ = mat([variable("t_s", [t], flags=0x0800)])
        for name, contents, words in (
                ("cut short", whole[:-100], f"byte {len(whole) - len(record()[-1])}: an element of"),
                ("cut in a tag", whole[:128 + 4], "byte 132: ends in the middle of a variable"),
                ("a changed byte", bytes(broken), f"byte {len(packed) - 4}: the checksum of the zlib stream does not match"),
                ("no zlib stream", packed[:136] + b"ab" + packed[138:], "byte 136: no zlib stream begins here"),
                ("another sum", packed[:-1] + bytes([packed[-1] ^ 1]), f"byte {len(packed) - 4}: the checksum of the zlib stream does not match"),
                ("another size", bytes(wrong_size), "t_s: 399 by 1 numbers of 8 bytes are not 3200 bytes"),
                ("no such type", whole[:128] + struct.pack("<II", 77, 8) + bytes(8), "byte 128: 77 is no type of an element"),
                ("complex", complex_, "byte 136: t_s: is complex"),
                ("a bomb of a size", whole[:128] + variable("a", [[1.0]]).replace(struct.pack("<ii", 1, 1), struct.pack("<ii", 2 ** 30, 2 ** 30)),
                 "a: has more numbers than the file has bytes"),
                ("a bomb of zeros", whole[:128] + element("<", 15, zlib.compress(bytes(257 << 20))), "its compressed variables hold more than 256 MiB"),
                ("other lengths", mat([variable("t_s", [t]), variable("x_ref_m", [ref]), variable("x_pos_m", [pos[:-1]])]),
                 ":401:27: x_pos_m has no more rows, t_s goes on"),
                ("only texts", mat([text_variable("note"), holding("run", [text_variable("")], ("who",))]), "holds no vector of numbers"),
                ("structures without end", mat([holding("s", [deep], ("a",))]), "more than 16 structures in one another"),
                ("names without a length", mat([holding("s", [variable("", [t])], ("a",), length=0)]),
                 "s: the length of the names of its fields is no number"),
                ("names of uneven length", mat([holding("s", [variable("", [t])], ("abcd",), length=3)]),
                 "s: the names of its fields have 4 bytes, 3 each"),
                ("a part that is none", mat([holding("s", [element("<", 9, bytes(16))], ("a",))]), "s.a is no variable"),
                ("a part beyond its structure", mat([holding("s", [variable("", [t])[:-8]], ("a",)), variable("t_s", [t])]),
                 "s: holds more data than its size allows"),
                ("level 7.3", mat([], text=b"MATLAB 7.3 MAT-file, Platform: GLNXA64", version=0x0200), "save it in MATLAB with save(..., '-v7')"),
                ("another version", mat([], version=0x0300), "byte 124: version 0x0300")):
            done = run(contents)
            said = done.stderr.strip()
            expect(done.returncode == 2 and str(at) in said and words in said and "\n" not in said and not out.exists(), f"{name}: {said[-150:]}")
    return 1 if bad else 0


if __name__ == "__main__":
    if sys.argv[1] == "--write":  # one that is right, to standard output: a seed for the fuzzer
        sys.stdout.buffer.write(mat([*record(), holding("s", [variable("", [[1.0, 2.0]])], ("a",))], packed=True))
        sys.exit(0)
    sys.exit(main(sys.argv[1]))
