// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../text/key_unit.hpp"
#include "../text/number_rule.hpp"

#include <concepts>
#include <span>
#include <variant>

namespace quadrant::inline v0::diagnosis {

struct plant_model;

/// A place in a description that holds a number (0: none), an optional number, or one number an entry.
using number_place = std::variant<double*, std::optional<double>*, std::vector<double>*>;

namespace detail {

inline plant_description& box_with(axis_description& a, const plant_description*) { return a.plant; }
inline actuator_description& box_with(axis_description& a, const actuator_description*) { return a.actuator; }
inline encoder_description& box_with(axis_description& a, const encoder_description*) { return a.encoder; }
inline process_description& box_with(axis_description& a, const process_description*) { return a.process; }
inline drive_description& box_with(axis_description& a, const drive_description*) { return a.drive; }
inline transmission_description& box_with(axis_description& a, const transmission_description*) {
    return a.transmission;
}
inline payload_description& box_with(axis_description& a, const payload_description*) { return a.payload; }

template <class Box, class Value> const Box* box_type(Value Box::*) { return nullptr; }

} // namespace detail

/// The place of a key that has a member of its own: `.at = member<&plant_description::coulomb_N>`.
template <auto Member> number_place member(axis_description& a) {
    return &(detail::box_with(a, detail::box_type(Member)).*Member);
}

/// What stands under a key: a number, a number for each harmonic, or one for each element of a contact.
enum class key_shape { number, harmonics, elements };

/// One key of a machine file. Its name ends with its unit; names and units of a rotary axis follow from that
/// (axis_words.hpp).
struct machine_key {
    std::string_view name{}; ///< of a linear axis; box and dot before it, but for a key of the plant
    detail::number_rule rule = detail::rule::any_number;
    std::string_view meaning{}; ///< half a sentence, for docs and schema
    /// The member that holds the value; null: a number of the effect's law, or an entry of
    /// axis_description::numbers.
    number_place (*at)(axis_description&) = nullptr;
    std::array<std::string_view, 2>
        needs{};                   ///< keys of the same box that must be given with it, without the box
    std::string_view entries_of{}; ///< an array with one entry for each of this key's
    /// The value in a model, where calibration may move it inside the owner's tolerance; for the numbers of a
    /// law.
    double& (*of)(plant_model&) = nullptr;
    double neutral = 0; ///< the value at which the effect is absent
    key_shape shape = key_shape::number;
    /// Of the size of a wave, in place of `of`: both components of each of its harmonics.
    std::span<double& (*const)(plant_model&)> components{};
    bool required = false;
    bool tolerance = false; ///< the owner may say how well it is known, under its name without the unit
    double unstated = tolerance_description::unstated; ///< how well, where he does not say so
    bool percent = false;                              ///< a pure number that texts show in per cent
    bool unit_of_command =
        false; ///< named by the unit of the command: "_per_V" or "_per_A", absent where that is the force
    bool same_when_rotary = false;            ///< a mass or a length on a rotary axis, too
    std::array<std::string_view, 2> former{}; ///< names of earlier versions, without the box: read with a note

    constexpr std::string_view box() const {
        const auto dot = name.find('.');
        return dot == name.npos ? std::string_view("plant") : name.substr(0, dot);
    }
    constexpr std::string_view key() const { return name.substr(name.find('.') + 1); }
    constexpr std::string_view tolerance_name() const { return parts_of(key()).stem; }
    /// The key in the words of an axis, with `box` before it as in `name`, or without.
    std::string name_for(axis_kind kind) const {
        return same_when_rotary ? std::string(name) : key_of(name, kind);
    }
    std::string key_for(axis_kind kind) const {
        return same_when_rotary ? std::string(key()) : key_of(key(), kind);
    }
};

/// The keys of one effect.
class key_list {
public:
    static constexpr std::size_t most = 6;
    constexpr key_list() = default;
    template <std::same_as<machine_key>... Key>
    constexpr key_list(const Key&... keys) : each_{keys...}, count_(sizeof...(Key)) {}

    constexpr const machine_key* begin() const { return each_.data(); }
    constexpr const machine_key* end() const { return each_.data() + count_; }
    constexpr bool empty() const { return count_ == 0; }

private:
    std::array<machine_key, most> each_{};
    std::size_t count_ = 0;
};

} // namespace quadrant::inline v0::diagnosis
