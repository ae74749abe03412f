# SPDX-License-Identifier: BSL-1.0
"""Values of an INI file of LinuxCNC: which of them a diagnosis changes, and how they are written for the next start."""
import os
import pathlib
import re
import tempfile

ENTRY = re.compile(r"^(\s*)([A-Za-z_][\w-]*)(\s*=\s*)(.*?)(\s*(?:#.*)?)$")


def read(path):
    """The text of a file, with the ends of its lines as they are."""
    with open(path, newline="") as file:
        return file.read()


def sections(text):
    """Every entry as (line, section, key, value)."""
    section = ""
    for number, line in enumerate(text.splitlines()):
        head = re.match(r"^\s*\[(.+?)\]", line)
        if head:
            section = head.group(1)
        elif not line.lstrip().startswith(("#", ";")) and (entry := ENTRY.match(line)):
            yield number, section, entry.group(2), entry.group(4)


def proposed(lines):
    """What `quadrant-gap export --linuxcnc` says for the INI file: {(section, key): value}."""
    return {(section, key): value for _, section, key, value in sections(lines.split("# --- HAL file ---")[0])}


def changes(ini_text, lines, least=1e-3):
    """Entries that the INI file has and that would change: [(section, key, now, new)].

    A number that differs by less than `least` is the same; a key that the INI file does not have is nobody's input, and left out.
    """
    wanted, out = proposed(lines), []
    for _, section, key, now in sections(ini_text):
        new = wanted.get((section, key))
        if new is None:
            continue
        try:
            same = abs(float(new) - float(now)) <= least * max(abs(float(now)), abs(float(new)))
        except ValueError:
            same = new == now
        if not same:
            out.append((section, key, now, new))
    return out


def with_changes(ini_text, chosen):
    """The INI file with the chosen values; comments, order and every other byte stay."""
    new = {(section, key): value for section, key, _, value in chosen}
    lines = ini_text.splitlines(keepends=True)
    for number, section, key, _ in sections(ini_text):
        if (section, key) in new:
            body = lines[number].rstrip("\r\n")
            end = lines[number][len(body):]
            lines[number] = ENTRY.sub(lambda m: m[1] + m[2] + m[3] + new[(section, key)] + m[5], body) + end
    return "".join(lines)


def save(path, text):
    """The old file stays beside it as NAME.before; the new one has the name when it is whole and on the disk."""
    path = pathlib.Path(os.path.realpath(path))
    before = path.with_name(path.name + ".before")
    for target, contents in ((before, read(path)), (path, text)):
        handle, aside = tempfile.mkstemp(prefix=target.name + ".tmp-", dir=target.parent)
        try:
            with os.fdopen(handle, "w", newline="") as file:
                file.write(contents)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(aside, path.stat().st_mode & 0o7777)
            os.replace(aside, target)
        except BaseException:
            os.unlink(aside)
            raise
    return before
