// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "import/common_clock.hpp"
#include "import/foreign_table_reader.hpp"
#include "import/integrated.hpp"
#include "import/missing_column.hpp"
#include "import/own_header.hpp"
#include "import/own_text.hpp"
#include "log/angle_wraps.hpp"
#include "log/log_rows.hpp"
#include "read_log.hpp"

namespace quadrant::inline v0::diagnosis {

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
            tables_.push_back(foreign_table_reader(map_, i, files_[i].text, files_[i].name, first_day_).take());
            for (const auto& note : tables_.back().notes) tell(i, note);
        }
        for (std::size_t i = 0; i < tables_.size(); ++i) {
            std::optional<std::vector<unsigned char>> after_gap; // of the rows, where an angle asks for it
            for (foreign_column& c : tables_[i].columns) {
                const bool angle = c.name.ends_with("_pos_rad") || c.name.ends_with("_ref_rad");
                if (!angle) continue;
                if (!after_gap) after_gap = clock_of_rows(tables_[i].t, tables_[i].written).after_gap;
                if (const std::size_t times = unwrap(c.values, *after_gap); times > 0)
                    tell(i, fmt::format("{} starts again {} times within one turn: it goes on here", c.name,
                                        times));
            }
        }
        integrate_velocities(map_, tables_, teller());
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

    tell_of_file teller() {
        return [this](std::size_t file, const std::string& note) { tell(file, note); };
    }

    /// Each row as it stands. What read_log could not take is refused here, with the place in the file.
    void keep_rows() {
        const foreign_table& in = tables_.front();
        std::vector<double> stamps;
        std::vector<std::size_t> rows;
        for (std::size_t k = 0; k < in.t.size(); ++k)
            if (wanted(in.t[k])) stamps.push_back(in.t[k]), rows.push_back(k);
        const auto clock = stamps.size() > 2 ? clock_of_rows(stamps, in.written) : row_clock{.even = true};
        if (!clock.even && clock.spread > most_spread)
            throw bad_input(
                files_.front().name, in.line[rows[clock.worst_step]], 1,
                fmt::format("the step to this stamp is {:.3g} s, and the period {:.3g} s: import with "
                            "--resample{}",
                            stamps[clock.worst_step] - stamps[clock.worst_step - 1], clock.period,
                            clock.worst_step == 1 &&
                                    clock_of_rows(std::span(stamps).subspan(1), in.written).spread <=
                                        most_spread
                                ? fmt::format(", or without the first row (--from {:.6g})", stamps[1])
                                : std::string()));
        own_text out(tables_, false, teller());
        out.head();
        std::vector<double> row;
        for (const std::size_t k : rows) {
            row.clear();
            for (const auto& c : in.columns) row.push_back(c.values[k]);
            out.row(in.t[k], row);
        }
        out_.text = out.take();
    }
    bool wanted(double t) const { return t >= choice_.from_s - 1e-9 && t <= choice_.to_s + 1e-9; }

    /// All files onto one even clock.
    void resample() {
        common_clock clock(map_, files_, choice_, tables_, teller());
        clock.take();
        own_text out(tables_, true, teller());
        out.head();
        std::vector<double> row;
        for (std::size_t k = 0; k < clock.samples(); ++k) {
            if (clock.left_out(k)) continue;
            row.clear();
            for (const auto& table : tables_)
                for (const auto& c : table.columns) row.push_back(c.values[k]);
            out.row(static_cast<double>(k) * clock.period(), row);
        }
        out_.text = out.take();
        if (choice_.resample) replay_is_lost_ = true;
    }

    void finish() {
        if (replay_is_lost_)
            out_.notes.push_back(
                "a controller cannot be replayed sample by sample on a resampled log: leave it out of the "
                "machine file, or changes made by resampling are mistaken for another controller");
        if (!map_.left_out.empty())
            out_.notes.push_back(
                fmt::format("no name of ours: {} {} left out (say with --map which column is what)",
                            some_of(map_.left_out), map_.left_out.size() > 1 ? "are" : "is"));
        const std::string& name = files_.front().name;
        out_.log = read_log_text(out_.text, name);
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
    std::optional<long> first_day_{}; ///< of stamps with a date
    bool replay_is_lost_ = false;     ///< what resampling changed would count as another controller
    imported_log out_{};
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, std::span<const foreign_file> files,
                                                const import_choice& choice) {
    return detail::importer(map, files, choice).take();
}
QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, std::string_view text,
                                                std::string_view name, const import_choice& choice) {
    const foreign_file one[]{{std::string(text), std::string(name)}};
    return import_log(map, one, choice);
}
QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, const std::filesystem::path& path,
                                                const import_choice& choice) {
    return import_log(map, detail::read_whole(path), path.string(), choice);
}

} // namespace quadrant::inline v0::diagnosis
