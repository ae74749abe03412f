// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "estimated.hpp"
#include "frf.hpp"
#include "quadrant_glitch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <string>
#include <vector>

namespace quadrant::inline v0::analysis {

enum class compensation_size { cannot_tell, wrong_sign, not_at_all, too_weak, right, too_strong };
enum class compensation_time { cannot_tell, too_early, right, too_late };

/// What a friction compensation does at reversals, beside what was needed. In units of the wire that it is
/// added to.
template <signal_tag Command> struct compensation_verdict {
    estimated<quantity_of<Command>> needed;   ///< half the step of the friction at a reversal
    estimated<quantity_of<Command>> supplied; ///< half the step of the compensation
    estimated<double> scale;                  ///< supplied over needed, 1 is right; interval of 95 %
    estimated<duration> late;                 ///< of the compensation behind what was needed; below 0: early
    double explained;      ///< share of the error at reversals that steps of friction explain, 0 ... 1
    std::size_t reversals; ///< that count
    compensation_size size;
    compensation_time time;
    std::string why; ///< it cannot be decided

    std::string text() const {
        constexpr std::array sizes{"undecided", "wrong sign", "not at all", "too weak", "right", "too strong"};
        constexpr std::array times{"", ", too early", ", at the right time", ", too late"};
        const std::string out = std::string(sizes[std::size_t(size)]) + times[std::size_t(time)];
        return why.empty() ? out : out + ": " + why;
    }
};

/// Where the error of a reversal is looked at, and when its compensation counts as right.
struct compensation_options {
    duration window = duration::from_value(0.1); ///< after a reversal; half of it before is its base line
    duration settle{};                           ///< reversals before this are left out
    double scale_tolerance = 0.1;                ///< right: within this of 1; not at all: within this of 0
    duration time_tolerance = duration::from_value(1e-3);
};

namespace detail {
/// Response of a continuous transfer to a sampled signal that is constant before its first sample; standstill
/// cancelled.
template <frequency_response R>
std::vector<double> filtered(const std::vector<double>& x, const R& response, double period) {
    std::size_t n = 2;
    while (n < 2 * x.size()) n *= 2;
    std::vector<complex> bins(n);
    for (std::size_t i = 0; i < x.size(); ++i) bins[i] = x[i] - x[0];
    fft(bins);
    bins[0] = 0; // the integrator cancels what stays
    for (std::size_t k = 1; k < n / 2; ++k) {
        bins[k] *= complex(response(hertz(double(k) / (double(n) * period))));
        bins[n - k] = std::conj(bins[k]);
    }
    bins[n / 2] = 0;
    for (complex& each : bins) each = std::conj(each); // back: conjugate, transform, conjugate
    fft(bins);
    std::vector<double> out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = bins[i].real() / double(n);
    return out;
}
/// Takes mean and slope off.
inline void straighten(std::vector<double>& x) {
    const double n = double(x.size()), middle = 0.5 * (n - 1);
    double mean = 0, slope = 0;
    for (std::size_t i = 0; i < x.size(); ++i) mean += x[i] / n, slope += (double(i) - middle) * x[i];
    slope /= n * (n * n - 1) / 12;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= mean + slope * (double(i) - middle);
}
struct step_found {
    double size, at;  ///< at: samples after the reversal
    double left, all; ///< squares that the step leaves, and all
};
/// The step that through the loop looks most like this stretch of a signal, base line aside.
inline step_found find_step(std::vector<double> signal, const std::vector<double>& step, std::size_t before) {
    straighten(signal);
    const double all = [&] {
        double sum = 0;
        for (const double each : signal) sum += each * each;
        return sum;
    }();
    step_found best{0, 0, all, all};
    const auto try_at = [&](double at) {
        std::vector<double> shape(signal.size());
        for (std::size_t i = 0; i < shape.size(); ++i) {
            const double t = double(i) - double(before) - at;
            if (t <= 0) continue;
            const auto k = std::size_t(t);
            if (k + 1 < step.size()) shape[i] = step[k] + (step[k + 1] - step[k]) * (t - double(k));
        }
        straighten(shape);
        double both = 0, own = 0;
        for (std::size_t i = 0; i < shape.size(); ++i) both += shape[i] * signal[i], own += shape[i] * shape[i];
        if (own > 0 && all - both * both / own < best.left)
            best = {both / own, at, all - both * both / own, all};
    };
    const double reach = 0.8 * double(before); // either way
    for (double at = -reach; at <= reach; at += 1) try_at(at);
    for (double fine = 0.5; fine > 0.01; fine *= 0.5)
        for (const double at : {best.at - fine, best.at + fine}) try_at(at);
    return best;
}
/// Steps of friction at the reversals of a log, and of what a compensation gave: half of each step, their
/// ratio, how much later the compensation came [s].
struct steps_at_reversals {
    std::vector<double> sizes, supplies, scales, lates;
    double left = 0, all = 0; ///< squares that the steps leave, and all
};
/// e: the error, `supplied_error` the part of it that the compensation takes off; `after`: samples of a window.
inline steps_at_reversals find_steps(const std::vector<glitch>& turns, const std::vector<double>& e,
                                     const std::vector<double>& supplied_error, const std::vector<double>& step,
                                     std::size_t after, duration period) {
    const std::size_t before = after / 2;
    steps_at_reversals out;
    for (const glitch& turn : turns) {
        const auto at = std::size_t(std::lround(double(turn.at / period)));
        if (at < before || at + after >= e.size()) continue;
        std::vector<double> bare, supply;
        for (std::size_t i = at - before; i <= at + after; ++i)
            bare.push_back(e[i] + supplied_error[i]), supply.push_back(supplied_error[i]);
        const auto needed = find_step(bare, step, before), given = find_step(supply, step, before);
        out.sizes.push_back(0.5 * turn.direction * needed.size),
            out.supplies.push_back(0.5 * turn.direction * given.size);
        out.scales.push_back(needed.size == 0 ? 0 : given.size / needed.size);
        out.lates.push_back((given.at - needed.at) * period.value());
        out.left += needed.left, out.all += needed.all;
    }
    return out;
}
/// Mean of independent values with its interval.
inline estimated<double> mean_of(const std::vector<double>& x) {
    double mean = 0, squares = 0;
    const double n = double(x.size());
    for (const double each : x) mean += each / n;
    for (const double each : x) squares += (each - mean) * (each - mean);
    const double reach = student_95(n - 1) * std::sqrt(squares / (n * (n - 1)));
    return {mean, mean - reach, mean + reach};
}
/// The words for a scale and a delay with their intervals.
template <signal_tag Command>
void name_size_and_time(compensation_verdict<Command>& out, const compensation_options& options) {
    const double near = options.scale_tolerance, low = out.scale.low, high = out.scale.high;
    using enum compensation_size;
    out.size = high < -near                                                 ? wrong_sign
               : low > -near && high < near                                 ? not_at_all
               : low > 0 && high < 1 - near                                 ? too_weak
               : low > 1 + near                                             ? too_strong
               : low < 1 + near && high > 1 - near && high - low < 4 * near ? right
                                                                            : compensation_size::cannot_tell;
    if (out.size == compensation_size::cannot_tell)
        out.why = "the size differs too much from reversal to reversal";
    if (out.size < too_weak) return;
    const double soon = options.time_tolerance.value(), first = out.late.low.value(),
                 last = out.late.high.value();
    out.time = last < -soon              ? compensation_time::too_early
               : first > soon            ? compensation_time::too_late
               : last - first < 4 * soon ? compensation_time::right
                                         : compensation_time::cannot_tell;
    if (out.time == compensation_time::cannot_tell)
        out.why = "the time differs too much from reversal to reversal";
}
} // namespace detail

/// Whether a friction compensation acts too early, too late, too weak, too strong, right, or not at all, from a
/// log of the
/// loop in which it works: reference, position, and the wire with the compensation, before it is added.
///   e0 = e + H c: the error as it would have been without the compensation c, H = position per command of the closed loop
///   at each reversal both e0 and H c are fitted by a base line and the response to one step of friction, size and time free;
///   scale = size(c)/size(e0), late = time(c) - time(e0), over the reversals
/// Friction that builds up over some displacement instead of at once has the time of its middle; it and the
/// command are compared at the wire, so that a compensation without preview is late by the delay of the plant.
/// An axis that gets its compensation late also breaks away later: `late` is about 0.6 of the shift that would
/// put it right (measured on bristles and on Maxwell-slip springs).
/// H, position per unit of the wire, a model (`p_pi_loop`: plant times sensitivity) or measured, asked for from
/// 1 over the record up to half the sampling rate. Only its product with c enters: where the compensation is
/// right, an error of H falsifies e0 and H c alike.
/// A word is given only where the whole interval (over the reversals, 95 %) lies on one side of the tolerance,
/// or is narrow and meets it (right); else cannot_tell: too few reversals, an error that steps of friction do
/// not explain (share below 0.7), no friction beside the noise, an interval too wide.
/// A reversal with another one in its window is not left out: take the window short enough.
/// Throws as `quadrant_glitches` does, and for a window below 20 periods.
template <signal_tag Command = signal::voltage, frequency_response H>
compensation_verdict<Command> judge_compensation(const std::vector<quantity_of<signal::position>>& reference,
                                                 const std::vector<quantity_of<signal::position>>& position,
                                                 const std::vector<quantity_of<Command>>& compensation,
                                                 const H& response, duration period,
                                                 const compensation_options& options = {}) {
    require(compensation.size() == reference.size(), "judge_compensation.compensation",
            double(compensation.size()),
            "must hold as many samples as reference (" + quadrant::detail::shortest(double(reference.size())) +
                ")");
    require(options.window >= 20.0 * period, "compensation_options.window", options.window,
            "must be 20 periods or more");
    require_positive("compensation_options.scale_tolerance", options.scale_tolerance);
    require_positive("compensation_options.time_tolerance", options.time_tolerance);
    const auto turns = quadrant_glitches(reference, position, period, {options.window, options.settle});
    std::vector<double> c, e, unit(reference.size(), 1);
    for (std::size_t i = 0; i < reference.size(); ++i) {
        require_finite("judge_compensation.compensation", compensation[i]);
        c.push_back(compensation[i].value()), e.push_back((reference[i] - position[i]).value());
    }
    const auto supplied_error = detail::filtered(c, response, period.value());
    unit[0] = 0; // a step behind the first sample
    auto step = detail::filtered(unit, response, period.value());
    step.erase(step.begin());
    const auto after = std::size_t(std::floor(options.window / period + 1e-9));
    const auto steps = detail::find_steps(turns, e, supplied_error, step, after, period);
    using quantity = quantity_of<Command>;
    compensation_verdict<Command> out{};
    out.reversals = steps.sizes.size();
    if (out.reversals < 4) {
        out.why = "fewer than 4 reversals with a whole window";
        return out;
    }
    const auto typed = [](auto unit_of, const estimated<double>& x) {
        using to = decltype(unit_of);
        return estimated<to>{to::from_value(x.value), to::from_value(x.low), to::from_value(x.high)};
    };
    const auto size = detail::mean_of(steps.sizes);
    out.needed = typed(quantity(), size);
    out.supplied = typed(quantity(), detail::mean_of(steps.supplies));
    out.scale = detail::mean_of(steps.scales);
    out.late = typed(duration(), detail::mean_of(steps.lates));
    out.explained = steps.all > 0 ? 1 - steps.left / steps.all : 0;
    if (!(size.low > 0)) {
        out.why = "no friction is seen at the reversals";
        return out;
    }
    if (out.explained < 0.7) {
        out.why = "steps of friction do not explain the error at the reversals";
        return out;
    }
    detail::name_size_and_time(out, options);
    return out;
}

} // namespace quadrant::inline v0::analysis
