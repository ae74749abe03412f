// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "virtual_cnc.hpp"

#include <quadrant/analysis/fuzzy_tuning.hpp>
#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/analysis/margins.hpp>

#include <limits>
#include <vector>

namespace vcnc {

/// Where the three tunings of [Yeung2006] Table 9 start: Ks [V s/mm], rho [V/mm].
struct fuzzy_start {
    double gain, adaptation;
};
inline constexpr std::array fuzzy_starts{fuzzy_start{1, 100}, fuzzy_start{0.01, 1}, fuzzy_start{10, 10000}};

/// The trial of [Yeung2006] section 3 on the x axis: 100 mm forth and back at 200 mm/s, lambda 200 /s.
struct fuzzy_trial {
    static constexpr feed_profile way{0.1};
    static constexpr int seeds = 3;

    /// One run: reference minus table [um] and the command [V], sample by sample.
    struct record {
        std::vector<double> error, command;
    };
    static record run(const sliding_mode<>::parameters& law, std::uint64_t seed) {
        servo<sliding_mode<>> machine(x_axis, law, {}, seed);
        machine.settle({});
        record out;
        for (int k = 0; k < 2 * samples(); ++k) {
            const auto asked = at(k);
            out.error.push_back(1e6 * (asked.position.value() - machine.place()));
            machine.step(asked);
            out.command.push_back(machine.control().wire.command.value());
        }
        return out;
    }

    analysis::tuning_trial operator()(gain_of<signal::voltage, signal::velocity> gain,
                                      gain_of<signal::voltage, signal::position> adaptation) const {
        auto law = sliding_mode_of(x_axis);
        law.gain = gain, law.adaptation = adaptation;
        analysis::tuning_trial mean{0, phase_margin(law), {}};
        for (int seed = 1; seed <= seeds; ++seed) {
            const record one = run(law, std::uint64_t(seed));
            double most = 0;
            for (const double e : one.error) most = std::max(most, std::abs(e));
            mean.oscillation += analysis::oscillation_index(one.command, period, 50_Hz) / seeds;
            mean.tracking_error += decltype(mean.tracking_error)::from_value(1e-6 * most / seeds);
        }
        return mean;
    }

    /// What the axis is asked at one sample.
    static axis_motion<> at(int k) {
        const bool back = k >= samples();
        const auto m = way.at((back ? k - samples() : k) * period.value());
        const double sign = back ? -1 : 1;
        return {(back ? way.length - m.s : m.s) * 1_m, sign * m.v * 1_mps, sign * m.a * 1_mps2};
    }

private:
    static int samples() { return int(std::lround(way.duration() / period.value())); }
    /// With half a period more delay; NaN when there is none above 0.
    static double phase_margin(const sliding_mode<>::parameters& p) {
        const analysis::law_loop loop{sliding_mode<>(p, period),
                                      analysis::sampled_axis<>{model(x_axis), period}};
        const auto delayed = [&](frequency f) {
            return loop.open(f) * std::polar(1.0, -std::numbers::pi * f.value() * period.value());
        };
        const auto m =
            analysis::margins(delayed, {analysis::hertz(1), 0.499 * once_per(period)}).smallest_phase();
        return m && m->value > 0 ? m->value : std::numeric_limits<double>::quiet_NaN();
    }
};

} // namespace vcnc
