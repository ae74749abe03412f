// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/text/bad_input.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// Which logs a folder holds, and with which machine file each is diagnosed.
namespace quadrant_gap::fleet {

namespace fs = std::filesystem;
using quadrant::diagnosis::bad_input;

struct entry {
    std::string name; ///< of its results, a relative path without suffix
    fs::path machine, log, holdout;
    std::string fault; ///< why it cannot even be begun
    std::uintmax_t bytes = 0;
};

namespace detail {

/// "press/7" for press/7/log.csv and for press/7.log.csv.
inline std::string name_of_log(const fs::path& relative) {
    std::string name = relative.generic_string();
    const auto cut = [&](std::string_view end) {
        if (!name.ends_with(end)) return false;
        name.resize(name.size() - end.size());
        return true;
    };
    if (!cut("/log.csv") && !cut(".log.csv")) cut(".csv");
    return name;
}

/// What belongs to a log: X.machine.json to X.log.csv, machine.json to any log in its folder.
inline std::optional<fs::path> beside(const fs::path& log, const std::string& kind) {
    const std::string name = log.filename().string();
    std::vector<fs::path> places;
    if (name.ends_with(".log.csv"))
        places.push_back(log.parent_path() / (name.substr(0, name.size() - 7) + kind));
    if (kind == "machine.json" || name == "log.csv") places.push_back(log.parent_path() / kind);
    for (const fs::path& place : places)
        if (std::error_code ignored; fs::is_regular_file(place, ignored)) return place;
    return std::nullopt;
}

/// The machine file beside a log, or the nearest machine.json above it, up to the top folder.
inline std::optional<fs::path> machine_of(const fs::path& top, const fs::path& log) {
    if (auto near = beside(log, "machine.json")) return near;
    for (fs::path folder = log.parent_path(); folder != top && folder.has_parent_path();) {
        folder = folder.parent_path();
        if (std::error_code ignored; fs::is_regular_file(folder / "machine.json", ignored))
            return folder / "machine.json";
    }
    return std::nullopt;
}

inline void complete(entry& e, const fs::path& top) {
    std::error_code ignored;
    if (e.holdout.empty()) e.holdout = beside(e.log, "holdout.csv").value_or("");
    if (e.machine.empty()) e.machine = machine_of(top, e.log).value_or("");
    if (e.machine.empty())
        e.fault = fmt::format("{}: no machine file: neither beside it nor a machine.json above it",
                              quadrant::diagnosis::detail::one_line(e.log.string()));
    for (const fs::path& file : {e.log, e.machine, e.holdout})
        if (!file.empty() && fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
            e.fault =
                fmt::format("{}: is no regular file", quadrant::diagnosis::detail::one_line(file.string()));
    const auto bytes = fs::file_size(e.log, ignored);
    e.bytes = ignored ? 0 : bytes;
}

inline std::vector<std::string> cells(std::string line) {
    if (line.ends_with('\r')) line.pop_back();
    std::vector<std::string> out(1);
    for (const char c : line)
        if (c == ',')
            out.emplace_back();
        else
            out.back() += c;
    for (std::string& cell : out) {
        const auto first = cell.find_first_not_of(' ');
        cell = first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1);
    }
    return out;
}

/// Results stay below the folder that they were asked for in.
inline bool stays_below(const std::string& name) {
    const fs::path path(name);
    if (path.empty() || path.is_absolute()) return false;
    return std::none_of(path.begin(), path.end(), [](const fs::path& p) { return p == ".." || p == "."; });
}

/// fleet.csv: a header of log and, as wanted, machine, holdout, name; paths from the folder of the list.
inline std::vector<entry> read_list(const fs::path& top, const fs::path& list) {
    std::ifstream file(list);
    std::string line;
    std::getline(file, line);
    const auto header = cells(line);
    for (std::size_t k = 0; k < header.size(); ++k)
        if (const std::string& h = header[k]; h != "log" && h != "machine" && h != "holdout" && h != "name")
            throw bad_input(list.string(), 1, 1, "column \"" + h + "\" is none of log, machine, holdout, name");
    if (std::find(header.begin(), header.end(), "log") == header.end())
        throw bad_input(list.string(), 1, 1, "no column log");
    std::vector<entry> out;
    for (std::size_t row = 2; std::getline(file, line); ++row) {
        const auto row_cells = cells(line);
        if (row_cells.size() == 1 && row_cells[0].empty()) continue;
        if (row_cells.size() != header.size())
            throw bad_input(list.string(), row, 1,
                            fmt::format("{} cells where the header has {}", row_cells.size(), header.size()));
        entry e;
        for (std::size_t k = 0; k < header.size(); ++k) {
            if (row_cells[k].empty()) continue;
            if (header[k] == "name")
                e.name = row_cells[k];
            else
                (header[k] == "log"       ? e.log
                 : header[k] == "machine" ? e.machine
                                          : e.holdout) = (top / row_cells[k]).lexically_normal();
        }
        if (e.log.empty()) throw bad_input(list.string(), row, 1, "no log");
        if (e.name.empty()) e.name = name_of_log(e.log.lexically_relative(top.lexically_normal()));
        if (!stays_below(e.name))
            throw bad_input(list.string(), row, 1, "needs a name that is a path below the results");
        complete(e, top);
        out.push_back(std::move(e));
    }
    return out;
}

inline std::vector<entry> search(const fs::path& top) {
    std::vector<entry> out;
    std::error_code fault;
    for (fs::recursive_directory_iterator at(top, fs::directory_options::skip_permission_denied, fault), end;
         at != end && !fault; at.increment(fault)) {
        const std::string file = at->path().filename().string();
        std::error_code ignored;
        if (file.starts_with('.')) {
            if (at->is_directory(ignored)) at.disable_recursion_pending();
        } else if ((file == "log.csv" || file.ends_with(".log.csv")) && !at->is_directory(ignored)) {
            entry e;
            e.log = at->path();
            e.name = name_of_log(e.log.lexically_relative(top));
            complete(e, top);
            out.push_back(std::move(e));
        }
    }
    if (fault) throw bad_input(top.string(), "cannot be searched: " + fault.message());
    return out;
}

} // namespace detail

/// Sorted by name. Throws bad_input when there is no log, or two would have results of the same name.
inline std::vector<entry> find_entries(const fs::path& folder) {
    const fs::path top = folder.has_filename() ? folder : folder.parent_path();
    if (std::error_code ignored; !fs::is_directory(top, ignored))
        throw bad_input(folder.string(), "no such folder");
    const fs::path list = top / "fleet.csv";
    auto out = fs::exists(list) ? detail::read_list(top, list) : detail::search(top);
    if (out.empty()) throw bad_input(folder.string(), "no log: neither log.csv nor *.log.csv, at any depth");
    std::sort(out.begin(), out.end(), [](const entry& a, const entry& b) { return a.name < b.name; });
    const auto twice = std::adjacent_find(out.begin(), out.end(),
                                          [](const entry& a, const entry& b) { return a.name == b.name; });
    if (twice != out.end())
        throw bad_input(twice->log.string(),
                        fmt::format("{} would have results of the same name: list them in fleet.csv",
                                    std::next(twice)->log.string()));
    return out;
}

} // namespace quadrant_gap::fleet
