// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/write_machine.hpp>

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

/// Logs of the machines that the library's blocks come from, each with a machine file that describes the same
/// machine.
namespace sources {

/// One sample of one axis: what was asked, what the encoder read, what the controller answered.
struct row {
    double reference, reading, command; ///< [m], [m], [V] or [A]
};

/// The log of a machine.
struct recording {
    double period = 0; ///< [s]
    struct axis {
        std::string name, unit; ///< of the command: V or A
        std::vector<row> rows;
    };
    std::vector<axis> axes;
};

/// A log, and the machine file that belongs to it.
struct written_case {
    recording log;
    nlohmann::ordered_json machine;
};

/// A case by its name. Nothing runs before `make` is called.
struct log_case {
    std::string name;
    std::function<written_case()> make;
};

inline void write(const recording& what, const std::filesystem::path& to) {
    std::ofstream log(to);
    log << "t_s";
    for (const auto& a : what.axes) log << fmt::format(",{0}_ref_m,{0}_pos_m,{0}_cmd_{1}", a.name, a.unit);
    log << '\n';
    for (std::size_t k = 0; k < what.axes.front().rows.size(); ++k) {
        log << fmt::format("{:.7f}", static_cast<double>(k) * what.period);
        for (const auto& a : what.axes)
            log << fmt::format(",{:.12f},{:.9f},{:.9f}", a.rows[k].reference, a.rows[k].reading,
                               a.rows[k].command);
        log << '\n';
    }
}

/// Writes log.csv and machine.json into a folder.
inline void write(const written_case& c, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write(c.log, folder / "log.csv");
    std::ofstream(folder / "machine.json") << c.machine.dump(2) << '\n';
}

} // namespace sources
