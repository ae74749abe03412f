// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "init/commanded_axis.hpp"
#include "init/driven_axis.hpp"
#include "init/machine_text.hpp"
#include "read_machine.hpp"

#include <cmath>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Begins one axis.
inline void start_axis(const init_request& ask, const std::string& axis, const machine_log* log,
                       machine_text& text) {
    if (!is_axis_name(axis))
        throw bad_input("init",
                        fmt::format("{}: an axis is named by letters, digits, _ and -", in_quotes(axis)));
    const axis_log* record = nullptr;
    for (std::size_t i = 0; log && i < log->axes.size(); ++i)
        if (log->axes[i].name == axis) record = &log->axes[i];
    if (log && !record) throw bad_input(log->file, fmt::format("axis {} is not in the log", axis));
    const axis_kind kind = record ? record->kind : ask.rotary ? axis_kind::rotary : axis_kind::linear;
    if (record && ask.rotary && kind == axis_kind::linear)
        throw bad_input(log->file, fmt::format("axis {} is linear, not rotary", axis));
    const std::string file = log ? log->file : std::string();
    if (ask.drive == drive_kind::current)
        commanded_axis(ask, axis, kind, record, file, text).begin();
    else
        driven_axis(ask, axis, kind, record, file, text).begin();
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL initialised_machine init_machine(const init_request& request, const machine_log* log) {
    double period = request.sample_period_s;
    if (period == 0 && log) period = std::round(log->sample_period_s * 1e9) / 1e9;
    if (period == 0)
        throw bad_input("init", "--sample-period is missing, and there is no --log to take it from");
    detail::machine_text text(period, request.sample_period_s > 0 ? "given" : "from the log");
    auto axes = request.axes;
    if (axes.empty() && log)
        for (const auto& a : log->axes) axes.push_back(a.name);
    if (axes.empty()) axes = {"x"};
    for (const auto& name : axes) detail::start_axis(request, name, log, text);
    for (const auto& note : read_machine(text.json().dump(), "init").notes) text.note(note);
    return text.take();
}

QUADRANT_DIAGNOSIS_DECL initialised_machine machine_from_log(const machine_log& log) {
    init_request ask;
    ask.from_log = ask.unchecked = true;
    for (const axis_log& a : log.axes)
        if (!is_force(a.command_unit)) ask.values["force-constant"][a.name] = 1;
    try {
        return init_machine(ask, &log);
    } catch (const bad_input& why) {
        constexpr std::string_view writer = "init: ";
        std::string_view reason = why.what();
        if (reason.starts_with(writer)) reason.remove_prefix(writer.size());
        throw bad_input(log.file,
                        fmt::format("does not show what its machine is ({}): give a machine file, which "
                                    "quadrant-gap init begins",
                                    reason));
    }
}

} // namespace quadrant::inline v0::diagnosis
