// SPDX-License-Identifier: BSL-1.0
// The trials of a fuzzy tuning: the axis along a stroke, and its linear part in the frequency domain.
#include "tuning.hpp"

#include "linear_loop.hpp"
#include "program.hpp"

#include <quadrant/analysis/margins.hpp>
#include <quadrant/diagnosis/text/text.hpp>

namespace quadrant_cnc {

namespace an = quadrant::analysis;

namespace {

using quadrant::signal::position;
using quadrant::signal::velocity;
using quadrant::signal::voltage;
using gain_value = gain_of<voltage, velocity>;
using adaptation_value = gain_of<voltage, position>;

constexpr const char *gain_key = "gain_V_s_per_m", *adaptation_key = "adaptation_V_per_m";

[[noreturn]] void refuse(const cnc_description& cnc, const std::string& why) {
    throw quadrant::diagnosis::bad_input(cnc.file, why);
}

/// The stroke and its return, with the profile and the limits of the file.
std::vector<axis_motion<>> references(const cnc_description& cnc, const axis_description& a,
                                      const trial_stroke& stroke) {
    const auto drive = std::make_unique<quadrant::trajectory::interpolator<8>>(
        quadrant::trajectory::interpolator<8>::parameters{program::limits_of(cnc), program::kind_of(cnc)},
        in_si(cnc.servo_period_s));
    quadrant::path::point there{};
    there[int(a.axis)] = stroke.length_m;
    drive->push({.path = quadrant::path::line({}, there), .feed = stroke.feed_m_per_s, .line = 1});
    drive->push({.path = quadrant::path::line(there, {}), .feed = stroke.feed_m_per_s, .line = 2});
    std::vector<axis_motion<>> out;
    while (!drive->done()) {
        const auto& m = (*drive)().axis[a.axis];
        out.push_back({m.position, m.velocity, m.acceleration});
    }
    return out;
}

axis_description with(axis_description a, double gain, double adaptation) {
    a.law.set(gain_key, gain);
    a.law.set(adaptation_key, adaptation);
    return a;
}

stroke_record along(const axis_description& a, double period, std::uint64_t seed,
                    const std::vector<axis_motion<>>& asked) {
    axis_loop loop(a, period, seed);
    loop.rest();
    stroke_record out;
    for (const axis_motion<>& m : asked) {
        const an::loop_sample s = loop.step(m, 0);
        out.error_m.push_back(s.due - s.position);
        out.command_V.push_back(s.command);
    }
    return out;
}

/// Of the linear part, with half a period more delay as in the trial of the source; NaN: none above 0.
double phase_margin(const axis_description& a, double period, std::uint64_t seed) {
    axis_loop linear(linear_part(a), period, seed);
    const an::impulse_test test(linear, in_si(period), 1, 1e-6);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!test.decays()) return none;
    const auto later = [&](frequency f) {
        return test.open(f) * std::polar(1.0, -std::numbers::pi * f.value() * period);
    };
    const auto m = an::margins(later, {2e-3 * test.nyquist(), 0.998 * test.nyquist(), 150}).smallest_phase();
    return m && m->value > 0 ? m->value : none;
}

} // namespace

axis_tuning tune_axis(const cnc_description& cnc, const axis_description& a, const trial_stroke& stroke) {
    if (a.law.kind != "sliding_mode")
        refuse(cnc, fmt::format("{}.control.law: the rules tune sliding_mode, not {}; for gains of a cascade "
                                "see quadrant-cnc analyse --frf",
                                a.path, a.law.kind));
    if (stroke.length_m > a.to_m - a.from_m)
        refuse(cnc, fmt::format("{}.travel_m: holds no stroke of {:.9g} m: give a shorter --distance", a.path,
                                stroke.length_m));
    const double period = cnc.servo_period_s;
    const auto asked = references(cnc, a, stroke);
    constexpr int seeds = 3; // the noise of one run moves the largest error by a tenth
    axis_tuning out{.name = a.name(), .period = period, .stroke = stroke};
    const auto trial = [&](gain_value gain, adaptation_value adaptation) {
        const axis_description now = with(a, gain.value(), adaptation.value());
        an::tuning_trial mean{0, phase_margin(now, period, cnc.seed), {}};
        for (int k = 0; k < seeds; ++k) {
            stroke_record one = along(now, period, cnc.seed + a.axis + 100 * std::uint64_t(k), asked);
            double most = 0;
            for (const double e : one.error_m) most = std::max(most, std::abs(e));
            mean.oscillation +=
                an::oscillation_index(one.command_V, in_si(period), an::hertz(stroke.threshold_Hz)) / seeds;
            mean.tracking_error += quantity<si::length>::from_value(most / seeds);
            if (k == 0) out.after = std::move(one);
        }
        if (out.before.error_m.empty()) out.before = out.after;
        return mean;
    };
    quadrant::sliding_mode<>::parameters start;
    start.gain = gain_value::from_value(a.law.number(gain_key));
    start.adaptation = adaptation_value::from_value(a.law.number(adaptation_key));
    try {
        out.trials = an::tune<voltage>(start, trial, {}, stroke.most_trials);
    } catch (const quadrant::invalid_parameter& fault) {
        refuse(cnc, fmt::format("{}.control: {}", a.path, fault.what()));
    }
    return out;
}

} // namespace quadrant_cnc
