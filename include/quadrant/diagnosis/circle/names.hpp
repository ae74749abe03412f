// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "result.hpp"

#include <algorithm>
#include <array>
#include <string_view>

/// What each error of a circle is called, what its sign means, what distinguishes it from others and what may
/// be behind it.
namespace quadrant::inline v0::diagnosis {

/// The words for one error of a circle: its name, what a positive value means, what distinguishes it from
/// others, what may cause it.
struct circle_error_words {
    std::string_view name, sign, needs;
    std::array<std::string_view, 4> effects; ///< of the machine file; empty ones are none
    bool behind_encoder = false;
};

/// Every error that a diagnosis of circles can name.
inline constexpr std::array circle_error_names{
    circle_error_words{"scale_mismatch",
                       "the first axis travels further than the second, for the same command",
                       "two feeds distinguish it from amplitude_mismatch; a laser says which axis it is",
                       {},
                       true},
    circle_error_words{"squareness",
                       "the angle between the positive axes is above 90 degrees",
                       "both directions (or two feeds) distinguish it from servo_mismatch",
                       {},
                       true},
    circle_error_words{
        "straightness",
        "the path of the axis bows towards the positive side of the other in its middle; over the largest "
        "diameter",
        "one run is enough for a bow; a straightedge or laser for other forms",
        {},
        true},
    circle_error_words{
        "lateral_play",
        "the guide of the axis moves its table towards the positive side of the other axis when it "
        "travels forward",
        "both directions distinguish it from scale and length",
        {},
        true},
    circle_error_words{"servo_mismatch",
                       "the first axis lags behind the second",
                       "both directions (or two feeds) distinguish it from squareness",
                       {"controller_mismatch", "time_delay", "actuator_lag"}},
    circle_error_words{"radius_change",
                       "the circle is larger than commanded; given for v^2/R = 1 m/s^2",
                       "two feeds distinguish it from the length of an instrument",
                       {"controller_mismatch", "actuator_lag", "mass"}},
    circle_error_words{"amplitude_mismatch",
                       "the radius of the first axis grows more with the feed; given for v^2/R = 1 m/s^2",
                       "two feeds distinguish it from scale_mismatch",
                       {"controller_mismatch", "actuator_lag", "mass"}},
    circle_error_words{"backlash",
                       "the axis stays behind: outward step at its reversals",
                       "two feeds distinguish it from servo_mismatch where both are small",
                       {"backlash", "coulomb_friction"}},
    circle_error_words{"reversal_lag", // what backlash is called where the machine cannot have any
                       "the axis stays behind: outward step at its reversals",
                       "two feeds distinguish it from servo_mismatch where both are small",
                       {"coulomb_friction"}},
    circle_error_words{"reversal_spikes",
                       "outward: the axis stays at its reversal",
                       "two feeds show how height and width follow the feed",
                       {"presliding_friction", "coulomb_friction", "stribeck_friction"}},
    circle_error_words{"stick_slip",
                       "height of a jump",
                       "a low feed shows it, a higher one must be free of it",
                       {"stribeck_friction"}},
    circle_error_words{"cyclic_error",
                       "amplitude",
                       "two feeds tell an encoder (constant) from cogging (follows the feed)",
                       {"encoder_cyclic_error", "cogging", "force_ripple"}},
    circle_error_words{"vibration",
                       "amplitude",
                       "two feeds tell a fixed frequency from what is periodic along an axis",
                       {"structural_resonance", "cutting_force"}},
};
/// The words for an error by its name; for a name that is none of them the last ones.
inline const circle_error_words& words_of_circle_error(std::string_view name) {
    return *std::find_if(circle_error_names.begin(), circle_error_names.end() - 1,
                         [&](const circle_error_words& w) { return w.name == name; });
}

namespace detail {
/// An error with everything that does not depend on the runs; effects that the machine cannot have are left
/// out.
inline circle_error named_error(std::string_view name, std::string axis, std::string unit,
                                const std::vector<std::string>& excluded) {
    const circle_error_words& w = words_of_circle_error(name);
    circle_error e;
    e.name = name, e.axis = std::move(axis), e.unit = std::move(unit), e.sign = w.sign, e.needs = w.needs;
    for (const std::string_view effect : w.effects)
        if (!effect.empty() && std::find(excluded.begin(), excluded.end(), effect) == excluded.end())
            e.effects.emplace_back(effect);
    return e;
}
} // namespace detail

} // namespace quadrant::inline v0::diagnosis
