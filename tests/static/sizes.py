#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: sizes.py ROOT: no function is longer than 60 lines, and no file than 250, without a reason in its head.

Looks at every file of C++, C, Python, shell and CMake in include/, examples/, tests/, benchmarks/, docs/ and packaging/; functions
are those of C++, C and Python. A function of C++ is counted from the line of its opening brace to that of its closing one, one of
Python from its def. The reason stands among the first 12 lines of the file, in a comment line of its own:

    // Long: one keyword of the language after the other.

For a function it names the function, with its parentheses (a case of doctest is TEST_CASE()):

    // Long: thesis_parts() is a table, a line for each part of the source.
"""
import ast
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1]).resolve()
FUNCTION, FILE = 60, 250
strings = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|(?<![0-9a-fA-F])\'(?:[^\'\\\n]|\\.)+\'', re.S)
control = re.compile(r"^(?:else\s+)?(?:if|for|while|switch|do|else|try|catch|return|case|default)\b")
no_function = re.compile(r"\b(?:namespace|struct|class|enum|union)\b(?![^(]*\()|[=,(]\s*$|\breturn\b\s*$|^\s*$")


def functions(text):
    """First line, number of lines and head of each function in a source, whose comments and strings are blanked."""
    text = strings.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    text = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.M)
    text = re.sub(r"=\s*\{\}", lambda m: re.sub(r"[^\n]", " ", m[0]), text)  # a default argument is no body
    open_at, head = [], 0
    line = 1
    for at, c in enumerate(text):
        if c == "\n":
            line += 1
        elif c == "{":
            before = text[head:at].strip()
            before = re.sub(r"^(?:public|private|protected):", "", before).strip()
            is_function = ")" in before and not control.match(before) and not no_function.search(before)
            open_at.append((line, is_function, before))
            head = at + 1
        elif c == "}":
            if open_at:
                begin, is_function, before = open_at.pop()
                if is_function:
                    yield begin, line - begin + 1, before
            head = at + 1
        elif c == ";" and text.count("(", head, at) <= text.count(")", head, at):  # not those of a for
            head = at + 1


def python_functions(text):
    """The same of a source in Python."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1, f"{node.name}("


rooms = ("include", "examples", "tests", "benchmarks", "docs", "packaging")
readers = {".py": python_functions, ".sh": lambda text: (), ".cmake": lambda text: (), ".txt": lambda text: ()}
readers.update(dict.fromkeys((".hpp", ".ipp", ".cpp", ".cc", ".c", ".h"), functions))
names = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", *rooms], capture_output=True, text=True,
                       check=True).stdout.split()
faults, seen, files = [], {}, {}
for name in names:
    path = root / name
    if path.suffix not in readers or path.suffix == ".txt" and path.name != "CMakeLists.txt" or not path.is_file():
        continue
    text = path.read_text()
    lines = text.splitlines()
    files[path.suffix] = files.get(path.suffix, 0) + 1
    reasons = [line for line in lines[:12] if re.match(r"\s*(?://+!?|#) Long: \w", line)]
    named = re.findall(r"(\w+)\(\)", " ".join(reasons))
    for begin, length, head in readers[path.suffix](text):
        seen[path.suffix] = seen.get(path.suffix, 0) + 1
        if any(re.search(rf"\b{name}\(", head) for name in named):
            continue
        if length > FUNCTION:
            faults.append((length, f"{name}:{begin}: a function of {length} lines, {FUNCTION} at most"))
    if len(lines) > FILE and not reasons:
        faults.append((len(lines), f"{name}: {len(lines)} lines, {FILE} at most without 'Long: ...' in its head"))
for _, fault in sorted(faults, reverse=True):
    print(fault)
for suffix, least in {".hpp": 1000, ".cpp": 1000, ".py": 200}.items():
    if seen.get(suffix, 0) < least:
        sys.exit(f"only {seen.get(suffix, 0)} functions of {suffix} were found")
if files.get(".sh", 0) < 20:
    sys.exit(f"only {files.get('.sh', 0)} scripts were found")
print(f"{sum(seen.values())} functions of {sum(files.values())} files, {len(faults)} faults")
sys.exit(bool(faults))
