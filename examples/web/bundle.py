#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The page as one file: bundle.py SOURCES BUILD VERSION OUT.html

SOURCES holds page.html and its parts; BUILD holds quadrant.js and quadrant.wasm as emscripten wrote them.
"""
import base64
import gzip
import html
import pathlib
import re
import sys
import urllib.parse

sources, build = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
version, out = sys.argv[3], pathlib.Path(sys.argv[4])
most = 1_500_000  # bytes of the page when it is sent


def script(*parts):
    """Scripts one after the other, unable to end the element that holds them."""
    return "\n".join(p.read_text() for p in parts).replace("</script", "<\\/script")


def gallery(docs):
    """docs/gallery.md as HTML: headings, paragraphs and pictures; its tables and the last line stay there."""
    parts = []
    for block in (docs / "gallery.md").read_text().split("## ")[1:]:
        title, *paragraphs = (" ".join(p.split()) for p in block.split("\n\n") if p.strip())
        parts.append(f"<section><h3>{html.escape(title)}</h3>")
        for text in paragraphs:
            picture = re.fullmatch(r"!\[(.*)\]\((.*)\)", text)
            if picture:
                uri = "data:image/svg+xml," + urllib.parse.quote((docs / picture[2]).read_text(), safe=" =:/,;()'")
                parts.append(f'<div class="wide" tabindex="0" role="region" aria-label="{html.escape(title)}: picture">'
                             f'<img alt="{html.escape(picture[1])}" width="560" loading="lazy" src="{uri}"></div>')
                break
            parts.append(f"<p>{html.escape(text)}</p>")
        parts.append("</section>")
    return "\n".join(parts)


wasm = gzip.compress((build / "quadrant.wasm").read_bytes(), 9, mtime=0)
values = {
    "version": version,
    "gallery": gallery(sources / "../../docs"),
    "report_css": (sources / "../programs/quadrant_gap/report.css").read_text(),
    "page_css": (sources / "page.css").read_text(),
    "wasm": base64.b64encode(wasm).decode(),
    "worker": script(build / "quadrant.js", sources / "worker.js"),
    "page_js": script(*(sources / f"{name}.js" for name in ("call", "intake", "machine_form", "what_if", "page"))),
}
page = (sources / "page.html").read_text()
for name, value in values.items():
    page = page.replace("{{" + name + "}}", value)
out.write_text(page)
size = len(gzip.compress(page.encode(), 9))
print(f"{out}: {len(page.encode())} bytes, {size} gzipped")
if size > most:
    sys.exit(f"{out}: more than {most} bytes gzipped")
