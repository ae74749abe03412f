# SPDX-License-Identifier: BSL-1.0
# An overlay port. Not tested: no vcpkg where this was written. vcpkg install quadrant --overlay-ports=packaging/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF -DQUADRANT_BUILD_BENCHMARKS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/quadrant)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug") # headers only
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
