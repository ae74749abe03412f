// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"
#include "decimated.hpp"

#include <quadrant/path/point.hpp>

#include <string>
#include <vector>

/// What a run of the virtual machine leaves behind; SI. Its size does not grow with the program.
namespace quadrant_cnc {

/// The largest magnitude of a signal, and where it was.
struct extreme {
    double most = 0, time = 0;
    std::size_t line = 0; ///< of the program
    void add(double value, double t, std::size_t at_line) {
        if (std::abs(value) > most) most = std::abs(value), time = t, line = at_line;
    }
};

/// The same, and its mean square.
struct extreme_and_mean : extreme {
    double squares = 0;
    void add(double value, double t, std::size_t at_line) {
        squares += value * value;
        extreme::add(value, t, at_line);
    }
    double rms(std::size_t samples) const { return samples > 0 ? std::sqrt(squares / double(samples)) : 0; }
};

struct axis_outcome {
    std::string name, effort_unit;
    double effort_limit = unlimited;
    extreme_and_mean error{};                   ///< reference minus table [m]
    extreme_and_mean effort{};                  ///< current [A] or command [V]
    extreme velocity{}, acceleration{}, jerk{}; ///< that the trajectory asked for
    std::size_t limited = 0;                    ///< periods
};

/// One place of the path and how far the table was from it, in the plane of x and y, unless magnified in true
/// proportion.
struct contour_sample {
    quadrant::path::point path, foot,
        off; ///< where the reference is on the path; nearest place; from there to the table
};

struct run_outcome {
    std::string cnc_file, path_file;
    double period = 0, duration = 0, path_length = 0;
    std::size_t samples = 0, moves = 0, lines = 0;
    extreme_and_mean contour; ///< distance to the path [m]
    quadrant::path::point worst_place;
    std::vector<axis_outcome> axes;
    std::vector<std::string> notes;
    double wall_time = 0, cpu_time = 0; ///< of computing [s]

    /// For a page only (`kept_for::pages`). The contour error, then for each axis: error, velocity,
    /// acceleration, jerk, effort.
    decimated signals{1};
    static constexpr std::size_t of_axis = 5;
    heaviest<contour_sample> contour_plot{6000};
    std::vector<contour_sample> worst; ///< around the largest contour error, one a period

    double faster_than_real_time() const { return cpu_time > 0 ? duration / cpu_time : 0; }
};

} // namespace quadrant_cnc
