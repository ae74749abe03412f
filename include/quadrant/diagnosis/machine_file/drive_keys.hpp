// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../text/json_keys.hpp"

/// What a machine file says of a drive beside the keys of effects: its kind, its timing and its filter, and
/// which key is of which kind.
namespace quadrant::inline v0::diagnosis::detail {

/// Numbers of a drive that are described and not searched.
inline constexpr std::array drive_number_keys{
    number_key<drive_description>{"velocity_filter_Hz", rule::positive, &drive_description::velocity_filter_Hz},
    number_key<drive_description>{"velocity_feedforward", rule::any_number,
                                  &drive_description::velocity_feedforward},
    number_key<drive_description>{"set_point_period_s", rule::positive, &drive_description::set_point_period_s},
};
inline constexpr std::array<std::string_view, 5> drive_other_keys{"kind", "interpolation", "velocity_filter_Hz",
                                                                  "velocity_feedforward", "set_point_period_s"};

/// Which kinds of drive have a key; and which cannot be without it.
struct key_of_drive {
    std::string_view name;
    std::array<bool, drive_kinds.size()> has, needs;
};
inline constexpr std::array drive_key_table{
    key_of_drive{"velocity_per_V", {false, true, false, false}, {}},
    key_of_drive{"velocity_gain_N_s_per_m", {false, true, true, false}, {false, true, true, false}},
    key_of_drive{"velocity_integral_N_per_m", {false, true, true, false}, {}},
    key_of_drive{"velocity_filter_Hz", {false, true, true, false}, {}},
    key_of_drive{"force_limit_N", {false, true, true, false}, {}},
    key_of_drive{"command_delay_s", {false, true, true, true}, {}},
    key_of_drive{"position_gain_per_s", {false, false, true, false}, {false, false, true, false}},
    key_of_drive{"velocity_feedforward", {false, false, true, false}, {}},
    key_of_drive{"set_point_period_s", {false, true, true, true}, {}},
    key_of_drive{"interpolation", {false, false, true, true}, {}},
    key_of_drive{"set_point_loss", {false, false, true, true}, {}},
    key_of_drive{"clock_slip", {false, false, true, true}, {}},
    key_of_drive{"position_gain_per_m", {false, false, false, true}, {false, false, false, true}},
    key_of_drive{"minimum_duty", {false, false, false, true}, {}},
    key_of_drive{"maximum_duty", {false, false, false, true}, {}},
    key_of_drive{"setpoint_rate_limit_m_per_s", {false, false, false, true}, {}},
    key_of_drive{"supply_V", {false, false, false, true}, {false, false, false, true}},
};

/// A word of a list, or a refusal that names the nearest.
template <class Words> std::size_t word_of(const json_node& node, const Words& words) {
    const std::string& given = node.text();
    const auto found = std::find(words.begin(), words.end(), given);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    std::string all;
    for (const std::string_view w : words) all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", w);
    node.refuse(fmt::format("must be one of {}{}", all, suggestion(given, words)));
}

/// The kind, and a refusal of every key that another kind has.
inline void read_drive_kind(const json_node& node, drive_description& drive) {
    drive.kind = static_cast<drive_kind>(word_of(node.need("kind"), drive_kinds));
    const auto kind = static_cast<std::size_t>(drive.kind);
    for (const key_of_drive& key : drive_key_table) {
        const auto given = node.find(std::string(key.name));
        if (given && !key.has[kind]) {
            std::string kinds;
            for (std::size_t i = 0; i < drive_kinds.size(); ++i)
                if (key.has[i]) kinds += fmt::format("{}{}", kinds.empty() ? "" : " or ", drive_kinds[i]);
            given->refuse(
                fmt::format("belongs to a drive of kind {}; this one is {}", kinds, name_of(drive.kind)));
        }
        if (key.needs[kind]) node.need(std::string(key.name));
    }
}
/// The keys that belong to no effect.
inline void read_drive_others(const json_node& node, double period, drive_description& drive) {
    for (const auto& key : drive_number_keys)
        if (const auto given = node.find(key.name)) key.set(drive, given->number(key.rule));
    if (const auto given = node.find("interpolation"))
        drive.between = static_cast<interpolation>(word_of(*given, interpolations));
    // Of so many in a row the log says nothing that one of a hundred does not.
    constexpr double most = 1000;
    if (drive.set_point_period_s && *drive.set_point_period_s < period / most)
        node.find("set_point_period_s")
            ->refuse(fmt::format("must be at least sample_period_s ({:g}) over {:g}", period, most));
}

} // namespace quadrant::inline v0::diagnosis::detail
