#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# page.py where there is a browser; exit code 77 (skipped) where there is none.
for program in /usr/bin/chromium /usr/bin/chromedriver; do
    [ -x $program ] || { echo "no $program: skipped"; exit 77; }
done
/usr/bin/python3 -c 'import selenium' 2>/dev/null || { echo "no python3-selenium: skipped"; exit 77; }
exec /usr/bin/python3 "$(dirname "$0")/page.py" "$@"
