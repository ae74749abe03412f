#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: check.sh WAY CMAKE COMPILER QUADRANT_BUILD WORK
#        WAY: by_subdirectory by_fetchcontent by_package by_pkg_config by_single_file by_debian_package
# Builds the small project beside this script as a user would, in WORK, without a network, and looks at what it prints.
set -eu
way=$1 cmake=$2 compiler=$3 quadrant_build=$4 work=$5
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
rm -rf "$work"
mkdir -p "$work/build"
skip() {
    echo "SKIPPED: $1"
    exit 77
}
installed() { # COMPONENT...
    for component; do
        "$cmake" --install "$quadrant_build" --prefix "$work/prefix" --component "$component" >>"$work/install.txt"
    done
}
by_cmake() {
    "$cmake" -S "$here/$way" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER="$compiler" "$@"
    "$cmake" --build "$work/build"
}
by_hand() { "$compiler" -std=c++20 "$@" "$here/one_notch.cpp" -o "$work/build/one_notch"; }
by_pkg_config() { # PREFIX
    command -v pkg-config >/dev/null || skip "no pkg-config"
    export PKG_CONFIG_PATH="$1/share/pkgconfig"
    by_hand $(pkg-config --cflags 'quadrant >= 0.1')
    if pkg-config --exists 'quadrant >= 1'; then
        echo "pkg-config takes $(pkg-config --modversion quadrant) for 1"
        exit 1
    fi
}

case $way in
by_subdirectory) by_cmake ;;
by_fetchcontent)
    by_cmake -DFETCHCONTENT_SOURCE_DIR_QUADRANT="$root" -DFETCHCONTENT_FULLY_DISCONNECTED=ON
    if commit=$(git -C "$root" rev-parse HEAD 2>/dev/null); then # as docs/use_in_a_project.md writes it, from this clone
        rm -rf "$work/build"
        mkdir "$work/build"
        by_cmake -DQUADRANT_REPOSITORY="file://$root" -DQUADRANT_TAG="$commit"
    fi
    ;;
by_package)
    installed dev
    by_cmake -DCMAKE_PREFIX_PATH="$work/prefix"
    version=$(sed -n 's/^set(PACKAGE_VERSION "\(.*\)")/\1/p' "$work"/prefix/share/cmake/quadrant/quadrantConfigVersion.cmake)
    grep -q "\"version\": \"$version\"" "$root/packaging/vcpkg/vcpkg.json"
    ;;
by_pkg_config)
    installed dev
    mv "$work/prefix" "$work/moved"
    by_pkg_config "$work/moved"
    ;;
by_single_file)
    single=$quadrant_build/quadrant_single.hpp
    [ -f "$single" ] || skip "no quadrant_single.hpp: no Python 3"
    mkdir "$work/alone"
    cp "$single" "$work/alone"
    python3 "$root/packaging/single_header.py" "$root/include" \
        "$(sed -n 's/.*Quadrant \([0-9.]*\):.*/\1/p' "$single")" "$work/again.hpp"
    cmp "$single" "$work/again.hpp"
    by_hand -DSINGLE_FILE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror "-I$work/alone"
    ;;
by_debian_package)
    command -v dpkg-deb >/dev/null && command -v cpack >/dev/null || skip "no dpkg-deb or no cpack"
    cpack --config "$quadrant_build/CPackConfig.cmake" -B "$work/packed" >"$work/cpack.txt" || { cat "$work/cpack.txt"; exit 1; }
    for package in "$work"/packed/*.deb; do
        dpkg-deb --info "$package"
        dpkg-deb --extract "$package" "$work/root"
    done
    [ "$(dpkg-deb --field "$work"/packed/libquadrant-dev_*_all.deb Depends)" = libboost-dev ]
    if [ -x "$quadrant_build/examples/quadrant-gap" ]; then
        for program in quadrant-gap quadrant-reproduce quadrant-cnc quadrant-latency; do
            "$work/root/usr/bin/$program" --version
            gzip -dcf "$work/root/usr/share/man/man1/$program.1"* | grep -q '^\.SH SYNOPSIS'
            bash -n "$work/root/usr/share/bash-completion/completions/$program"
        done
    fi
    by_pkg_config "$work/root/usr"
    ;;
*) echo "no way $way"; exit 2 ;;
esac
printed=$("$work/build/one_notch")
echo "one_notch prints: $printed"
[ "$printed" = "gain at 330 Hz: 0.000, at 50 Hz: 0.998" ]
