// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_words.hpp"
#include "json_text.hpp"
#include "number_rule.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace quadrant::inline v0::diagnosis::detail {

/// One value of a JSON file with its dotted path, for messages "FILE: axes.x.plant.mass_kg: must be ...".
struct json_node {
    const nlohmann::json* value;
    std::string path;
    std::string_view file;
    axis_kind kind = axis_kind::linear; ///< keys are asked for by their linear names

    std::string name(std::string_view key) const { return key_of(key, kind); }
    [[noreturn]] void refuse(std::string_view rule) const {
        throw bad_input(file, path.empty() ? std::string(rule) : fmt::format("{}: {}", path, rule));
    }
    json_node at(const std::string& key, const nlohmann::json& child) const {
        return {&child, path.empty() ? key : path + '.' + key, file, kind};
    }
    /// The child, or null.
    std::optional<json_node> find(const std::string& key) const {
        const auto found = value->find(name(key));
        if (found == value->end()) return {};
        return at(found.key(), *found);
    }
    json_node need(const std::string& key) const {
        auto child = find(key);
        if (!child) at(name(key), *value).refuse("is missing");
        return *child;
    }
    const json_node& object() const {
        if (!value->is_object()) refuse("must be an object");
        return *this;
    }
    const std::string& text() const {
        if (!value->is_string()) refuse("must be a string");
        return value->get_ref<const std::string&>();
    }
    double number(const number_rule& rule) const {
        constexpr double largest = 1e12; // outside, no SI value of a machine; squares and quotients stay finite
        if (!value->is_number()) refuse(rule.text);
        const double x = value->get<double>();
        if (!std::isfinite(x) || !rule.holds(x)) refuse(rule.text);
        if (x != 0 && !(std::abs(x) <= largest && std::abs(x) >= 1 / largest))
            refuse("must lie between 1e-12 and 1e12 in magnitude");
        return x;
    }
    std::vector<double> numbers(const number_rule& rule) const {
        if (!value->is_array()) refuse("must be an array of numbers");
        std::vector<double> out;
        for (const auto& entry : *value)
            out.push_back(json_node{&entry, fmt::format("{}[{}]", path, out.size()), file}.number(rule));
        return out;
    }
};

/// The names of a table of keys.
template <class Table> constexpr auto names_of(const Table& table) {
    std::array<std::string_view, std::tuple_size_v<Table>> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = table[i].name;
    return out;
}

/// Insertions, deletions and replacements from one name to the other.
inline std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

/// "; did you mean mass_kg?", or nothing when no name comes near. A unit left out or added is near.
template <class Names> std::string suggestion(std::string_view given, const Names& names) {
    constexpr std::size_t longest = 60, near = 2; // no name is longer: not worth the search
    if (given.empty() || given.size() > longest) return {};
    std::string_view best;
    // Of four characters or fewer half would be another word.
    std::size_t least = (given.size() <= 2 * near ? near - 1 : std::max(near, given.size() / 3)) + 1;
    for (std::string_view name : names) {
        const bool same_start = name.starts_with(given) || given.starts_with(name);
        const std::size_t n = same_start ? std::min(near, least - 1) : edits(given, name);
        if (n < least) {
            least = n;
            best = name;
        }
    }
    return best.empty() ? std::string() : fmt::format("; did you mean {}?", best);
}

} // namespace quadrant::inline v0::diagnosis::detail
