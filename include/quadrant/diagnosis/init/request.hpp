// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/log.hpp"
#include "../machine/machine.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What a machine file is begun from: numbers by option (init_fields.hpp) and axis, in SI.
struct init_request {
    std::vector<std::string> axes; ///< empty: those of the log, else "x"
    double sample_period_s = 0;    ///< 0: the log's
    std::string command_unit;      ///< V, A or N (Nm); empty: the log's, else V or Nm
    /// Of every axis: a drive with loops of its own, whose numbers that nobody gives come from the log.
    /// Current: it has none.
    drive_kind drive = drive_kind::current;
    bool rotary = false;    ///< every axis; with a log each says so itself
    bool from_log = false;  ///< the log's own estimate of what is not given, where it is sure
    bool unchecked = false; ///< a mass that the log contradicts makes a note, not a refusal
    command_origin command_is = command_origin::asked; ///< of every axis: where the log's command was taken
    std::map<std::string, std::map<std::string, double>> values; ///< option, then axis ("" is every axis)

    std::optional<double> value(const std::string& option, const std::string& axis) const {
        const auto of = values.find(option);
        if (of == values.end()) return {};
        for (const std::string& name : {axis, std::string()})
            if (const auto found = of->second.find(name); found != of->second.end()) return found->second;
        return {};
    }
};

/// A machine file to begin with, and where each of its numbers is from.
struct initialised_machine {
    nlohmann::ordered_json machine;
    std::string comments; ///< Markdown: every key, its value, what it means and where it is from
    std::vector<std::string> notes;
};

} // namespace quadrant::inline v0::diagnosis
