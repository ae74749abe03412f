// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstdlib>
#include <filesystem>

/// Data that are not in the repository: the practice logs and published records beside it
/// (docs/CONTRIBUTING.md).
///   TEST_CASE("..." * doctest::skip(shared_missing())) { read(shared_data() / "gap/practice/001/log.csv"); }
inline std::filesystem::path shared_data() {
    if (const char* given = std::getenv("QUADRANT_SHARED")) return given;
    return QUADRANT_SHARED;
}
inline bool shared_missing() { return !std::filesystem::is_directory(shared_data()); }
