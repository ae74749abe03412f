// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/effect.hpp"

namespace quadrant::diagnosis {

/// One number of a force of your own, as a fit moves it.
template <const own_force& Force, std::size_t I> double& own_number(plant_model& p) {
    return p.own.of(Force)[I];
}

namespace detail {

template <const own_force& Force> std::vector<std::vector<parameter>> own_starts(const screening&) {
    return {[]<std::size_t... I>(std::index_sequence<I...>){
        const auto one = [](const own_force::number& n, double& (*of)(plant_model&)) {
            return parameter{.key = std::string(n.key),
                             .of = of,
                             .start = n.start,
                             .low = n.low,
                             .high = n.high,
                             .logarithmic = n.logarithmic,
                             .step = n.logarithmic ? 1e-3 : 1e-5 * (n.high - n.low)};
        };
    return std::vector<parameter>{one(Force.numbers[I], own_number<Force, I>)...};
}
(std::make_index_sequence<Force.count()>())
}; // namespace detail
} // namespace quadrant::diagnosis

template <const own_force& Force> std::vector<key_value> own_values(const plant_model& model) {
    plant_model p = model;
    std::vector<key_value> out;
    for (std::size_t i = 0; i < Force.count(); ++i)
        out.push_back({std::string(Force.numbers[i].key), {p.own.of(Force)[i]}});
    return out;
}

constexpr bool every_start_within(const own_force& force) {
    for (std::size_t i = 0; i < force.count(); ++i) {
        const auto& n = force.numbers[i];
        if (!(n.low < n.high && n.low <= n.start && n.start <= n.high && (!n.logarithmic || n.low > 0)))
            return false;
    }
    return true;
}

template <const own_force& Force>
inline constexpr effect searched = [] {
    static_assert(!Force.name.empty() && Force.law != nullptr, "an own_force needs a name and a law");
    static_assert(Force.box == "mechanics" || Force.box == "actuator" || Force.box == "process",
                  "own_force::box is mechanics, actuator or process");
    static_assert(Force.count() > 0, "an own_force needs a number that a fit can move");
    static_assert(every_start_within(Force), "own_force::numbers: low <= start <= high, low < high");
    return effect{.name = Force.name,
                  .box = Force.box,
                  .exciting_motion = Force.exciting_motion,
                  .starts = own_starts<Force>,
                  .read = own_values<Force>};
}();

} // namespace detail

/// A suspect of your own: a force with its numbers, fitted from their starts, beside and against those of the list.
///   constexpr own_force drag{.name = "air_drag", .exciting_motion = "fast strokes",
///                            .numbers = {{{.key = "air_drag_N_s2_per_m2", .low = 0, .high = 5000}}},
///                            .law = [](const auto& now, const auto& number, auto&) {
///                                return -number[0] * now.velocity * std::abs(now.velocity);
///                            }};
///   machine.axes[0].own_effects = {own_effect<drag>};
/// A law that is not linear in its numbers begins where they do something: a size that starts at 0 hides the others. One
/// that needs starts from the record is an `effect` written out as those in effect/, with own_number<drag, 0> for `of`,
/// and then {&drag, &that}.
template <const own_force& Force> inline constexpr own_suspect own_effect{&Force, &detail::searched<Force>};

} // namespace quadrant::diagnosis
