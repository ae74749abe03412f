// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "plant_model.hpp"

#include <fmt/format.h>

namespace quadrant::diagnosis {

/// What to do about an effect that no feedforward of the reference mends, with the numbers of the corrected plant `p`;
/// empty: a feedforward mends it.
inline std::string advice_on(std::string_view effect, const plant_model& p, double resolution,
                             std::string_view unit) {
    const auto um = [](double x) { return fmt::format("{:.3g} um", 1e6 * x); };
    const auto ms = [](double x) { return fmt::format("{:.3g} ms", 1e3 * x); };
    if (effect == "time_delay")
        return fmt::format(
            "no feedforward takes a delay out of a loop: shorten the way of the command (now {}), or run "
            "the reference ahead by it (preview), so that what is fed forward comes in time",
            ms(p.delay));
    if (effect == "actuator_lag")
        return fmt::format("a faster current loop (now {}); until then lower gains", ms(p.lag));
    if (effect == "actuator_saturation")
        return fmt::format("a lower acceleration, or a drive that gives more than {:.3g} {}: what is cut off "
                           "cannot be fed forward",
                           p.drive_limit, unit);
    if (effect == "actuator_dead_zone")
        return fmt::format(
            "the inverse in the drive: {:.3g} {} more in the direction of the whole command; the "
            "reference does not know that direction",
            p.dead_zone, unit);
    if (effect == "sample_loss")
        return "mend the transmission: which periods lose their command is not known beforehand";
    if (effect == "encoder_quantization")
        return fmt::format("a finer scale or interpolation than {}; meanwhile a lower corner of the velocity "
                           "estimate",
                           um(resolution));
    if (effect == "encoder_cyclic_error")
        return fmt::format(
            "adjust the scale's head, or correct the reading by a table over {} of travel: the loop "
            "follows the error, and a feedforward would only help it to",
            um(p.cyclic.period));
    if (effect == "backlash")
        return fmt::format(
            "preload or a stiffer drive ({} of play): the encoder sits behind the play, so that the loop "
            "sees it already; backlash_compensation is for an encoder before it",
            um(p.backlash));
    if (effect == "structural_resonance")
        return fmt::format("a notch in the command near {:.3g} Hz and a reference with less jerk",
                           p.mode.frequency_Hz);
    if (effect == "cross_coupling")
        return fmt::format(
            "the other axis' reference acceleration times {:.3g} {} s^2/m in this command (not simulated "
            "here: the log of one axis does not say what the other is asked for next)",
            -p.mass * p.coupling / p.force_constant, unit);
    if (effect == "force_ripple")
        return fmt::format(
            "divide the whole command by 1 + {:.3g} sin(2 pi x/{:.4g} m + {:.3g}), in the drive's "
            "commutation table: it grows with the command, which the reference does not know",
            std::hypot(p.ripple.sine[0], p.ripple.cosine[0]), p.ripple.period,
            std::atan2(p.ripple.cosine[0], p.ripple.sine[0]));
    if (effect == "friction_drift")
        return "warm up, or a disturbance observer: a feedforward of one level is right at one time only";
    if (effect == "cutting_force")
        return fmt::format(
            "a harmonic force observer or repetitive control at {:.4g} Hz: when the process begins is not "
            "known beforehand",
            p.cutting.period > 0 ? 1 / p.cutting.period : 0.0);
    if (effect == "controller_mismatch")
        return "set the controller as described, or keep what ran: no compensation is missing";
    return {};
}

} // namespace quadrant::diagnosis
