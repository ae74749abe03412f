// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../plant/backlash.hpp"
#include "../fit/scales.hpp"

/// Two positions of one axis, one behind the other: what was asked or counted, and what the scale reads.
namespace quadrant::inline v0::diagnosis::chain {

/// One link of the chain, both readings in units of the load.
struct position_link {
    double period = 0;
    std::vector<double> first{}; ///< asked, counted, or read on the motor [m]
    std::vector<double> last{};  ///< read behind it [m]
    double first_count = 0, last_count = 0;
    std::vector<unsigned char> left_out{}; ///< of each row; empty: every row counts
    /// Whether the first is what was asked, so that the last may follow it late.
    bool asked = false;
    /// Whether gears lie between the two: play, pitch and spring.
    bool geared = true;
    double turn = 0; ///< travel of one turn of the motor; 0: not known [m]
    /// Force behind the motor's mass, before the motor's friction [N], and the direction of the motor, both as
    /// smooth as the difference; empty: no force is known.
    std::vector<double> force{}, motor_direction{};
    double force_band_Hz = 0; ///< to which force and difference are smoothed; 0: they are not
    double force_doubt = 0;   ///< relative, how well the owner knows force constant and mass
    double motor_mass = 0;    ///< whose inertia is off the force [kg]
    double compliance = 0;    ///< 1 / stiffness, as described; 0: not known [m/N]

    std::size_t rows() const { return first.size(); }
    double travel() const {
        const auto [low, high] = std::minmax_element(first.begin(), first.end());
        return *high - *low;
    }
    double middle() const {
        const auto [low, high] = std::minmax_element(first.begin(), first.end());
        return (*high + *low) / 2;
    }
    /// Rounding of the difference; what was asked is asked as it stands [m].
    double rounding() const { return asked ? last_count : std::hypot(first_count, last_count); }
    /// Noise of the difference of two right readings: rounding, or what no smooth motion explains; where the
    /// first stands still often enough, what is left there, since at a low rate an error that repeats along the
    /// travel looks like noise [m].
    double noise() const {
        constexpr std::size_t enough = 32;
        std::vector<double> d(rows());
        for (std::size_t k = 0; k < rows(); ++k) d[k] = last[k] - first[k];
        const double moving = detail::reading_noise(d, rounding());
        double sum = 0;
        std::size_t still = 0;
        for (std::size_t k = 0; k + 3 < rows(); ++k) {
            if (first[k] != first[k + 1] || first[k] != first[k + 2] || first[k] != first[k + 3]) continue;
            const double e = d[k + 3] - d[k] + 3 * (d[k + 1] - d[k + 2]);
            sum += e * e / 20;
            ++still;
        }
        if (still < enough) return moving;
        return std::min(moving,
                        std::max(std::sqrt(sum / static_cast<double>(still)), rounding() / std::sqrt(12.0)));
    }
    /// The coarser of the counts that are readings [m].
    double count() const { return asked ? last_count : std::max(first_count, last_count); }
};

/// What lies behind a play of this width, held by friction, and whether it is known yet: before the first drive
/// through the whole play it may stand anywhere in it.
struct behind_play {
    std::vector<double> offset; ///< beside the motion that drives it [m]
    std::size_t known_from = 0; ///< row
};
/// The same, of a motion x.
inline behind_play play_of(std::span<const double> x, double width) {
    behind_play out{std::vector<double>(x.size(), 0.0), x.size()};
    if (x.empty()) return out;
    using length = quantity<si::length>;
    backlash<> play({.width = length::from_value(width)}, duration::from_value(1)); // it needs no period
    play.settle(length::from_value(x[0]));
    double low = x[0], high = x[0];
    for (std::size_t k = 0; k < x.size(); ++k) {
        out.offset[k] = play(length::from_value(x[k])).value() - x[k];
        low = std::min(low, x[k]);
        high = std::max(high, x[k]);
        if (out.known_from == x.size() && high - low > width) out.known_from = k;
    }
    return out;
}

/// A signal that is held from row to row, `late` seconds later: its mean over the period of each row.
inline std::vector<double> held_later(std::span<const double> x, double period, double late) {
    std::vector<double> out(x.begin(), x.end());
    const double rows = late / period, whole = std::floor(rows), part = rows - whole;
    const auto at = [&](std::ptrdiff_t k) {
        return x[static_cast<std::size_t>(std::max<std::ptrdiff_t>(k, 0))];
    };
    for (std::size_t k = 0; k < x.size(); ++k) {
        const auto from = static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(whole);
        out[k] = (1 - part) * at(from) + part * at(from - 1);
    }
    return out;
}

/// The cubic through four rows, from the second of them on, in periods: between rows that are tens of
/// milliseconds apart a motion is no straight line. Where the four rows rise, or fall, it stays between the two
/// in the middle: an overshoot at a stop would drive a play through.
struct between_rows {
    double at_row, once, twice, thrice; ///< coefficients of s^0 to s^3
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

    /// Between row k and k + 1.
    between_rows(std::span<const double> x, std::ptrdiff_t k) {
        const auto at = [&](std::ptrdiff_t i) {
            return x[static_cast<std::size_t>(
                std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(x.size()) - 1))];
        };
        const double a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
        at_row = b;
        once = -a / 3 - b / 2 + c - d / 6;
        twice = a / 2 - b + c / 2;
        thrice = (d - a) / 6 + (b - c) / 2;
        const bool rises = a <= b && b <= c && c <= d, falls = a >= b && b >= c && c >= d;
        if (rises || falls) low = std::min(b, c), high = std::max(b, c);
    }
    double operator()(double s) const {
        return std::clamp(at_row + s * (once + s * (twice + s * thrice)), low, high);
    }
    /// What is at rest behind a first-order lag of `lag` periods while this goes on: the part of its answer
    /// that does not depend on where it began.
    double lagged(double s, double lag) const {
        const double first = once + s * (2 * twice + s * 3 * thrice), second = 2 * twice + s * 6 * thrice;
        return (*this)(s)-lag * (first - lag * (second - lag * 6 * thrice));
    }
};

/// What goes after x by at most so much from row to row.
inline std::vector<double> at_most_as_fast(std::span<const double> x, double a_row) {
    std::vector<double> out(x.begin(), x.end());
    for (std::size_t k = 1; k < out.size(); ++k)
        out[k] = out[k - 1] + std::clamp(x[k] - out[k - 1], -a_row, a_row);
    return out;
}

/// What x was `delay` seconds before.
inline std::vector<double> delayed(std::span<const double> x, double period, double delay) {
    std::vector<double> out(x.begin(), x.end());
    if (!(delay > 0)) return out;
    const double rows = delay / period, whole = std::ceil(rows);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const auto from = static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(whole);
        out[k] = between_rows(x, from)(whole - rows);
    }
    return out;
}

/// What follows x with a first-order lag: a position loop of gain 1 / lag.
inline std::vector<double> lagged(std::span<const double> x, double period, double lag) {
    std::vector<double> out(x.begin(), x.end());
    if (!(lag > 0)) return out;
    const double rows = lag / period;
    const double keeps = std::exp(-1 / rows);
    for (std::size_t k = 1; k < x.size(); ++k) {
        const between_rows in(x, static_cast<std::ptrdiff_t>(k) - 1);
        out[k] = in.lagged(1, rows) + keeps * (out[k - 1] - in.lagged(0, rows));
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::chain
