// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string_view>

/// Data that are not in the repository: the practice logs and published records beside it
/// (docs/CONTRIBUTING.md).
///   TEST_CASE("..." * doctest::skip(shared_missing())) { read(shared_data() / "gap/practice/001/log.csv"); }
inline std::filesystem::path shared_data() {
    if (const char* given = std::getenv("QUADRANT_SHARED")) return given;
    return QUADRANT_SHARED;
}
inline bool shared_missing() { return !std::filesystem::is_directory(shared_data()); }

/// Whether everything was asked for (QUADRANT_TESTS=all), also what takes minutes.
inline bool all_tests() {
    const char* const wanted = std::getenv("QUADRANT_TESTS");
    return wanted && std::string_view(wanted) == "all";
}
