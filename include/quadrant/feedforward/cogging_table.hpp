// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../memory/cubic_weights.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// What holds the axis against cogging, from where it is: a table over one pitch (that of the poles, or a
/// turn), as measured or made from harmonics.
///   u = through points[i] at x = i pitch / Points, again and again; Order 1: straight lines, Order 3: the cubic
///   through the two points on either side (Lagrange)
/// Ports: position in (of the reference, or measured), command out in whatever the points are: N, V or A. Added
/// by the loop.
/// State: none but the last good output; `reset` and `settle` clear the fault flag.
/// `retune(next)`: another table from the next step on; jump: the difference of both curves at x.
/// Range: pitch > 0; Points >= 4. Between points a wave of h per pitch, b = 2 pi h / Points, is off by b^2 / 8
/// of itself (Order 1), 3 b^4 / 128 (Order 3): take 20 points a wave for 1.2 % or 0.023 %. Any position; its
/// rounding becomes one of place, |x| times 2e-16 (float 1e-7): in float count from near the place where the
/// axis works. At
/// speed the force comes late: feed the position `ahead` of a `preview`.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "cogging_table.pitch = ...: must ...", "cogging_table.points = ...: must be finite".
/// Cost: 1 division, 2 or 15 multiplications for any number of points. Few harmonics in little memory:
/// `cogging_harmonics`.
template <std::size_t Points, signal_tag Out = signal::force, std::size_t Order = 3,
          signal_tag In = signal::position, class Real = double>
requires(Points >= 4 && (Order == 1 || Order == 3)) class cogging_table {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The pitch, and the command at evenly spaced places of it.
    struct parameters {
        quantity_of<In, number> pitch{};                       ///< > 0
        std::array<quantity_of<Out, number>, Points> points{}; ///< finite
    };
    struct state {};

    cogging_table(const parameters& p, duration period) : given_(p), pitch_(in_real<Real>(p.pitch)) {
        require_positive<Real>("cogging_table.period", period);
        require_positive<Real>("cogging_table.pitch", p.pitch);
        for (std::size_t i = 0; i < Points; ++i) {
            require_finite<Real>("cogging_table.points", p.points[i]);
            points_[i] = in_real<Real>(p.points[i]);
        }
    }

    value operator()(argument x) noexcept {
        const value u = at(x);
        return finite(x, u) ? out_.keep(u) : out_.hold();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept {
        const value u = at(x);
        finite(x, u) ? out_.reset(u) : out_.raise();
    }

    void retune(const cogging_table& next) noexcept {
        const auto out = out_;
        *this = next;
        out_ = out;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value at(argument x) const noexcept {
        const Real turns = Real(x / pitch_);
        if (!finite(turns)) return value::from_value(turns); // no place in the table
        const Real place = (turns - Real(std::floor(detail::plain(turns)))) * Real(double(Points));
        const double whole = std::floor(detail::plain(place));
        const Real t = place - Real(whole);
        const std::size_t i = std::size_t(whole) % Points; // a turn that rounds to 1 is the first point
        const value &a = points_[i], &b = points_[(i + 1) % Points];
        if constexpr (Order == 1)
            return a + (b - a) * t;
        else {
            const value &before = points_[(i + Points - 1) % Points], &after = points_[(i + 2) % Points];
            const auto weight = detail::cubic_weights(t);
            return before * weight[0] + a * weight[1] + b * weight[2] + after * weight[3];
        }
    }

    parameters given_;
    argument pitch_;
    std::array<value, Points> points_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
