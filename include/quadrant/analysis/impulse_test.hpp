// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/in_si.hpp"
#include "../block/axis_motion.hpp"
#include "response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::analysis {

/// What an axis in closed loop did in one period.
struct loop_sample {
    double command = 0;  ///< that the drive got, the push included
    double position = 0; ///< of what is to be moved, when the period began [m]
    double due = 0;      ///< the reference of this period [m]
};

/// An axis with its controller that runs one period at a time: at rest after rest(); step(asked, push) with
/// what is added to the command. lead(): periods that the reference has to be ahead.
template <class L>
concept running_loop = requires(L& loop, const axis_motion<>& asked, double push) {
    loop.rest();
    { loop.step(asked, push) } -> std::same_as<loop_sample>;
    { loop.lead() } -> std::convertible_to<std::size_t>;
};

/// Frequency responses of a loop that runs, of whatever blocks, from what it answers to a pulse:
///   sensitivity  S = U/D        what the drive gets of a pulse that is added to the command
///   open loop    L = 1/S - 1    cut at the command: what the margins are read from
///   disturbance  G_x = X/D      how far the command moves the axis in closed loop
///   tracking     T = X/R        of a smooth reference with its velocity and acceleration, up to 0.4 of the rate
/// Source: [Franklin1998] discrete frequency response, the transform of the pulse response.
/// A loop with limits, friction or rounding has no frequency response: leave them out of it, and see linear().
/// Cost: one run of the loop, at most `most` periods, three times; then one pass over the answer a frequency.
class impulse_test {
public:
    /// The pulse on the command is one period of `push`, on the reference a bell of `way` [m] two periods wide.
    template <running_loop L>
    impulse_test(L& loop, duration period, double push, double way, std::size_t most = 1 << 17)
        : period_(period.value()), push_(push) {
        require_positive("impulse_test.period", period);
        require(std::isfinite(push) && push != 0, "impulse_test.push", push, "must be finite and not zero");
        require(std::isfinite(way) && way != 0, "impulse_test.way", way, "must be finite and not zero");
        const auto pushed = [&](double by) {
            return run(
                loop, most, [&](std::size_t k) { return k == 0 ? by : 0.0; },
                [](double) { return axis_motion<>{}; });
        };
        pushed_ = pushed(push);
        const answer twice = pushed(2 * push);
        for (std::size_t k = 0; k < pushed_.command.size(); ++k) {
            const double other = k < twice.command.size() ? twice.command[k] / 2 : 0;
            bent_ = std::max(bent_, std::abs(other - pushed_.command[k]) / std::abs(push));
        }
        const double centre = 12 * width; // so early that the bell begins from nothing
        const auto bell = [&](double at) {
            const double z = (at - centre) / width, s = width * period_, size = way * std::exp(-z * z / 2);
            return axis_motion<>{in_si(size), in_si(-size * z / s), in_si(size * (z * z - 1) / (s * s))};
        };
        led_ = run(
            loop, most, [](std::size_t) { return 0.0; }, bell);
    }

    /// Whether the loop comes to rest again: it is stable.
    bool decays() const { return pushed_.decays && led_.decays; }
    /// Whether twice the push makes twice the answer, to a millionth.
    bool linear() const { return bent_ < 1e-6; }
    /// Up to here tracking() is known.
    frequency highest() const { return hertz(0.4 / period_); }
    frequency nyquist() const { return hertz(0.5 / period_); }

    complex sensitivity(frequency f) const { return transform(pushed_.command, f) / push_; }
    complex open(frequency f) const { return 1.0 / sensitivity(f) - 1.0; }
    complex disturbance(frequency f) const { return transform(pushed_.position, f) / push_; }
    complex tracking(frequency f) const { return transform(led_.position, f) / transform(led_.due, f); }

private:
    static constexpr double width = 2; ///< of the bell [periods]
    struct answer {
        std::vector<double> command{}, position{}, due{};
        bool decays = false;
    };
    /// Until nothing of its largest is left for as long as the answer took so far, or `most` periods.
    template <class L, class Push, class Asked>
    static answer run(L& loop, std::size_t most, const Push& push, const Asked& asked) {
        constexpr double nothing = 1e-11;
        answer out;
        loop.rest();
        const auto lead = static_cast<double>(loop.lead());
        double largest = 0, largest_command = 0;
        std::size_t last = 0; ///< period in which something was left
        for (std::size_t k = 0; k < most; ++k) {
            const loop_sample s = loop.step(asked(static_cast<double>(k) + lead), push(k));
            if (!std::isfinite(s.position) || !std::isfinite(s.command)) return out;
            out.command.push_back(s.command);
            out.position.push_back(s.position);
            out.due.push_back(s.due);
            largest = std::max(largest, std::abs(s.position));
            largest_command = std::max(largest_command, std::abs(s.command));
            if (std::abs(s.position) > nothing * largest || std::abs(s.command) > nothing * largest_command)
                last = k;
            if (k > 64 && k > 2 * last) {
                out.decays = true;
                return out;
            }
        }
        return out;
    }
    complex transform(const std::vector<double>& x, frequency f) const {
        const complex back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_);
        complex sum = 0;
        for (std::size_t k = x.size(); k-- > 0;) sum = sum * back + x[k];
        return sum;
    }

    double period_, push_, bent_ = 0;
    answer pushed_{}, led_{};
};

} // namespace quadrant::inline v0::analysis
