// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "log.hpp"
#include "read/log_header.hpp"
#include "read/sample_clock.hpp"

namespace quadrant::diagnosis {

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
                       fmt::format("{}: {} {}", column.name, in_quotes(cells.text()), fault));
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

    machine_log assemble() {
        const auto clock =
            read_clock(header_.columns[header_.time].values,
                       [&](std::size_t row, const std::string& message) { refuse_stamp(row, message); });
        machine_log out;
        out.file = one_line(file_);
        out.sample_period_s = clock.period;
        out.samples = rows_;
        for (const auto& note : header_.notes) out.notes.push_back(fmt::format("{}: {}.", out.file, note));
        if (clock.jitter > 1e-3)
            out.notes.push_back(fmt::format("{}: the stamps jitter by up to {:.2g} % of the sample period.",
                                            out.file, 100 * clock.jitter));
        for (auto& [name, at] : header_.axes) {
            if (purpose_ == log_purpose::motion) {
                out.axes.push_back(planned(name, *at.kind, header_.columns[*at.reference]));
                add_motion(out.axes.back(), at);
                continue;
            }
            auto &reference = header_.columns[*at.reference], &position = header_.columns[*at.position],
                 &command = header_.columns[*at.command];
            const bool still = is_constant(reference.values) && is_constant(position.values);
            if (still && header_.axes.size() == 1)
                throw bad_input(file_, fmt::format("axis {} does not move: {} and {} never change", name,
                                                   reference.name, position.name));
            if (still)
                out.notes.push_back(
                    fmt::format("{}: axis {} never moves: nothing can be said of it.", out.file, name));
            out.axes.push_back({.name = name,
                                .still = still,
                                .command_unit = at.command_unit,
                                .reference = std::move(reference.values),
                                .position = std::move(position.values),
                                .command = std::move(command.values),
                                .reference_step = reference.step.step(),
                                .position_step = position.step.step(),
                                .command_step = command.step.step(),
                                .kind = *at.kind});
            add_motion(out.axes.back(), at);
        }
        if (std::all_of(out.axes.begin(), out.axes.end(), [](const axis_log& a) { return a.still; }))
            throw bad_input(file_, "no axis moves");
        return out;
    }

    /// The velocities that the log has columns for.
    void add_motion(axis_log& axis, const log_header::axis_columns& at) {
        if (at.reference_velocity)
            axis.reference_velocity = std::move(header_.columns[*at.reference_velocity].values);
        if (at.reference_acceleration)
            axis.reference_acceleration = std::move(header_.columns[*at.reference_acceleration].values);
        if (at.velocity) axis.velocity = std::move(header_.columns[*at.velocity].values);
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

/// Reads a log (FORMAT.md) or throws bad_input.
inline machine_log read_log(const std::filesystem::path& path) {
    return detail::log_reader(detail::read_whole(path), path.string()).read();
}
/// Reads the references of a planned motion (t_s, x_ref_m, ...; other columns of the format are left alone) or throws
/// bad_input. Positions are the reference, commands 0.
inline machine_log read_motion(const std::filesystem::path& path) {
    return detail::log_reader(detail::read_whole(path), path.string(), detail::log_purpose::motion).read();
}
inline machine_log read_log(std::istream& in, std::string_view name) {
    return detail::log_reader(detail::read_whole(in, name), name).read();
}

} // namespace quadrant::diagnosis
