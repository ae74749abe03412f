#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: page.sh quadrant-gap SOURCE_DIR BUILD_DIR SHARED     builds the page and uses it in a browser
# Exit code 77 (skipped) where emscripten or the browser is missing.
set -u
program=$1 source=$2 build=$3 shared=$4
command -v em++ >/dev/null || { echo "SKIPPED: no em++ (Debian package emscripten): the page is not built"; exit 77; }
for needed in /usr/bin/chromium /usr/bin/chromedriver; do
    [ -x $needed ] || { echo "SKIPPED: no $needed: the page is not opened"; exit 77; }
done
/usr/bin/python3 -c 'import selenium' 2>/dev/null || { echo "SKIPPED: no python3-selenium: the page is not opened"; exit 77; }
mkdir -p "$build"
QUADRANT_BUILD=$build sh "$source/examples/web/build.sh" "$build/quadrant.html" || { echo "the page was not built"; exit 1; }
exec /usr/bin/python3 "$(dirname "$0")/page_test.py" "$build/quadrant.html" "$program" "$source" \
    --shots "$build/reports" --shared "$shared"
