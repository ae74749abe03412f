// SPDX-License-Identifier: BSL-1.0
#pragma once

/// The one place where the version stands; CMakeLists.txt reads it here.
#define QUADRANT_VERSION_MAJOR 0
#define QUADRANT_VERSION_MINOR 1
#define QUADRANT_VERSION_PATCH 0

/// A program of several files that call the diagnosis defines QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION in all of
/// them: the headers then only declare. What they declare is defined by <quadrant/diagnosis/src.hpp> in one
/// file more, or by each `X.ipp` behind its `X.hpp` in as many files as one likes.
#ifdef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    define QUADRANT_DIAGNOSIS_DECL
#else
#    define QUADRANT_DIAGNOSIS_DECL inline
#endif

namespace quadrant::inline v0 {

inline constexpr struct {
    int major, minor, patch;
} version{QUADRANT_VERSION_MAJOR, QUADRANT_VERSION_MINOR, QUADRANT_VERSION_PATCH};

} // namespace quadrant::inline v0
