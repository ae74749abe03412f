// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

#include <quadrant/diagnosis/text/json_node.hpp>

#include <algorithm>
#include <fmt/format.h>
#include <fnmatch.h>
#include <stdexcept>
#include <string_view>

/// Which cases --id names.
namespace quadrant_reproduce {

struct unknown_id : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The cases that a pattern names: an id; else the ids below it (thesis.loop); else a beginning; else a glob.
inline std::vector<std::string> named_by(const std::string& pattern, const std::vector<std::string>& ids) {
    const auto those = [&](auto belongs) {
        std::vector<std::string> found;
        std::copy_if(ids.begin(), ids.end(), std::back_inserter(found), belongs);
        return found;
    };
    auto found = those([&](const std::string& id) { return id == pattern; });
    if (found.empty()) found = those([&](const std::string& id) { return id.starts_with(pattern + "."); });
    if (found.empty() && !pattern.empty())
        found = those([&](const std::string& id) { return id.starts_with(pattern); });
    if (found.empty())
        found = those([&](const std::string& id) { return fnmatch(pattern.c_str(), id.c_str(), 0) == 0; });
    return found;
}

/// The experiments with the cases that the patterns name; all without one. Throws unknown_id.
inline std::vector<experiment> choose(std::vector<experiment> all, const std::vector<std::string>& patterns) {
    if (patterns.empty()) return all;
    std::vector<std::string> ids, wanted;
    for (const experiment& e : all)
        for (const run_case& c : e.cases) ids.push_back(c.id);
    for (const std::string& p : patterns) {
        const auto named = named_by(p, ids);
        if (named.empty()) {
            using quadrant::diagnosis::detail::edits;
            const auto& near = *std::min_element(ids.begin(), ids.end(), [&](const auto& a, const auto& b) {
                return edits(p, a) < edits(p, b);
            });
            throw unknown_id(
                fmt::format("no experiment is called \"{}\"; the nearest is {} (--list shows all)", p, near));
        }
        wanted.insert(wanted.end(), named.begin(), named.end());
    }
    for (experiment& e : all)
        std::erase_if(e.cases, [&](const run_case& c) {
            return std::find(wanted.begin(), wanted.end(), c.id) == wanted.end();
        });
    std::erase_if(all, [](const experiment& e) { return e.cases.empty(); });
    return all;
}

} // namespace quadrant_reproduce
