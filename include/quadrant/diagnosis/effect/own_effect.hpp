// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis {

/// One number of a law, as a fit moves it.
template <const own_law& Law, std::size_t I> double& own_number(plant_model& p) { return p.own.of(Law)[I]; }

/// The numbers of a law in a fitted model, by their keys.
template <const own_law& Law> std::vector<key_value> own_values(const plant_model& model) {
    plant_model p = model;
    std::vector<key_value> out;
    for (std::size_t i = 0; i < Law.count(); ++i)
        out.push_back({std::string(Law.numbers[i].key), {p.own.of(Law)[i]}});
    return out;
}

/// One number of a law as a parameter that begins at `start`, in the range that the law gives.
template <const own_law& Law, std::size_t I> parameter own_parameter(double start) {
    const own_law::number& n = Law.numbers[I];
    return {.key = std::string(n.key),
            .of = own_number<Law, I>,
            .start = start,
            .low = n.low,
            .high = n.high,
            .logarithmic = n.logarithmic,
            .step = n.logarithmic ? 1e-3 : 1e-5 * (n.high - n.low)};
}

namespace detail {

template <const own_law& Law> std::vector<std::vector<parameter>> own_starts(const screening&) {
    const auto all = []<std::size_t... I>(std::index_sequence<I...>) {
        return std::vector<parameter>{own_parameter<Law, I>(Law.numbers[I].start)...};
    };
    return {all(std::make_index_sequence<Law.count()>())};
}

constexpr bool every_start_within(const own_law& law) {
    for (std::size_t i = 0; i < law.count(); ++i) {
        const auto& n = law.numbers[i];
        if (!(n.low < n.high && n.low <= n.start && n.start <= n.high && (!n.logarithmic || n.low > 0)))
            return false;
    }
    return true;
}

template <const own_law& Law>
inline constexpr effect searched = [] {
    static_assert(!Law.name.empty() && Law.law != nullptr, "an own_law needs a name and a law");
    static_assert(!Law.box.empty(), "own_law::box is a box of the loop: mechanics, actuator, ...");
    static_assert(Law.count() > 0, "an own_law needs a number that a fit can move");
    static_assert(every_start_within(Law), "own_law::numbers: low <= start <= high, low < high");
    return effect{.name = Law.name,
                  .box = Law.box,
                  .joins = Law.joins,
                  .exciting_motion = Law.exciting_motion,
                  .law = &Law,
                  .starts = own_starts<Law>,
                  .read = own_values<Law>};
}();

} // namespace detail

/// A suspect of your own, beside and against those of the list: a law at any joint of the loop, its numbers
/// fitted from their starts.
///   constexpr own_law bellows{.name = "bellows", .exciting_motion = "strokes over the whole travel",
///                             .numbers = {{{.key = "bellows_N_per_m2", .low = 0, .high = 50000}}},
///                             .law = [](const auto& now, const auto& number, auto&) {
///                                 return -number[0] * now.position * std::abs(now.position);
///                             }};
///   machine.axes[0].own_effects = {own_effect<bellows>}; A law that is not linear in its numbers begins where
/// they do something: a size that starts at 0 hides the others. One that needs starts from the record is an
/// `effect` written out as those in effect/, with own_parameter<bellows, 0>(start).
template <const own_law& Law> inline constexpr const effect* own_effect = &detail::searched<Law>;

} // namespace quadrant::inline v0::diagnosis
