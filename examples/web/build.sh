#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: build.sh [OUT.html]     builds the page (default: build/web/quadrant.html) with emscripten; some minutes
# Installs the Debian packages that are missing. The page is one file: it opens from disk and asks nothing of a network.
# Environment: QUADRANT_BUILD  where to build (default: build in the repository)
set -eu
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH} # where Debian keeps what emscripten asks node for
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${QUADRANT_BUILD:-$root/build}/web
page=${1:-$build/quadrant.html}
here=$root/examples/web
dygraphs=/usr/share/javascript/dygraphs

sh "$root/examples/install.sh" emscripten node-acorn cmake python3 libboost-dev libeigen3-dev nlohmann-json3-dev libfmt-dev libxsimd-dev libjs-dygraphs
command -v em++ >/dev/null || { echo "no em++: install emscripten" >&2; exit 77; }
mkdir -p "$build/include" "$(dirname "$page")"

# The system's headers-only libraries, without the system's C library.
for library in boost eigen3/Eigen nlohmann fmt xsimd; do
    ln -sfn "/usr/include/$library" "$build/include/${library##*/}"
done
# Two numbers a register: emscripten has headers with the names of SSE4.1; Debian's Clang would find its own first.
# Eigen asks for more of SSE than they have, and stays as it is. The numbers that wait take more than 2 MB of stack.
for header in "$(em-config EMSCRIPTEN_ROOT)"/system/include/compat/*mmintrin.h; do
    ln -sfn "$header" "$build/include/${header##*/}"
done
rm -f "$build/include/mmintrin.h"
: >"$build/include/mmintrin.h" # emscripten has nothing that is older than SSE
cmake "-DOUT=$build/include/report_files.hpp" -DNAMESPACE=quadrant_gap \
    "-DFILES=$root/examples/programs/quadrant_gap/report_template.html;$root/examples/programs/quadrant_gap/report.css;$root/examples/programs/quadrant_gap/report.js;$dygraphs/dygraph.min.js;$dygraphs/dygraph.min.css" \
    -P "$root/examples/programs/page/embed.cmake"

# One file each, as many at once as there are cores; what did not change comes from the compiler cache, where there is one.
! command -v ccache >/dev/null || export EM_COMPILER_WRAPPER="${EM_COMPILER_WRAPPER-ccache}"
version=$(awk '/^#define QUADRANT_VERSION_/ { v = v (v == "" ? "" : ".") $3 } END { print v }' "$root/include/quadrant/base/version.hpp")
flags="-std=c++20 -O2 -msimd128 -msse4.1 -fwasm-exceptions -ffp-contract=off -DNDEBUG -DEIGEN_DONT_VECTORIZE -DFMT_HEADER_ONLY -DQUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
    -DQUADRANT_VERSION=\"$version\" -I$root/include -I$root/examples -I$root/examples/programs -isystem $build/include"
# A file for each folder of the diagnosis, and for each call with the folder of its parts.
rm -f "$build"/part_*
parts=$(cd "$root/include/quadrant/diagnosis" && find . -name '*.ipp' | sed 's|^\./||; s|\.ipp$||' | sort)
for suffix in hpp ipp; do # all that a file declares stands before what it makes
    for part in $parts; do
        printf '#include <quadrant/diagnosis/%s.%s>\n' "$part" $suffix >>"$build/part_${part%%/*}.cpp"
    done
done
cp "$here/binding.cpp" "$build/binding.cpp"
sed -i "s|\"session.hpp\"|\"web/session.hpp\"|" "$build/binding.cpp"
set -- $(cd "$build" && for source in part_*.cpp; do echo "${source%.cpp}"; done) binding
printf '%s\n' "$@" | xargs -P "$(nproc 2>/dev/null || echo 2)" -I '{}' em++ $flags -c "$build/{}.cpp" -o "$build/{}.o"
cd "$build"
em++ -O2 -fwasm-exceptions $(printf '%s.o ' "$@") -o quadrant.js --no-entry \
    -s MODULARIZE=1 -s EXPORT_NAME=quadrant_module -s ENVIRONMENT=worker -s ALLOW_MEMORY_GROWTH=1 -s FILESYSTEM=0 \
    -s DYNAMIC_EXECUTION=0 -s TOTAL_STACK=8MB -s "EXPORTED_FUNCTIONS=_malloc,_free" \
    -s "EXPORTED_RUNTIME_METHODS=UTF8ToString,stringToUTF8,lengthBytesUTF8"
python3 "$here/bundle.py" "$here" "$build" "$version" "$page"
