// SPDX-License-Identifier: BSL-1.0
// Long: one class: its steps share the columns and the line at which a refusal points.
#pragma once
#include "log/angle_wraps.hpp"
#include "log/header_reader.hpp"
#include "log/log.hpp"
#include "log/log_rows.hpp"
#include "log/sensor_box.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// One reading of a log. The text is walked once; a place is worked out only for a message.
class log_reader {
public:
    log_reader(std::string_view text, std::string_view file, log_purpose purpose = log_purpose::record)
        : text_(without_byte_order_mark(text)), file_(file), purpose_(purpose) {
        text_ = text_.substr(0, text_.find_last_not_of(" \t\r\n") + 1);
        rest_ = text_;
    }

    machine_log read() {
        if (text_.empty()) throw bad_input(file_, "is empty");
        const std::string_view first = next_line();
        header_ = read_header(
            first, [&](std::size_t offset, const std::string& message) { refuse(1, first, offset, message); },
            purpose_);
        reserve();
        while (!rest_.empty()) read_row(next_line());
        if (rows_ < 2)
            throw bad_input(file_, rows_ == 0 ? "holds no sample"
                                              : "holds one sample only: its period cannot be known");
        return assemble();
    }

private:
    [[noreturn]] void refuse(std::size_t number, std::string_view line, std::size_t offset,
                             std::string_view message) const {
        throw bad_input(file_, number, characters(line.substr(0, offset)) + 1, message);
    }

    std::string_view next_line() {
        const std::size_t end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        ++line_;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    /// A cell in which a recorder had nothing to write.
    static bool no_reading(std::string_view cell) {
        double value = 0;
        return cell.empty() || (parse_number(cell, value) && std::isnan(value));
    }

    void reserve() {
        const auto lines = static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n')) + 1;
        const std::size_t most =
            rest_.size() / (2 * header_.columns.size()) + 1; // a cell has a digit and a comma
        for (auto& column : header_.columns)
            if (column.used) column.values.reserve(std::min(lines, most));
    }

    void read_row(std::string_view line) {
        auto& columns = header_.columns;
        if (line.find_first_not_of(" \t") == line.npos) refuse(line_, line, 0, "a blank line inside the log");
        csv_cells cells(line);
        std::size_t index = 0;
        for (; cells.next(); ++index) {
            if (cells.broken())
                refuse(line_, line, cells.offset(),
                       "a quote is not closed before the comma or the end of the line");
            if (index == columns.size())
                refuse(line_, line, cells.offset(),
                       fmt::format("more cells than the {} of the header", columns.size()));
            auto& column = columns[index];
            if (!column.used) continue;
            double value = 0;
            if (const char* fault = parse_number(cells.text(), value))
                refuse(line_, line, cells.offset(),
                       fmt::format("{}: {} {}{}", column.name, in_quotes(cells.text()), fault,
                                   no_reading(cells.text()) ? ": leave the row out, and it will be filled in"
                                                            : ""));
            column.values.push_back(value);
            column.step.add(cells.text(), value);
        }
        if (index < columns.size())
            refuse(line_, line, line.size(),
                   fmt::format("the row has {} cells, the header {}", index, columns.size()));
        ++rows_;
    }

    /// Of a row that was read without fault: its stamp.
    [[noreturn]] void refuse_stamp(std::size_t row, std::string_view message) {
        rest_ = text_;
        line_ = 0;
        std::string_view line = next_line();
        for (std::size_t k = 0; k <= row; ++k) line = next_line();
        csv_cells cells(line);
        for (std::size_t k = 0; k <= header_.time; ++k) cells.next();
        refuse(line_, line, cells.offset(), message);
    }

    /// The rows on the log's own even clock. Stamps that go back are refused; rows whose stamp is that of the
    /// row before are dropped, unless the stamps are written too coarsely to differ.
    log_rows on_the_clock() {
        const log_column& time = header_.columns[header_.time];
        const auto& t = time.values;
        const double plain = (t.back() - t.front()) / static_cast<double>(rows_ - 1);
        const bool coarse = time.step.step() > plain; // then stamps must be equal
        std::vector<std::size_t> kept;
        for (std::size_t k = 0; k < rows_; ++k) {
            if (k > 0 && t[k] < t[kept.back()])
                refuse_stamp(k, fmt::format("t_s: {} does not come after {}", t[k], t[kept.back()]));
            if (k == 0 || coarse || t[k] > t[kept.back()]) kept.push_back(k);
        }
        if (kept.size() < 2 || !(t[kept.back()] > t[kept.front()]))
            throw bad_input(file_, "all rows have one stamp: its period cannot be known");
        log_rows out(t, std::move(kept), time.step.step());
        const row_clock& clock = out.clock();
        if (!clock.even && clock.spread > most_spread)
            refuse_stamp(
                out.row(clock.worst),
                fmt::format(
                    "t_s: the stamps jitter by {:.2g} of the period of {:.4g} s, here most; single steps "
                    "may be half a period off: resample the log with quadrant-gap import --resample",
                    clock.jitter, clock.period));
        return out;
    }

    machine_log assemble() {
        const log_rows rows = on_the_clock();
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
            const std::size_t times = unwrap(position.values),
                              asked = reference ? unwrap(reference->values) : 0;
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
            if (at.motor_unit == "rad") unwrap(header_.columns[*at.motor].values);
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
            axis.left_out[k] = 1;
            axis.drive_off.resize(enabled.size(), 0);
            axis.drive_off[k] = 1;
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

    std::string_view text_, rest_, file_;
    log_purpose purpose_;
    std::size_t line_ = 0, rows_ = 0;
    log_header header_{};
};

} // namespace detail

/// Reads a log (docs/formats.md) or throws bad_input. Missing rows, single wrong readings and rows with the
/// drive off are filled in and marked (axis_log::left_out); stamps that jitter by up to half a period are
/// resampled; notes say so.
inline machine_log read_log(const std::filesystem::path& path) {
    return detail::log_reader(detail::read_whole(path), path.string()).read();
}
/// Reads the references of a planned motion (t_s, x_ref_m, ...; other columns of the format are left alone) or
/// throws bad_input. Positions are the reference, commands 0.
inline machine_log read_motion(const std::filesystem::path& path) {
    return detail::log_reader(detail::read_whole(path), path.string(), detail::log_purpose::motion).read();
}
inline machine_log read_log(std::istream& in, std::string_view name) {
    return detail::log_reader(detail::read_whole(in, name), name).read();
}

} // namespace quadrant::inline v0::diagnosis
