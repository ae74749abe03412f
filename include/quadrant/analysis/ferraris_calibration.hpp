// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::analysis {

/// What a record says of an acceleration sensor: acceleration = gain m + offset, m its voltage.
struct ferraris_calibration {
    gain_of<signal::acceleration, signal::voltage> gain{};
    quantity_of<signal::acceleration> offset{};
    quantity_of<signal::velocity> start_velocity{}; ///< of the record
    quantity_of<signal::position> start_position{};
    quantity_of<signal::position> residual{};   ///< rms of what the fit leaves
    quantity_of<signal::position> excitation{}; ///< rms of the motion that no offset could imitate
    gain_of<signal::acceleration, signal::voltage>
        gain_deviation{}; ///< standard deviation, for a white residual
    quantity_of<signal::acceleration> offset_deviation{};

    /// The gain is distinguishable from the offset: the motion beyond a parabola stands ten times above what is
    /// unexplained.
    bool determined() const noexcept { return excitation.value() > 10 * residual.value(); }
    quantity_of<signal::acceleration> acceleration(quantity_of<signal::voltage> m) const noexcept {
        return gain * m + offset;
    }
};

/// Calibrates an acceleration sensor against the encoder while the axis moves (not at constant speed or
/// acceleration).
///   position = G double-integral(m) + Z t^2/2 + v0 t + p0, by least squares; the integral for m straight between samples
/// Source: [Jamaludin2008] Appendix B. Allocates; for after a run, not for a loop.
/// Range: at least 8 samples; 1e-4 of the gain up to 1/200 of the sampling rate (the straight line between
/// samples leaves (w T)^2/12). If !determined(), record a motion with more acceleration in it: a sine or chirp
/// of some hertz, as large as the axis allows. Throws "calibrate_ferraris.<field> = ...: must ..." for period,
/// samples, position, sensor.
inline ferraris_calibration calibrate_ferraris(std::span<const quantity_of<signal::position>> position,
                                               std::span<const quantity_of<signal::voltage>> sensor,
                                               duration period) {
    require_positive("calibrate_ferraris.period", period);
    const std::size_t n = position.size();
    require(n >= 8, "calibrate_ferraris.samples", double(n), "must be at least 8");
    require(sensor.size() == n, "calibrate_ferraris.samples", double(sensor.size()),
            "must be as many for the sensor as for the position (" + quadrant::detail::shortest(double(n)) +
                ")");
    const double T = period.value(), end = T * double(n - 1);
    std::vector<double> way(n); // the double integral
    double speed = 0, furthest = 0, squares = 0;
    for (std::size_t k = 0; k < n; ++k) {
        require_finite("calibrate_ferraris.position", position[k]);
        require_finite("calibrate_ferraris.sensor", sensor[k]);
        if (k == 0) continue;
        const double before = sensor[k - 1].value(), now = sensor[k].value();
        way[k] = way[k - 1] + T * speed + T * T * (before / 3 + now / 6);
        speed += T * (before + now) / 2;
        furthest = std::max(furthest, std::abs(way[k])), squares += way[k] * way[k];
    }
    // Unknowns: p0, v0, Z in units of the record's length, G in units of the largest displacement where it is
    // one of them.
    const auto fit = [&](bool with_gain, const auto& of) {
        least_squares equations(with_gain ? 4 : 3);
        for (std::size_t k = 0; k < n; ++k) {
            const double t = double(k) / double(n - 1);
            std::vector<double> row{1, t, t * t / 2};
            if (with_gain) row.push_back(way[k] / furthest);
            equations.add(row, of(k));
        }
        return equations.solve();
    };
    const bool parabola = // the integral too, to rounding: no gain can be identified
        !(furthest > 0) || !(fit(false, [&](std::size_t k) { return way[k]; }).residual > 1e-20 * squares);
    const auto found = fit(!parabola, [&](std::size_t k) { return position[k].value(); });
    const double deviation = std::sqrt(found.residual / double(n - 4));
    ferraris_calibration c;
    using boost::units::si::meter;
    c.start_position = found.x[0] * meter;
    c.start_velocity = decltype(c.start_velocity)::from_value(found.x[1] / end);
    c.offset = decltype(c.offset)::from_value(found.x[2] / (end * end));
    c.residual = deviation * meter;
    if (parabola) return c;
    const double spread =
        std::sqrt(found.inverse_diagonal[3]); // its inverse: length of what no parabola explains
    c.gain = decltype(c.gain)::from_value(found.x[3] / furthest);
    c.excitation = std::abs(found.x[3]) / (spread * std::sqrt(double(n))) * meter;
    c.gain_deviation = decltype(c.gain)::from_value(deviation * spread / furthest);
    c.offset_deviation =
        decltype(c.offset)::from_value(deviation * std::sqrt(found.inverse_diagonal[2]) / (end * end));
    return c;
}

} // namespace quadrant::inline v0::analysis
