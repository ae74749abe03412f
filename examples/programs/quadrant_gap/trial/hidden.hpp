// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drawn_machine.hpp"
#include "quadrant/diagnosis/effect/effect_list.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

/// Effects that no log of a drive with loops of its own can show: they are not drawn.
namespace quadrant_gap::trial::detail {

/// The log that a machine of this trial would write under given set-points, over its noise: rounding and noise
/// of the encoder, noise or rounding of what is measured behind the loops. Whitened: a sum of squares is a
/// number of chance.
class log_over_noise {
public:
    /// The set-points are those that the true machine gets.
    explicit log_over_noise(const drawn_machine& m)
        : m_(m), set_points_(run({ideal(m.truth[0])}, m.log_reference, m.period, m.noise_seed)[0].command) {}

    std::vector<double> operator()(axis_truth a) const {
        a = ideal(a);
        std::vector<double> reference = set_points_;
        if (a.drive.kind == drive_truth::drive_kind::velocity) { // volts, and no loop around the drive
            a.controller.position_gain = 0;
            reference.assign(1, 0.0);
            for (double u : set_points_)
                reference.push_back(reference.back() + m_.period * a.drive.velocity_per_V * u);
        }
        axis_record r = run({a}, {reference}, m_.period, m_.noise_seed)[0];
        r.position.resize(set_points_.size()); // one reference more than set-points of a velocity drive
        auto out = whitened(r.position);
        const drive_truth& d = m_.described[0].drive;
        const std::vector<double>& tap = d.shows_current() ? r.current : r.duty;
        const axis_truth& file = m_.described[0];
        const double noise = d.shows_current()
                                 ? noise_of_measured * file.controller.limit / file.actuator.force_constant
                                 : rounding_of_duty / std::sqrt(12.0);
        if (d.tapped)
            for (std::size_t k = 0; k < set_points_.size(); ++k) out.push_back(tap[k] / noise);
        return out;
    }

private:
    /// Half of the noise is white, half of it has one pole, and rounding is white: a moving average of that
    /// pole's innovations.
    std::vector<double> whitened(const std::vector<double>& x) const {
        const encoder_truth& e = m_.described[0].encoder;
        const double pole = e.noise_colour, half = e.noise * e.noise / 2,
                     white = half + e.resolution * e.resolution / 12;
        const double power = (1 - pole * pole) * half + (1 + pole * pole) * white, ratio = pole * white / power;
        const double zero = ratio > 0 ? (1 - std::sqrt(1 - 4 * ratio * ratio)) / (2 * ratio) : 0;
        const double innovation = std::sqrt(power / (1 + zero * zero));
        std::vector<double> out;
        double before = 0, last = 0;
        for (double now : x) {
            last = now - pole * before + zero * last;
            before = now;
            out.push_back(last / innovation);
        }
        return out;
    }
    const drawn_machine& m_;
    std::vector<double> set_points_;
};

inline double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// What makes |r - J x|^2 least inside a box, by one number after another.
inline std::vector<double> least_inside(const std::vector<std::vector<double>>& columns,
                                        const std::vector<double>& r, const std::vector<double>& low,
                                        const std::vector<double>& high) {
    const std::size_t n = columns.size();
    std::vector<std::vector<double>> square(n, std::vector<double>(n));
    std::vector<double> x(n, 0.0), slope(n); // slope: J^T (r - J x)
    for (std::size_t i = 0; i < n; ++i) {
        slope[i] = product(columns[i], r);
        for (std::size_t j = 0; j < n; ++j) square[i][j] = product(columns[i], columns[j]);
    }
    for (int sweep = 0; sweep < 20000; ++sweep)
        for (std::size_t i = 0; i < n; ++i) {
            if (!(square[i][i] > 0)) continue;
            const double step = std::clamp(x[i] + slope[i] / square[i][i], low[i], high[i]) - x[i];
            x[i] += step;
            for (std::size_t j = 0; j < n; ++j) slope[j] -= step * square[i][j];
        }
    return x;
}

/// A machine without an effect as an observer may turn it: its numbers from end to end of their tolerances, and
/// where the drive's integral began, which no file knows.
class turned_machine {
public:
    turned_machine(axis_truth without, const tolerances& t) : without_(std::move(without)), tolerances_(t) {}

    bool may_move(std::size_t i) {
        const auto numbers = loose_numbers(without_, tolerances_);
        return i < numbers.size() ? *numbers[i].value != 0 : without_.drive.velocity_integral > 0;
    }
    std::size_t numbers() { return loose_numbers(without_, tolerances_).size() + 1; }
    /// 1: the end of a tolerance; of the integral a hundredth of the largest force.
    double farthest(std::size_t i) { return i + 1 < numbers() ? 1 : 100; }

    axis_truth at(const std::vector<double>& places) const {
        axis_truth a = without_;
        const auto numbers = loose_numbers(a, tolerances_);
        for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i].value *= 1 + numbers[i].share * places[i];
        keep_level_at_rest(a.friction);
        a.drive.began = places.back() * 0.01 * a.controller.limit;
        return a;
    }

private:
    axis_truth without_;
    tolerances tolerances_;
};

/// The natural logarithm of how much more probable the log of the true machine is than the same log from a
/// machine without the effect, at the best numbers that the tolerances of that one allow. Ends early below
/// `enough`. What the search does not find makes this larger than it is.
inline double evidence_against(const drawn_machine& m, const axis_truth& without, double enough) {
    const log_over_noise log(m);
    const std::vector<double> real = log(m.truth[0]);
    turned_machine rival(without, m.tolerance);
    const auto left_at = [&](const std::vector<double>& places) {
        auto rest = log(rival.at(places));
        for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = real[k] - rest[k];
        return rest;
    };
    std::vector<double> places(rival.numbers(), 0.0);
    auto rest = left_at(places);
    double evidence = product(rest, rest) / 2;
    for (int turn = 0; turn < 6 && evidence >= enough; ++turn) {
        std::vector<std::vector<double>> columns;
        std::vector<double> low, high;
        for (std::size_t i = 0; i < places.size(); ++i) {
            low.push_back(-rival.farthest(i) - places[i]);
            high.push_back(rival.farthest(i) - places[i]);
            columns.emplace_back(rest.size(), 0.0);
            if (!rival.may_move(i)) continue;
            auto moved = places;
            const double by = places[i] > 0 ? -0.2 : 0.2;
            moved[i] += by;
            const auto other = left_at(moved);
            for (std::size_t k = 0; k < rest.size(); ++k) columns[i][k] = (rest[k] - other[k]) / by;
        }
        const auto step = least_inside(columns, rest, low, high);
        const double before = evidence;
        for (double part = 1; part > 0.05 && evidence == before; part /= 2) {
            auto tried = places;
            for (std::size_t i = 0; i < tried.size(); ++i) tried[i] += part * step[i];
            auto left = left_at(tried);
            if (const double e = product(left, left) / 2; e < before)
                evidence = e, places = std::move(tried), rest = std::move(left);
        }
        if (!(evidence < 0.98 * before)) break;
    }
    return evidence;
}

/// Whether an observer who knows every law and every other number could be sure of the effect, nineteen to one:
/// it is one name of the list, and its number is found in the rows of the log.
inline bool shows_in_a_log(const drawn_machine& m, const axis_truth& without) {
    const auto names = static_cast<double>(quadrant::diagnosis::every_effect().size()),
               rows = static_cast<double>(m.log_reference[0].size());
    const double enough = std::log(names) + std::log(rows) / 2 + std::log(19.0);
    return evidence_against(m, without, enough) >= enough;
}

} // namespace quadrant_gap::trial::detail
