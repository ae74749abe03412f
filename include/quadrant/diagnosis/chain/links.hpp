// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/log.hpp"
#include "../machine/machine.hpp"
#include "../text/bad_input.hpp"
#include "fit.hpp"

#include <fmt/format.h>

/// The links of an axis: which two positions are compared, in which units, and with which force.
namespace quadrant::inline v0::diagnosis::chain {

/// A link with what is described of it, and where its ends are.
struct described_link {
    position_link readings;
    link_model described{};
    std::string from{}, to{}; ///< in words
    double to_load = 1;       ///< units of the load for one of the column that `first` comes from
    bool motor_turns = false; ///< that column is in radians of the motor

    /// How fast the link's first reading goes for a set-point that goes at 1.
    double set_point_to_load() const { return readings.geared ? std::abs(to_load) : 1; }
};

/// Slope of y over x by least squares.
QUADRANT_DIAGNOSIS_DECL double slope(std::span<const double> x, std::span<const double> y);

/// What the machine file says of the gears of an axis.
QUADRANT_DIAGNOSIS_DECL link_model described_gears(const axis_description& axis);

/// The motor's reading in units of the load; refuses one that the machine file cannot turn into those, or that
/// moves otherwise than the scale by far more than any machine is wrong.
QUADRANT_DIAGNOSIS_DECL double motor_to_load(const axis_description& axis, const axis_log& log,
                                             const std::string& file);

/// A column in other units.
QUADRANT_DIAGNOSIS_DECL std::vector<double> scaled(std::span<const double> x, double by);

/// The link from the motor's encoder to the scale.
QUADRANT_DIAGNOSIS_DECL described_link motor_to_scale(const axis_description& axis, const axis_log& log,
                                                      double period, const std::string& file);

/// The link from what was asked to a reading.
QUADRANT_DIAGNOSIS_DECL described_link asked_to(const axis_description& axis, const axis_log& log,
                                                double period, const std::vector<double>& reached, double count,
                                                bool geared);

/// The force behind the motor's mass on the link from motor to scale: command times force constant, as late as
/// it acts, less what moves the motor. Smoothed to the band in which the record shows forces.
QUADRANT_DIAGNOSIS_DECL void give_force(described_link& d, const axis_description& axis, const axis_log& log);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "links.ipp"
#endif
