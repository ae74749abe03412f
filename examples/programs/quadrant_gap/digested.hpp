// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "sha256.hpp"

#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/text/text.hpp>

namespace quadrant_gap {

/// A file read once: its contents, and the digest of its bytes.
template <class Contents> struct digested {
    Contents contents;
    std::string sha256;
};
inline digested<quadrant::diagnosis::machine_log> read_digested_log(const std::string& path) {
    const std::string bytes = quadrant::diagnosis::detail::read_whole(std::filesystem::path(path));
    return {quadrant::diagnosis::read_log_text(bytes, path), sha256(bytes)};
}
inline digested<quadrant::diagnosis::machine_description> read_digested_machine(const std::string& path) {
    const std::string bytes = quadrant::diagnosis::detail::read_whole(std::filesystem::path(path));
    return {quadrant::diagnosis::read_machine(bytes, path), sha256(bytes)};
}

} // namespace quadrant_gap
