// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../controller/json.hpp"
#include "../fit/drive_estimate.hpp"
#include "../log/sensor_box.hpp"
#include "../machine_file/init_fields.hpp"
#include "../text/axis_words.hpp"
#include "machine_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// One axis that is begun: what was asked of it, its part of a log, and its part of the file.
class axis_start {
public:
    /// `log`: of this axis, in `file`; may be none.
    axis_start(const init_request& ask, const std::string& axis, axis_kind kind, const axis_log* log,
               std::string file, machine_text& text)
        : ask_(ask), axis_(axis), kind_(kind), record_(log), file_(std::move(file)), text_(text) {}

protected:
    std::optional<double> asked(const std::string& option) const { return ask_.value(option, axis_); }
    nlohmann::ordered_json& here() { return text_.axis(axis_); }
    static const init_field& field(std::string_view option) {
        return *std::find_if(init_fields.begin(), init_fields.end(),
                             [&](const auto& f) { return f.option == option; });
    }

    void put(const init_field& f, const std::string& linear, double value, std::string_view from) {
        const std::string key = key_of(linear, kind_), unit = text_of(f.unit, kind_);
        nlohmann::ordered_json& place = place_in(here()[f.box], key);
        if (f.whole && value == std::floor(value))
            place = static_cast<std::int64_t>(value);
        else
            place = value;
        text_.row(fmt::format("axes.{}.{}.{}", axis_, f.box, key), value, text_of(f.meaning, kind_), from);
        if (unit == f.unit && value != 0 && (std::abs(value) < f.low || std::abs(value) > f.high))
            text_.note(fmt::format(
                "axes.{}.{}.{} = {:g} is unusual (most lie between {:g} and {:g}): is it {}?", axis_, f.box,
                key, value, f.low, f.high, unit.empty() ? "a share, 0.05 for 5 %" : "in " + unit));
    }

    void read_count(const axis_log& log) {
        const double count = observed_count(log.position, log.position_step);
        const double written = std::round(count * 1e12) / 1e12; // no rounding of the file is a count
        if (!asked("resolution") && written > 1.01 * log.position_step) {
            const init_field& f = field("resolution");
            put(f, f.key, written, "smallest step of the position in the log");
        }
    }

    const init_request& ask_;
    const std::string& axis_;
    axis_kind kind_;
    const axis_log* record_;
    std::string file_;
    machine_text& text_;
};

} // namespace quadrant::inline v0::diagnosis::detail
