// SPDX-License-Identifier: BSL-1.0
// Long: one class: its steps share the columns and where a refusal points.
#pragma once
#include "import/foreign_table.hpp"
#include "import/own_header.hpp"
#include "import/read_map.hpp"
#include "log/angle_wraps.hpp"
#include "log/even_rows.hpp"
#include "read_log.hpp"

namespace quadrant::inline v0::diagnosis {

/// Another program's log in the words of ours.
struct imported_log {
    machine_log log;                ///< in SI: metres or radians; what read_log makes of the text
    std::string text;               ///< as docs/formats.md writes a log
    std::vector<std::string> notes; ///< what was assumed, and what physics says of it
};

/// What to take of the files, and on which clock.
struct import_choice {
    bool resample = false; ///< onto an even clock; several files always are
    double period_s = 0;   ///< of that clock; 0: the median step of the first file's stamps
    double from_s = 0;     ///< rows before it are left out, counted from the first row of the first file
    double to_s = 1e300;   ///< rows behind it likewise
};

/// A file that was read: its text, and the name by which messages call it.
struct foreign_file {
    std::string text, name;
};

namespace detail {

/// Files of other programs on their way to one log of ours.
class importer {
public:
    importer(const import_map& map, std::span<const foreign_file> files, const import_choice& choice)
        : map_(map), files_(files), choice_(choice) {}

    imported_log take() {
        if (files_.size() != map_.files.size())
            throw bad_input(map_.file,
                            fmt::format("describes {} files; {} are given", map_.files.size(), files_.size()));
        for (std::size_t i = 0; i < files_.size(); ++i) {
            tables_.push_back(foreign_table_reader(map_, i, files_[i].text, files_[i].name).take());
            for (const auto& note : tables_.back().notes) tell(i, note);
        }
        for (std::size_t i = 0; i < tables_.size(); ++i)
            for (foreign_column& c : tables_[i].columns) {
                const bool angle = c.name.ends_with("_pos_rad") || c.name.ends_with("_ref_rad");
                if (const std::size_t times = angle ? unwrap(c.values) : 0; times > 0)
                    tell(i, fmt::format("{} starts again {} times within one turn: it goes on here", c.name,
                                        times));
            }
        integrate_velocities();
        const double zero = tables_.front().t.front();
        for (auto& table : tables_)
            for (double& t : table.t) t -= zero;
        if (choice_.resample || choice_.period_s > 0 || files_.size() > 1)
            resample();
        else
            keep_rows();
        finish();
        return std::move(out_);
    }

private:
    void tell(std::size_t file, const std::string& note) {
        out_.notes.push_back(files_.size() > 1 ? one_line(files_[file].name) + ": " + note : note);
    }

    /// Of an axis without a position: the integral of its velocity, from zero at the first row.
    void integrate_velocities() {
        for (const auto& a : map_.axes) {
            if (a.find(signal_role::position)) continue;
            const import_map::source& v = *a.find(signal_role::velocity);
            const std::string name = a.name + "_vel_" + v.si;
            foreign_table& table = tables_[v.file];
            const auto from = std::find_if(table.columns.begin(), table.columns.end(),
                                           [&](const foreign_column& c) { return c.name == name; });
            const std::string unit = v.si.substr(0, v.si.find('_'));
            foreign_column x{a.name + "_pos_" + unit, from->index, from->factor};
            std::vector<double> steps;
            for (std::size_t k = 0; k < table.t.size(); ++k) {
                const double step = k == 0 ? 0 : table.t[k] - table.t[k - 1];
                if (k > 0) steps.push_back(step);
                x.values.push_back(
                    k == 0 ? 0 : x.values.back() + 0.5 * step * (from->values[k - 1] + from->values[k]));
            }
            std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                             steps.end());
            const double most =
                std::abs(*std::max_element(from->values.begin(), from->values.end(),
                                           [](double p, double q) { return std::abs(p) < std::abs(q); }));
            const double digit = from->step() > 0 ? from->step() : 1e-9 * most;
            x.factor = digit > 0 ? 0.5 * digit * steps[steps.size() / 2] : 1; // of the speed over half a row
            x.written.add("1", 1);
            tell(v.file,
                 fmt::format("axis {}: no position: the integral of {} stands for it, zero at the first "
                             "row; an error of the velocity adds up in it",
                             a.name, name));
            table.columns.push_back(std::move(x));
        }
    }

    /// Each row as it stands. What read_log could not take is refused here, with the place in the file.
    void keep_rows() {
        const foreign_table& in = tables_.front();
        const auto clock = clock_of_rows(in.t, in.written);
        if (!clock.even && clock.spread > most_spread)
            throw bad_input(
                files_.front().name, in.line[clock.worst], 1,
                fmt::format("the stamps jitter by {:.2g} of the period of {:.4g} s, here most: import "
                            "with --resample",
                            clock.jitter, clock.period));
        head();
        std::vector<double> row;
        for (std::size_t k = 0; k < in.t.size(); ++k) {
            if (!wanted(in.t[k])) continue;
            row.clear();
            for (const auto& c : in.columns) row.push_back(c.values[k]);
            write_row(in.t[k], row);
        }
    }
    bool wanted(double t) const { return t >= choice_.from_s - 1e-9 && t <= choice_.to_s + 1e-9; }

    /// All files onto one even clock, that of the first file's rows or of the period that was asked for.
    void resample() {
        const foreign_table& first = tables_.front();
        const double period = choice_.period_s > 0 ? choice_.period_s : usual_period(first);
        double begin = std::max(0.0, choice_.from_s), end = std::min(first.t.back(), choice_.to_s);
        for (const auto& table : tables_) {
            begin = std::max(begin, table.t.front());
            end = std::min(end, table.t.back());
        }
        begin = period * std::ceil(begin / period - 1e-6);
        if (!(end - begin > 2 * period))
            throw bad_input(files_.back().name,
                            fmt::format("the files have no time in common, or --from and --to "
                                        "leave none: {:.6g} to {:.6g} s",
                                        begin, end));
        constexpr double most = 100; // samples for each row: more is a pause, or a period that is not meant
        if ((end - begin) / period > most * static_cast<double>(first.t.size()))
            throw bad_input(
                files_.front().name,
                fmt::format("{:.3g} s at a period of {:.3g} s are far more samples than its {} rows: take a "
                            "part with --from and --to, or give --sample-period",
                            end - begin, period, first.t.size()));
        samples_ = static_cast<std::size_t>(std::floor((end - begin) / period + 1e-6)) + 1;
        left_out_.assign(samples_, 0);
        for (std::size_t i = 0; i < tables_.size(); ++i) resample(i, begin, period);
        head();
        std::vector<double> row;
        for (std::size_t k = 0; k < samples_; ++k) {
            if (left_out_[k]) continue;
            row.clear();
            for (const auto& table : tables_)
                for (const auto& c : table.columns) row.push_back(c.values[k]);
            write_row(static_cast<double>(k) * period, row);
        }
    }
    /// The period of rows that are even, else the median step of their stamps.
    static double usual_period(const foreign_table& table) {
        const auto clock = clock_of_rows(table.t, table.written);
        if (clock.even && clock.gaps == 0) return clock.period;
        std::vector<double> steps;
        for (std::size_t k = 1; k < table.t.size(); ++k) steps.push_back(table.t[k] - table.t[k - 1]);
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::nth_element(steps.begin(), middle, steps.end());
        return *middle > 0 ? *middle : clock.period;
    }
    void resample(std::size_t file, double begin, double period) {
        foreign_table& table = tables_[file];
        const auto clock = clock_of_rows(table.t, table.written);
        // Rows that are even are evener than their stamps, unless the stamps are asked to count.
        const bool by_row =
            clock.even && clock.gaps == 0 && (!choice_.resample || table.written > 0.01 * clock.period);
        std::vector<double> at;
        for (std::size_t k = 0; k < table.t.size(); ++k) {
            const double t = by_row ? table.t[0] + static_cast<double>(k) * clock.period : table.t[k];
            at.push_back((t - begin) / period);
        }
        std::vector<unsigned char> apart = clock.after_gap;
        if (choice_.period_s > 0) // on a slower clock a gap is what leaves samples of that clock out
            for (std::size_t k = 1; k < apart.size(); ++k)
                if (table.t[k] - table.t[k - 1] <= longest_step * period) apart[k] = 0;
        const even_rows rows(std::move(at), std::move(apart), samples_);
        const auto left = rows.left_out();
        tell_clock(file, clock, period);
        for (std::size_t k = 0; k < samples_; ++k) left_out_[k] |= left[k];
        for (auto& c : table.columns) resample(file, table, rows, c);
    }
    void resample(std::size_t file, const foreign_table& table, const even_rows& rows, foreign_column& c) {
        if (is_held(c.name)) {
            c.values = rows.held(c.values);
            return;
        }
        const bool position = c.name.find("_pos_") != c.name.npos;
        wrong_readings found;
        if (position) {
            found = reading_check(table.t, c.values, observed_count(c.values, c.step())).take();
            if (found.wrong + found.stale > 0)
                tell(file, fmt::format("{}: {} wrong and {} repeated readings are left out", c.name,
                                       found.wrong, found.stale));
            const auto left = rows.left_out(found.bad);
            for (std::size_t k = 0; k < samples_; ++k) left_out_[k] |= left[k];
        }
        const std::span<const unsigned char> bad = found.bad;
        if (const double error = position ? rows.interpolation_error(c.values, bad) : 0; error > 0)
            tell(file,
                 fmt::format("{}: resampling makes an error of at most about {:.2g} {} rms (what the curvature "
                             "adds between rows); a stamp that is itself wrong adds the speed times its error",
                             c.name, error, c.name.ends_with("rad") ? "rad" : "m"));
        c.values = rows.smooth(c.values, bad);
    }
    void tell_clock(std::size_t file, const row_clock& clock, double period) {
        if (!map_.files[file].time && std::abs(clock.period / period - 1) < 1e-9)
            return; // the rows as they are
        tell(file, fmt::format(
                       "resampled onto a period of {:.6g} s; its rows come every {:.6g} s, single steps up to "
                       "{:.2g} % off, with {} gaps ({} rows missing)",
                       period, clock.period, 100 * clock.spread, clock.gaps, clock.missing));
        tell_of_pieces(file, clock);
    }
    /// Where rows are missing every other moment, the clock on which they are not.
    void tell_of_pieces(std::size_t file, const row_clock& clock) {
        const auto& t = tables_[file].t;
        constexpr std::size_t many = 30; // rows from gap to gap, below which the pieces are too short to use
        if (choice_.period_s > 0 || clock.gaps < 3 || t.size() > many * clock.gaps) return;
        std::vector<double> steps; // across the gaps
        for (std::size_t k = 1; k < t.size(); ++k)
            if (clock.after_gap[k]) steps.push_back(t[k] - t[k - 1]);
        if (steps.empty()) return;
        const auto at = steps.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(steps.size()));
        std::nth_element(steps.begin(), at, steps.end());
        tell(file, fmt::format("rows are missing every {} rows or so: --sample-period {:.2g} bridges most of "
                               "the gaps",
                               t.size() / clock.gaps, 1.05 * *at / longest_step));
    }
    static constexpr double longest_step = 1.5; ///< of the period: a longer one leaves a sample out

    static bool is_held(const std::string& name) {
        for (const signal_kind& kind : signal_kinds)
            if (kind.held && name.find(kind.infix) != name.npos) return true;
        return false;
    }

    static constexpr int most_decimals = 15;

    /// Digits behind the point that a column needs; no more than it had, where its factor is a power of ten, so
    /// that its rounding is still seen. What was resampled has digits of its own.
    std::pair<int, bool> decimals(const foreign_column& c) const {
        const double step = c.written.step() > 0 ? c.written.step() : 1,
                     power = -std::log10(step * std::abs(c.factor));
        const bool exact = samples_ == 0 && std::abs(power - std::round(power)) < 1e-9;
        constexpr int guard = 3;
        return {std::clamp(static_cast<int>(exact ? std::round(power) : std::ceil(power) + guard), 0,
                           most_decimals),
                exact};
    }
    void head() {
        out_.text = "t_s";
        for (std::size_t i = 0; i < tables_.size(); ++i)
            for (const auto& c : tables_[i].columns) {
                out_.text += ',' + c.name;
                const auto [d, exact] = decimals(c);
                digits_.push_back(d);
                if (!exact && c.step() > 0 && d < most_decimals) // 15 digits are no rounding to speak of
                    tell(i, fmt::format("{} is written with {} decimals; its own rounding is {:.3g}", c.name, d,
                                        c.step()));
            }
        out_.text += '\n';
    }
    void write_row(double t, const std::vector<double>& row) {
        out_.text += fmt::format("{:.9f}", t);
        for (std::size_t i = 0; i < row.size(); ++i) out_.text += fmt::format(",{:.{}f}", row[i], digits_[i]);
        out_.text += '\n';
    }

    void finish() {
        if (samples_ > 0 && choice_.resample)
            out_.notes.push_back(
                "a controller cannot be replayed sample by sample on a resampled log: leave it out of the "
                "machine file, or what resampling changed is taken for another controller");
        const std::string& name = files_.front().name;
        out_.log = log_reader(out_.text, name).read();
        const std::string before = one_line(name) + ": ";
        for (std::string note : out_.log.notes) {
            if (note.starts_with(before)) note.erase(0, before.size());
            if (note.ends_with('.')) note.pop_back();
            out_.notes.push_back(note);
        }
        std::string measured;
        for (const auto& a : map_.axes)
            if (a.command_is == command_origin::measured) measured += (measured.empty() ? "" : ", ") + a.name;
        if (!measured.empty())
            out_.notes.push_back(fmt::format("axis {}: the command is a measured one: the machine file needs "
                                             "\"command_is\": \"measured\" under actuator (init --command-is "
                                             "measured writes it)",
                                             measured));
    }

    const import_map& map_;
    std::span<const foreign_file> files_;
    const import_choice& choice_;
    std::vector<foreign_table> tables_{};
    std::vector<int> digits_{};
    std::size_t samples_ = 0; ///< of the even clock; 0: the rows stay as they are
    std::vector<unsigned char> left_out_{};
    imported_log out_{};
};

} // namespace detail

/// Reads other programs' files through a map and joins them on time: columns renamed, numbers in SI. Rows stay
/// as they are, or are resampled onto an even clock. Rows may be missing; a number that is none, a column that
/// is not there, a stamp that goes back: bad_input with file, line and column.
inline imported_log import_log(const import_map& map, std::span<const foreign_file> files,
                               const import_choice& choice = {}) {
    return detail::importer(map, files, choice).take();
}
inline imported_log import_log(const import_map& map, std::string_view text, std::string_view name,
                               const import_choice& choice = {}) {
    const foreign_file one[]{{std::string(text), std::string(name)}};
    return import_log(map, one, choice);
}
inline imported_log import_log(const import_map& map, const std::filesystem::path& path,
                               const import_choice& choice = {}) {
    return import_log(map, detail::read_whole(path), path.string(), choice);
}

} // namespace quadrant::inline v0::diagnosis
