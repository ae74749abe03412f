#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: page.sh STAGE quadrant-gap SOURCE_DIR BUILD_DIR SHARED
# STAGE: build (the page), verdicts (drops the practice logs into it), browser (uses it; times are measured)
# Exit code 77 (skipped) where emscripten or the browser is missing.
set -u
stage=$1 program=$2 source=$3 build=$4 shared=$5
command -v em++ >/dev/null || { echo "SKIPPED: no em++ (Debian package emscripten): the page is not built"; exit 77; }
for needed in /usr/bin/chromium /usr/bin/chromedriver; do
    [ -x $needed ] || { echo "SKIPPED: no $needed: the page is not opened"; exit 77; }
done
/usr/bin/python3 -c 'import selenium' 2>/dev/null || { echo "SKIPPED: no python3-selenium: the page is not opened"; exit 77; }
mkdir -p "$build"
case $stage in
build)
    QUADRANT_BUILD=$build sh "$source/examples/web/build.sh" "$build/quadrant.html" && exit
    echo "the page was not built"
    exit 1
    ;;
verdicts) exec /usr/bin/python3 "$(dirname "$0")/verdicts.py" "$build/quadrant.html" "$program" "$shared" ;;
esac
# axe-core, for the accessibility of the page: a test's tool, not shipped.
axe=axe-core-4.10.2.tgz axe_sha256=9ea2d2d6917da998122bdacfd3b473e31ead53f4b87146c716a12edf89158100 with_axe=
if ! command -v npm >/dev/null; then
    echo "SKIPPED: no npm: the accessibility of the page is not checked"
elif [ -f "$build/$axe" ] || (cd "$build" && npm pack axe-core@4.10.2 --silent >/dev/null); then
    echo "$axe_sha256  $build/$axe" | sha256sum -c --quiet || { echo "$axe is another file than it was"; exit 1; }
    tar -xzOf "$build/$axe" package/axe.min.js >"$build/axe.min.js"
    with_axe="--axe $build/axe.min.js"
else
    echo "SKIPPED: npm gives no axe-core: the accessibility of the page is not checked"
fi
exec /usr/bin/python3 "$(dirname "$0")/page_test.py" "$build/quadrant.html" "$program" "$source" \
    --shots "$build/reports" $with_axe
