#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Every key that is cited, such as [Franklin1998], stands in docs/references.md, and every TODO names its issue.
cd "$(dirname "$0")/.." || exit 1
missing=0
for key in $(grep -rhoE '\[[A-Z][A-Za-z]+(19|20)[0-9]{2}\]' include docs examples tests benchmarks | sort -u); do
    grep -qF "**$key**" docs/references.md || { echo "docs/references.md does not have $key"; missing=1; }
done
grep -rnE '\b(TODO|FIXME|XXX)\b' include examples tests benchmarks --include='*.[ch]pp' --include='*.h' --include='*.js' |
    grep -vE 'TODO\(#[0-9]+\)' && { echo 'these name no issue: TODO(#12): ...'; missing=1; }
exit $missing
