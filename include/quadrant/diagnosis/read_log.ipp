// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "log/angle_wraps.hpp"
#include "log/header_reader.hpp"
#include "log/log_rows.hpp"
#include "log/log_text.hpp"
#include "log/sensor_box.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// What the columns of a log say of each axis.
class log_reader {
public:
    log_reader(std::string_view text, std::string_view file, log_purpose purpose = log_purpose::record)
        : text_(text, file, purpose), file_(file), purpose_(purpose) {}

    machine_log read() {
        text_.read();
        return assemble();
    }

private:
    machine_log assemble() {
        const log_rows rows = text_.on_the_clock();
        machine_log out;
        out.file = one_line(file_);
        out.sample_period_s = rows.clock().period;
        for (const auto& note : header_.notes) out.notes.push_back(fmt::format("{}: {}.", out.file, note));
        for (const auto& note : rows.notes()) out.notes.push_back(fmt::format("{}: {}.", out.file, note));
        for (auto& [name, at] : header_.axes) {
            if (purpose_ == log_purpose::motion) {
                auto& reference = header_.columns[*at.reference];
                reference.values = rows.smooth(reference.values);
                out.axes.push_back(planned(name, *at.kind, reference));
            } else {
                out.axes.push_back(recorded(out, name, at, rows));
            }
            add_motion(out.axes.back(), at, rows);
            if (purpose_ != log_purpose::motion) settle_reference(out, out.axes.back(), at);
        }
        out.samples = rows.samples();
        if (std::all_of(out.axes.begin(), out.axes.end(), [](const axis_log& a) { return a.still; }))
            throw bad_input(file_, "no axis moves");
        return out;
    }

    /// What one axis did.
    axis_log recorded(machine_log& out, const std::string& name, const log_header::axis_columns& at,
                      const log_rows& rows) {
        auto& position = header_.columns[*at.position];
        log_column* command = at.command ? &header_.columns[*at.command] : nullptr;
        log_column* reference = at.reference ? &header_.columns[*at.reference] : nullptr;
        const auto tell = [&](const std::string& text) {
            out.notes.push_back(fmt::format("{}: axis {}{}.", out.file, name, text));
        };
        if (*at.kind == axis_kind::rotary) {
            const auto after_gap = rows.after_gap();
            const std::size_t times = unwrap(position.values, after_gap),
                              asked = reference ? unwrap(reference->values, after_gap) : 0;
            if (times + asked > 0 && reference) turn_to(reference->values, position.values);
            if (times > 0)
                tell(fmt::format(": the position starts again {} times within one turn; it goes on here",
                                 times));
        }
        const bool still = is_constant(position.values);
        if (still && header_.axes.size() == 1) {
            const bool asked = reference && !is_constant(reference->values);
            throw bad_input(file_,
                            fmt::format("axis {} does not move: {} never changes{}", name, position.name,
                                        asked ? " although " + reference->name +
                                                    " does: is the drive on, the brake open, the encoder read?"
                                              : ""));
        }
        if (still) tell(" never moves: nothing can be said of it");
        const double step = position.step.step();
        const auto found = rows.check(position.values, observed_count(position.values, step));
        if (found.wrong + found.stale > 0)
            tell(fmt::format(
                ": {} readings of the position are wrong (no motion explains them) and {} repeat the one "
                "before while the axis moves: left out",
                found.wrong, found.stale));
        axis_log axis{.name = name,
                      .still = still,
                      .command_unit = at.command_unit,
                      .reference = reference ? rows.smooth(reference->values) : std::vector<double>{},
                      .position = rows.smooth(position.values, found.bad),
                      .command = !command              ? std::vector<double>(rows.samples(), 0.0)
                                 : at.command_measured ? rows.smooth(command->values)
                                                       : rows.held(command->values),
                      .reference_step = reference ? reference->step.step() : 0,
                      .position_step = step,
                      .command_step = command ? command->step.step() : 0,
                      .kind = *at.kind};
        axis.left_out = rows.left_out(found.bad);
        if (at.enabled) leave_out_disabled(axis, rows.held(header_.columns[*at.enabled].values), tell);
        if (std::none_of(axis.left_out.begin(), axis.left_out.end(), [](auto x) { return x != 0; }))
            axis.left_out.clear();
        if (at.command_measured) axis.command_is = command_origin::measured;
        add_taps(axis, at, rows);
        axis.as_sampled = rows.clock().even;
        return axis;
    }

    /// A duty is a share of the supply.
    void refuse_beyond_one(const log_column& duty, const std::string& axis) const {
        const auto most = std::max_element(duty.values.begin(), duty.values.end(),
                                           [](double a, double b) { return std::abs(a) < std::abs(b); });
        if (std::abs(*most) <= 1 + duty.step.step()) return;
        throw bad_input(file_,
                        fmt::format("axis {}: {} reaches {:g}: a duty is a share of the supply, -1 to 1 (per "
                                    "cent: times 0.01)",
                                    axis, duty.name, *most));
    }
    /// What was measured behind the drive.
    void add_taps(axis_log& axis, const log_header::axis_columns& at, const log_rows& rows) {
        if (at.command && at.command_unit == "duty") refuse_beyond_one(header_.columns[*at.command], axis.name);
        if (at.duty) {
            refuse_beyond_one(header_.columns[*at.duty], axis.name);
            axis.duty = rows.smooth(header_.columns[*at.duty].values);
            axis.duty_step = header_.columns[*at.duty].step.step();
        }
        if (at.motor) {
            if (at.motor_unit == "rad") unwrap(header_.columns[*at.motor].values, rows.after_gap());
            axis.motor = rows.smooth(header_.columns[*at.motor].values);
            axis.motor_unit = at.motor_unit;
            axis.motor_step = header_.columns[*at.motor].step.step();
        }
        if (!at.effort) return;
        axis.effort = rows.smooth(header_.columns[*at.effort].values);
        axis.effort_unit = at.effort_unit;
        axis.effort_step = header_.columns[*at.effort].step.step();
    }

    /// Rows in which the drive is off say nothing of how it acts on the axis.
    template <class Tell>
    static void leave_out_disabled(axis_log& axis, const std::vector<double>& enabled, Tell tell) {
        std::size_t off = 0, stretches = 0;
        for (std::size_t k = 0; k < enabled.size(); ++k) {
            if (enabled[k] >= 0.5) continue;
            stretches += k == 0 || enabled[k - 1] >= 0.5;
            ++off;
            axis.drive_off.resize(enabled.size(), 0);
            axis.drive_off[k] = axis.left_out[k] ? 2 : 1;
            axis.left_out[k] = 1;
        }
        if (off > 0)
            tell(fmt::format(": the drive is off in {} samples ({} stretches): left out", off, stretches));
    }

    /// Without a position reference nothing is said of the controller, and the motions are those of its speed,
    /// or of the axis itself.
    static void settle_reference(machine_log& out, axis_log& axis, const log_header::axis_columns& at) {
        if (at.reference) return;
        axis.has_reference = false;
        axis.reference = axis.position;
        if (at.reference_velocity) {
            for (std::size_t k = 1; k < axis.reference.size(); ++k)
                axis.reference[k] =
                    axis.reference[k - 1] + axis.reference_velocity[k - 1] * out.sample_period_s;
        }
        out.notes.push_back(
            fmt::format("{}: axis {} has no position reference{}: nothing is said of the controller.", out.file,
                        axis.name, at.reference_velocity ? ", only its speed" : ""));
    }

    /// The velocities that the log has columns for.
    void add_motion(axis_log& axis, const log_header::axis_columns& at, const log_rows& rows) {
        const auto values = [&](std::size_t column) { return rows.smooth(header_.columns[column].values); };
        if (at.reference_velocity) axis.reference_velocity = values(*at.reference_velocity);
        if (at.reference_acceleration) axis.reference_acceleration = values(*at.reference_acceleration);
        if (at.velocity) axis.velocity = values(*at.velocity);
    }

    /// An axis that follows its reference without being asked for anything.
    static axis_log planned(const std::string& name, axis_kind kind, log_column& reference) {
        axis_log out;
        out.name = name;
        out.kind = kind;
        out.still = is_constant(reference.values);
        out.reference = out.position = std::move(reference.values);
        out.command.assign(out.position.size(), 0.0);
        out.reference_step = reference.step.step();
        return out;
    }

    static bool is_constant(const std::vector<double>& values) {
        return std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
    }

    log_text text_;
    std::string_view file_;
    log_purpose purpose_;
    log_header& header_ = text_.header();
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL machine_log read_log_text(std::string_view text, std::string_view name) {
    return detail::log_reader(text, name).read();
}
QUADRANT_DIAGNOSIS_DECL machine_log read_log(const std::filesystem::path& path) {
    return read_log_text(detail::read_whole(path), path.string());
}
QUADRANT_DIAGNOSIS_DECL machine_log read_log(std::istream& in, std::string_view name) {
    return read_log_text(detail::read_whole(in, name), name);
}
QUADRANT_DIAGNOSIS_DECL machine_log read_motion_text(std::string_view text, std::string_view name) {
    return detail::log_reader(text, name, detail::log_purpose::motion).read();
}
QUADRANT_DIAGNOSIS_DECL machine_log read_motion(const std::filesystem::path& path) {
    return read_motion_text(detail::read_whole(path), path.string());
}

} // namespace quadrant::inline v0::diagnosis
