// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// A gain that depends on something else: on the load, on where the axis stands, on its speed.
///   y = g(s) x,   g: straight between the nodes (at[i], gain[i]), held beyond the first and the last
/// Source: [Astrom1995] ch. 6 (gain scheduling).
/// Ports: one scalar in, what the gain depends on beside it, one scalar out. In front of a
/// `proportional_integral` (error to error) it scales both of its gains, and the integral, which is behind,
/// does not jump.
/// State: none; `reset` and `settle(x, s)` set the held output and clear the fault. `gain(s)` alone returns the
/// gain.
/// Jump: none at a node. When s moves by ds the output moves by at most (steepest slope) |ds| |x| more than
/// with a fixed gain.
/// `retune(next)`: other nodes from the next step on; jump: |g'(s) - g(s)| |x|.
/// Range: nodes rise; any finite gains. One that has to be smooth in s too: more nodes.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "gain_schedule.at = ...: must ...", "gain_schedule.gain = ...: must be finite", "gain_schedule.period
/// = ...".
/// Cost: 2 multiplications, 1 division, a comparison a node. Fixed: `proportional`; all parameters at once, now
/// and then: `parameter_swap` with `retune`.
template <signal_tag Scheduling, signal_tag In, signal_tag Out, std::size_t Nodes, class Real = double>
requires(Nodes >= 2) class gain_schedule {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using scheduling = quantity_of<Scheduling, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The nodes of the curve from the scheduling signal to the gain.
    struct parameters {
        std::array<quantity_of<Scheduling, number>, Nodes> at; ///< rising
        std::array<gain_of<Out, In, number>, Nodes> gain;      ///< any finite values
    };
    struct state {};

    gain_schedule(const parameters& p, duration period) : given_(p) {
        require_positive<Real>("gain_schedule.period", period);
        for (std::size_t i = 0; i < Nodes; ++i) {
            require_finite<Real>("gain_schedule.at", p.at[i]);
            require_finite<Real>("gain_schedule.gain", p.gain[i]);
            require(i == 0 || detail::plain(p.at[i]) > detail::plain(p.at[i - 1]), "gain_schedule.at", p.at[i],
                    "must lie above the one before it (" + detail::shortest(p.at[i == 0 ? 0 : i - 1]) + ")");
            at_[i] = in_real<Real>(p.at[i]);
            gain_[i] = in_real<Real>(p.gain[i]);
        }
    }

    value operator()(argument x, scheduling s) noexcept {
        const value y = gain(s) * x;
        return finite(s, y) ? out_.keep(y) : out_.hold();
    }
    gain_of<Out, In, Real> gain(scheduling s) const noexcept {
        if (!(s > at_.front())) return gain_.front();
        for (std::size_t i = 1; i < Nodes; ++i)
            if (s < at_[i])
                return gain_[i - 1] +
                       Real((s - at_[i - 1]) / (at_[i] - at_[i - 1])) * (gain_[i] - gain_[i - 1]);
        return gain_.back();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x, scheduling s) noexcept {
        const value y = gain(s) * x;
        finite(s, y) ? out_.reset(y) : out_.raise();
    }

    void retune(const gain_schedule& next) noexcept {
        const auto out = out_;
        *this = next;
        out_ = out;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    std::array<scheduling, Nodes> at_{};
    std::array<gain_of<Out, In, Real>, Nodes> gain_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
