// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/axis_motion.hpp"
#include "../block/maps.hpp"

#include <complex>

/// The port that every control law of a feed drive has, so that one swaps for another in a `feed_axis`.
///
///   u = law(reference, measured, velocity)
///
///   reference  `axis_motion`: position, velocity, acceleration that the trajectory asks of sample k + lead().
///   measured   position of sample k, from the encoder; velocity of sample k, from the tachometer, in units of the table.
///              A law that takes a fourth argument gets the acceleration of sample k, from an accelerometer.
///   u          command, to act from sample k on until sample k + 1. The law does not limit it: a `limiter` follows, and a law
///              that integrates is told what was left of it by applied(u), before the next sample.
/// reset      as new: at rest at zero.
/// settle(x, u)  at rest at x, held by u: the next sample with reference and measurement at rest at x gives u,
/// if
///            the law has something that can hold it (an integral); else what it gives there.
/// NaN and infinities in any input: holds the last command, keeps the state, raises faulted() until reset or
/// settle.
///
/// Optional members, asked for by `requires`:
///   std::size_t lead() const    periods that the reference has to be ahead of the measurement (preview); absent: 0. The
///                               law compares with its own past: what it was given lead() samples ago is due now.
///   static constexpr std::size_t most_lead   what lead() never exceeds; belongs to lead(). The axis is asked so much later.
///   void applied(command)       see above; a law that remembers its own commands (RST, observer) needs it, too.
///   law_response response(frequency) const   of a linear law: eq. (19).
///   void retune(next, reference, measured, velocity, u)   other parameters from the next sample on (`retunable_law`):
///                               those of `next`, a law of the same type that was built outside the servo thread. The
///                               arguments are those of the last sample, u is what the law shall have given there: what
///                               holds the axis takes up what the other gains change of it.
/// Source: [Yeung2006] eq. (19).
namespace quadrant::inline v0 {

/// Eq. (19) of a linear law at a frequency, SI: u = to . (x_ref, v_ref, a_ref) - from . (x, v, a). The lead is
/// not in it: `to` takes the reference as it is given.
struct law_response {
    std::complex<double> to_position, to_velocity, to_acceleration;
    std::complex<double> from_position, from_velocity, from_acceleration{};
};

/// What encoder, tachometer and accelerometer say of one sample.
template <class Real = double> struct axis_measurement {
    quantity_of<signal::position, Real> position{};
    quantity_of<signal::velocity, Real> velocity{};
    quantity_of<signal::acceleration, Real> acceleration{}; ///< 0 where nothing measures it
};

/// See above. Write `static_assert(axis_law<my_law<>>)` under your law.
template <class L>
concept axis_law = signal_tag<typename L::output> &&
    requires(L law, const axis_motion<real_of<L>>& reference,
             quantity_of<signal::position, real_of<L>> measured,
             quantity_of<signal::velocity, real_of<L>> velocity,
             quantity_of<typename L::output, real_of<L>> command) {
    typename L::parameters;
    { law(reference, measured, velocity) } -> std::same_as<decltype(command)>;
    law.settle(measured, command);
    law.reset();
};

/// A law that takes the parameters of another one while it runs.
template <class L>
concept retunable_law = axis_law<L> && requires(L law, const L& next, const axis_motion<real_of<L>>& reference,
                                                quantity_of<signal::position, real_of<L>> measured,
                                                quantity_of<signal::velocity, real_of<L>> velocity,
                                                quantity_of<typename L::output, real_of<L>> u) {
    law.retune(next, reference, measured, velocity, u);
};

} // namespace quadrant::inline v0
