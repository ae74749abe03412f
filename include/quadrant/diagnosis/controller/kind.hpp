// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../text/number_rule.hpp"
#include "running.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <stdexcept>

namespace quadrant::inline v0::diagnosis {

/// What stands under a key of a controller.
enum class key_form : unsigned char { number, list, word, yes_no };

/// One key of a controller kind. `name` is linear, and dotted in a box inside the controller; such a key is
/// needed where its box is there. A rotary axis has the same key in its own words.
struct controller_key {
    std::string_view name, says; ///< and what it means, for the docs
    detail::number_rule rule = detail::rule::any_number;
    bool needed = false;
    double otherwise = 0; ///< the value of an absent key; infinite: none, and then it is not searched either
    bool searched =
        true; ///< it may be the key that differs from the described one; only numbers and yes_no can
    double scale =
        1; ///< where that search starts from 0 and the key has no unit; 0: from there it does not start
    std::string_view scale_of =
        {}; ///< the key whose value, for a time constant of the record, is the size to start from
    std::string_view of_unit =
        {}; ///< its unit as names write it, "V_s_per_m", where the name does not end in it
    key_form form = key_form::number;
    std::string_view old_name = {};             ///< of the last part of the name; read with a note
    std::array<std::string_view, 3> words = {}; ///< of a word: what it may be, the first where it is absent
    std::size_t least = 1, most = 1;            ///< entries of a list
    std::string_view needed_with = {}; ///< a word key: needed while that has its first word, else not used

    bool in_box() const { return name.find('.') != name.npos; }
    std::string_view box() const { return in_box() ? name.substr(0, name.find('.')) : std::string_view(); }
    std::string_view last() const { return in_box() ? name.substr(name.find('.') + 1) : name; }
};

/// A key that feeds forward, and the key whose value divides it (empty: none).
struct feedforward_key {
    std::string_view key = {}, over = {};
};

class given_values;

/// A kind of controller: all that is known of it, once. Reader and writer of machine files, their schema, the
/// replay, the search of the key that differs, the simulation of the closed loop, what `compensate` may set and
/// quadrant-cnc follow from it. A new kind is a file beside this one and a line in kinds.ipp:
/// docs/howto/add_a_controller_kind.md.
struct controller_kind {
    std::string_view name, label; ///< in files; in words
    std::string_view law;         ///< its equation or the page of its block, for the docs
    std::span<const controller_key> keys;
    /// The controller as new. Throws what its blocks throw for values that none can have.
    std::unique_ptr<running_controller> (*make)(const given_values&, const actuator_description&,
                                                double period) = nullptr;
    /// What the rules of single keys cannot say: refuse(key, message) throws, note(text) goes to the reader's
    /// notes.
    void (*examine)(const given_values&, const std::function<void(std::string_view, std::string)>& refuse,
                    const std::function<void(std::string)>& note) = nullptr;
    feedforward_key coulomb{}, viscous{}, acceleration{}; ///< what `compensate` may set
    feedforward_key constant{}, position{}; ///< the same: added to the command, and times the reference
    std::string_view dead_band{},
        length_unit{};    ///< the same: error that is ignored, in units of which that key
                          ///< says how many a metre has
    bool motions = false; ///< it reads velocities: of the log's columns where there are any, else differences

    /// The record of one key; throws std::invalid_argument for another one.
    const controller_key& key(std::string_view key_name) const {
        for (const controller_key& k : keys)
            if (k.name == key_name) return k;
        throw std::invalid_argument(fmt::format("controller kind {} has no key \"{}\"", name, key_name));
    }
};

/// The values of a description under the keys of its kind, with what an absent key stands for.
class given_values {
public:
    given_values(const controller_kind& kind, const controller_description& description)
        : kind_(kind), description_(description) {}

    double operator[](std::string_view key) const { return description_.number(key, kind_.key(key).otherwise); }
    bool has(std::string_view key) const { return description_.has(kind_.key(key).name); }
    bool has_box(std::string_view box) const {
        for (const controller_key& k : kind_.keys)
            if (k.box() == box && description_.has(k.name)) return true;
        return false;
    }
    /// The entries of a list; empty where it is absent.
    std::span<const double> list(std::string_view key) const {
        const auto found = description_.values.find(kind_.key(key).name);
        return found == description_.values.end() ? std::span<const double>() : found->second;
    }

private:
    const controller_kind& kind_;
    const controller_description& description_;
};

namespace detail {

/// Limit and converter that the machine file describes.
inline output_stage stage_of(const actuator_description& a) {
    return {a.limit_V.value_or(std::numeric_limits<double>::infinity()),
            a.dac_bits && a.dac_range_V ? *a.dac_range_V / std::exp2(*a.dac_bits) : 0};
}

/// Keys of a kind and those that it shares with others.
template <std::size_t... N> constexpr auto joined(const std::array<controller_key, N>&... parts) {
    std::array<controller_key, (N + ...)> out;
    std::size_t i = 0;
    const auto add = [&](const auto& part) {
        for (const controller_key& k : part) out[i++] = k;
    };
    (add(parts), ...);
    return out;
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
