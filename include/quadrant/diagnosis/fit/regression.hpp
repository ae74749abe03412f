// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/log.hpp"
#include "fit.hpp"
#include "gap_rows.hpp"
#include "scales.hpp"

#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// One number of a regression and its standard deviation between parts of the record.
struct regressed {
    double value = 0, spread = std::numeric_limits<double>::infinity();
    bool sure() const { return std::abs(value) > 4 * spread; }
};

/// What a log says of an axis before there is a machine file, in units of the command:
///   command = acceleration a + speed v + direction sign v + mean + weight sin(q - phase)
/// The last term is asked of a rotary axis only.
struct axis_regression {
    regressed acceleration, speed, direction, mean, weight;
    regressed resists;       ///< direction and mean as one, where the record goes one way: neither is known
    regressed lateness;      ///< of the command behind the motion [s], where it is asked for
    regressed curvature;     ///< the command has so much of its second derivative too much [s2], likewise
    double left = 1;         ///< of the command's variance
    double left_in_time = 1; ///< the same without lateness and curvature
    double phase = 0;        ///< position at which the weight hangs down [rad]
    double band_Hz = 0;      ///< of the low-pass on all signals; 0: nothing can be said

    /// None of the axis' numbers is sure.
    void nothing_of_the_axis() {
        for (regressed* each : {&acceleration, &speed, &direction, &mean, &weight, &resists})
            each->spread = std::numeric_limits<double>::infinity();
    }
};

namespace detail {

/// Variance of the acceleration that white noise of 1 m in a position leaves behind the low-pass.
QUADRANT_DIAGNOSIS_DECL double noise_gain(double band_Hz, double period);
QUADRANT_DIAGNOSIS_DECL double mean_square(const std::vector<double>& x);

/// The widest band of a regression: a tenth of the rate, which is also as fast as a loop that answers once a
/// row can be.
inline double widest_band(double period) { return 0.1 / period; }

/// The band of a regression. Noise in an explaining signal makes its factor too small by the noise's share of
/// the variance, so the noise of the reading is a hundredth of the acceleration's variance at most. Below that
/// limit, three times the frequency that holds 98 % of the velocity's power: faster dynamics are not of the
/// motion. 0: there is no such band. `to_noise`: up to that limit.
QUADRANT_DIAGNOSIS_DECL double regression_band(const axis_log& log, double period, bool to_noise);

/// Normal equations of one part of the record.
struct regression_part {
    Eigen::MatrixXd left;
    Eigen::VectorXd right;
};

} // namespace detail

/// Whether a regression looks for a command that stands by a little later than what it does.
enum class and_lateness {
    no,
    of_motion,     ///< in the band of the motion
    up_to_noise,   ///< in all that stands above noise, where a lateness of less than a row shows
    with_curvature ///< there, and for its second derivative, which tells a low-pass from a delay
};

/// Regression of the command on acceleration, speed, direction and, for a rotary axis, sine and cosine of the
/// position. All signals pass the same zero-phase low-pass first. Rows near rest are left out: friction may
/// have any size there. Lateness: on the command's slope, too, and without rows near a change of direction,
/// where friction builds up late. Curvature: on its second derivative as well.
/// white_noise: of the command [rms of a row], taken out where its derivatives explain.
QUADRANT_DIAGNOSIS_DECL axis_regression regress(const axis_log& log, double period,
                                                and_lateness asked = and_lateness::no, double white_noise = 0);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "regression.ipp"
#endif
