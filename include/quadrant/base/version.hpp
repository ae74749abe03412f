// SPDX-License-Identifier: BSL-1.0
#pragma once

/// The one place where the version stands; CMakeLists.txt reads it here.
#define QUADRANT_VERSION_MAJOR 0
#define QUADRANT_VERSION_MINOR 1
#define QUADRANT_VERSION_PATCH 0

namespace quadrant {

inline constexpr struct {
    int major, minor, patch;
} version{QUADRANT_VERSION_MAJOR, QUADRANT_VERSION_MINOR, QUADRANT_VERSION_PATCH};

} // namespace quadrant
