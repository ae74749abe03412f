#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Bill of materials (CycloneDX 1.5, JSON) of what the reports and pages embed: every foreign file with its SHA-256, every foreign
library with its version and licence, and our own files by name (their contents are those of the commit).

    python3 packaging/sbom.py           writes packaging/sbom.cdx.json
    python3 packaging/sbom.py --check   compares it with the files of this computer; 77 when no package manager can say versions

The list of files is read from where they are embedded: examples/programs/CMakeLists.txt (embed) and examples/web/build.sh.
"""
import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[1]
out = root / "packaging" / "sbom.cdx.json"
dygraphs = Path("/usr/share/javascript/dygraphs")

# Compiled into the WebAssembly of the browser's page, as examples/web/build.sh links them: Debian package, name, licence.
compiled = [
    ("libboost-dev", "Boost (Units and what it includes)", "BSL-1.0"),
    ("libeigen3-dev", "Eigen", "MPL-2.0"),
    ("nlohmann-json3-dev", "JSON for Modern C++", "MIT"),
    ("libfmt-dev", "{fmt}", "MIT"),
    ("emscripten", "Emscripten runtime (libc++, musl, loader)", "MIT"),
]


def version_of_package(name):
    done = subprocess.run(["dpkg-query", "-W", "-f=${Version}", name], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def own_version():
    header = (root / "include/quadrant/base/version.hpp").read_text()
    return ".".join(re.findall(r"#define QUADRANT_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header))


def embedded():
    """Page -> files, from the text of the build."""
    cmake = (root / "examples/programs/CMakeLists.txt").read_text()
    names = {"CMAKE_CURRENT_SOURCE_DIR": str(root / "examples/programs"), "QUADRANT_DYGRAPHS": str(dygraphs)}
    pages = {}
    for call, body in re.findall(r"^\s*(set|embed)\(([^)]*)\)", cmake, re.M):
        words = re.sub(r"\$\{(\w+)\}", lambda m: names.get(m[1], m[0]), body).split()
        if call == "set" and len(words) == 2:
            names[words[0]] = words[1]
        elif call == "embed":
            pages[words[0]] = [Path(w) for w in words[3:]]
    web = root / "examples/web"
    pages["quadrant.html"] = [*pages["quadrant_report"], *sorted(p for p in web.iterdir() if p.suffix in (".js", ".css", ".html"))]
    return pages


def component(path):
    foreign = dygraphs in path.parents
    out = {
        "type": "file",
        "bom-ref": ("dygraphs/" + path.name) if foreign else str(path.relative_to(root)),
        "name": path.name if foreign else str(path.relative_to(root)),
        "licenses": [{"license": {"id": "MIT" if foreign else "BSL-1.0"}}],
    }
    if foreign:
        out["hashes"] = [{"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}]
        out["version"] = version_of_package("libjs-dygraphs")
        out["purl"] = f"pkg:deb/debian/libjs-dygraphs@{out['version']}"
        out["externalReferences"] = [{"type": "website", "url": "https://github.com/danvk/dygraphs"}]
    return out


def bill():
    pages = embedded()
    files = {p: component(p) for p in sorted({p for all_of in pages.values() for p in all_of})}
    libraries = [
        {
            "type": "library",
            "bom-ref": package,
            "name": name,
            "version": version_of_package(package),
            "purl": f"pkg:deb/debian/{package}@{version_of_package(package)}",
            "licenses": [{"license": {"id": licence}}],
        }
        for package, name, licence in compiled
        if version_of_package(package)
    ]
    contents = [{"ref": page, "dependsOn": sorted(files[p]["bom-ref"] for p in of)} for page, of in sorted(pages.items())]
    for entry in contents:
        if entry["ref"] == "quadrant.html":
            entry["dependsOn"] += [library["bom-ref"] for library in libraries]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "name": "quadrant", "version": own_version(), "bom-ref": "quadrant"}},
        "components": [
            *({"type": "application", "bom-ref": page, "name": page, "version": own_version()} for page in sorted(pages)),
            *files.values(),
            *libraries,
        ],
        "dependencies": [{"ref": "quadrant", "dependsOn": sorted(pages)}, *contents],
    }


if not dygraphs.is_dir() or version_of_package("libjs-dygraphs") is None:
    print("skipped: the Debian package libjs-dygraphs is not installed")
    sys.exit(77)
now = bill()
text = json.dumps(now, indent=1) + "\n"
if "--check" in sys.argv:
    was = {c["bom-ref"]: c for c in json.loads(out.read_text())["components"]}
    said = {c["bom-ref"]: c for c in now["components"]}
    # A library that this computer has not got, or has in another security update, is not compared.
    wrong = [ref for ref in sorted(was.keys() | said.keys()) if ref not in {p for p, _, _ in compiled} and was.get(ref) != said.get(ref)]
    for ref in wrong:
        print(f"packaging/sbom.cdx.json: {ref} is not as embedded here")
    print(f"{len(said)} components, {len(wrong)} of them differ" + ("; python3 packaging/sbom.py writes the list again" if wrong else ""))
    sys.exit(bool(wrong))
out.write_text(text)
print(f"{out.relative_to(root)}: {len(now['components'])} components")
