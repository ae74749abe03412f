#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: package.sh SOURCE_DIR SCRATCH QUADRANT_GAP SHARED [MODULE]
# The Python package as a user gets it: `pip install` into a clean environment without a network, then its tests.
# MODULE: quadrant._core as this build compiled it, or none where it could not; without the word setup.py compiles it anew.
# Exit code 77 (skipped) where a Debian package is missing.
set -eu
source=$1 scratch=$2 gap=$3 shared=$4 module=${5-}
python=/usr/bin/python3
for needed in pybind11 numpy pandas pytest wheel setuptools venv; do
    $python -c "import $needed" 2>/dev/null ||
        { echo "SKIPPED: the Python package: no python3-$needed"; exit 77; }
done
rm -rf "$scratch"
mkdir -p "$scratch"
before=$(cd "$source" && find examples/python | sort)
$python -m venv --system-site-packages "$scratch/venv" # the system's numpy and build tools
export QUADRANT_BUILD="$scratch/build"
case $module in
none)
    echo "SKIPPED: the Python package: this build has no module (python3-dev, python3-pybind11)"
    exit 77
    ;;
'') ! command -v ccache >/dev/null || export CMAKE_CXX_COMPILER_LAUNCHER=ccache ;; # it takes ten minutes otherwise
*) export QUADRANT_PYTHON_MODULE="$module" ;;
esac
"$scratch/venv/bin/pip" install --quiet --no-index --no-deps --no-build-isolation --disable-pip-version-check \
    "$source/examples/python" >"$scratch/pip.txt" 2>&1 || { cat "$scratch/pip.txt"; exit 1; }
after=$(cd "$source" && find examples/python | sort)
[ "$before" = "$after" ] || { echo "pip install leaves files in examples/python"; exit 1; }
cd "$scratch" # not where the sources could be imported from
QUADRANT_GAP="$gap" QUADRANT_SOURCE="$source" QUADRANT_SHARED="$shared" PYTHONDONTWRITEBYTECODE=1 \
    "$scratch/venv/bin/python" -m pytest -q -p no:cacheprovider --rootdir "$source/tests/python" "$source/tests/python"
