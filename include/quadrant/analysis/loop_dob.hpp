// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../observer/q_filter.hpp"
#include "loop.hpp"
#include "margins.hpp"

#include <complex>
#include <cstddef>
#include <optional>

namespace quadrant::inline v0::analysis {

/// Q and Q/Gn of an observer in continuous time, the Q of `disturbance_observer`. For the sampled block take
/// its q(f) and inverse(f) as two lambdas instead. [Jamaludin2008] (4.6), (4.7).
template <std::size_t Order = 2, std::size_t NumeratorOrder = 0> struct q_model {
    frequency corner; ///< wc / (2 pi)

    complex operator()(frequency f) const {
        const auto q = q_filter<Order, NumeratorOrder>(corner);
        return quadrant::detail::polynomial(q.numerator, laplace(f)) /
               quadrant::detail::polynomial(q.denominator, laplace(f));
    }
};
/// Q/Gn; Nominal any response, a `rigid_axis_model` without delay.
template <frequency_response Q, frequency_response Nominal> struct q_inverse_model {
    Q q;
    Nominal nominal;
    complex operator()(frequency f) const { return complex(q(f)) / complex(nominal(f)); }
};
template <class Q, class N> q_inverse_model(Q, N) -> q_inverse_model<Q, N>;

/// An axis G with its disturbance observer, from what the controller wants to position: G / (1 - Q + G Q/Gn).
/// It is Gn where Q = 1 and G where Q = 0.
template <frequency_response Plant, frequency_response Q, frequency_response Inverse> struct observed_axis {
    Plant plant;
    Q q;             ///< what of the applied command comes back
    Inverse inverse; ///< Q/Gn, what of the position comes back

    complex operator()(frequency f) const { return complex(plant(f)) / difference(f); }
    /// What is left of a push on the axis by itself: (1 - Q) / (1 - Q + G Q/Gn).
    complex rejection(frequency f) const { return (1.0 - complex(q(f))) / difference(f); }

private:
    complex difference(frequency f) const {
        return 1.0 - complex(q(f)) + complex(plant(f)) * complex(inverse(f));
    }
};
template <class P, class Q, class I> observed_axis(P, Q, I) -> observed_axis<P, Q, I>;

/// The closed loops of a P/PI cascade with a disturbance observer (its loop through the command solved, as the
/// block does).
///   L_v, L_p, T  as in `p_pi_loop`, of the observed axis: seen from what the controller wants
///   S = 1/(1 + G (PI (kv + F) + Q/Gn)/(1 - Q))    1/(1 + all that is fed back), of a push at the motor
/// Its bandwidths are those of this S. Same units and conditions as `p_pi_loop`; q and inverse continuous or
/// sampled as the rest is. Source: [Jamaludin2008] (2.22) to (2.34), (4.1) to (4.20).
template <class Loop, frequency_response Q, frequency_response Inverse> struct p_pi_dob_loop {
    Loop without; ///< the same loop without observer: a `p_pi_loop`
    Q q;
    Inverse inverse;

    complex open_velocity(frequency f) const { return observed().open_velocity(f); }
    complex open_position(frequency f) const { return observed().open_position(f); }
    complex sensitivity(frequency f) const { return axis().rejection(f) * observed().sensitivity(f); }
    /// Of the velocity loop by itself, the observer running: 1/(1 + G (PI F + Q/Gn)/(1 - Q)).
    complex velocity_sensitivity(frequency f) const {
        return axis().rejection(f) * observed().velocity_sensitivity(f);
    }
    complex tracking(frequency f) const { return observed().tracking(f); }
    complex error_ratio(frequency f) const { return 1.0 - tracking(f); }
    /// Deflection over force at the motor; `force_constant` in newton per command.
    template <class ForceConstant> complex compliance(frequency f, ForceConstant force_constant) const {
        return complex(without.plant(f)) / force_constant.value() * sensitivity(f);
    }
    template <class ForceConstant> complex dynamic_stiffness(frequency f, ForceConstant force_constant) const {
        return 1.0 / compliance(f, force_constant);
    }
    /// 1 - Q + G (PI (kv + F) + Q/Gn): zero at the poles of the whole, itself without poles right of the axis;
    /// less one it goes to `unstable_poles`.
    complex return_difference(frequency f) const { return (1.0 - complex(q(f))) / sensitivity(f); }
    /// What a push leaves with the observer over what it leaves without: below 1 it helps.
    complex benefit(frequency f) const { return sensitivity(f) / without.sensitivity(f); }

private:
    auto axis() const { return observed_axis{without.plant, q, inverse}; }
    auto observed() const {
        return p_pi_loop{axis(), without.velocity, without.feedback, without.position_gain};
    }
};
template <class L, class Q, class I> p_pi_dob_loop(L, Q, I) -> p_pi_dob_loop<L, Q, I>;

/// Up to where an observer helps, and how much it does harm beyond.
struct observer_limits {
    std::optional<frequency>
        helps_up_to; ///< first rise of |S with| through |S without|; none in the band: empty
    margin worst;    ///< largest |S with|/|S without|, and where
};
template <class Loop, class Q, class Inverse>
observer_limits limits(const p_pi_dob_loop<Loop, Q, Inverse>& loop, const band& b) {
    const auto benefit = [&](frequency f) { return loop.benefit(f); };
    const auto rises = rising_crossings(benefit, 1, b);
    const margin worst = least([&](frequency f) { return 1.0 / benefit(f); }, b);
    return {rises.empty() ? std::nullopt : std::optional(rises.front()), {1 / worst.value, worst.at}};
}

} // namespace quadrant::inline v0::analysis
