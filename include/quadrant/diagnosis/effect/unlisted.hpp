// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "own_effect.hpp"

/// What no list names: a force of any smooth form over one quantity. Never a cause; a rival to the causes.
/// Where such a form predicts held-out motion better than a name does, the name is the nearest of a list, not
/// the effect.
namespace quadrant::inline v0::diagnosis::unlisted {

namespace detail {

enum class over { position, velocity, time, command };
inline constexpr std::size_t terms = 6;

/// Legendre polynomials between two ends, constant outside: value[0], value[1] the ends, then the size of each
/// [N]. They reach over the whole range, so that each stretch of motion says something about all of it.
template <over Of> double curve(const law_point& now, const own_law::values& value, own_law::memory&) {
    const double z = Of == over::position   ? now.position
                     : Of == over::velocity ? now.velocity
                     : Of == over::time     ? now.time
                                            : now.command;
    const double low = value[0], high = value[1];
    const double x = std::clamp((2 * z - low - high) / (high - low), -1.0, 1.0);
    double before = 1, last = x, sum = value[2] + value[3] * x;
    for (std::size_t i = 2; i < terms; ++i) { // Bonnet's recursion
        const auto n = static_cast<double>(i);
        const double next = ((2 * n - 1) * x * last - (n - 1) * before) / n;
        before = last;
        last = next;
        sum += value[2 + i] * last;
    }
    return sum;
}
template <over Of> inline constexpr own_law force{.law = curve<Of>};

/// The ends are those of the record.
template <over Of> void span(plant_model& plant, const screening& s) {
    auto& value = plant.own.of(force<Of>);
    const auto range = [&](const auto& values) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        value = {*low, *high > *low ? *high : *low + 1};
    };
    if constexpr (Of == over::position) range(s.record.position);
    if constexpr (Of == over::velocity) range(s.record.velocity);
    if constexpr (Of == over::command) range(s.record.command);
    if constexpr (Of == over::time)
        value = {0, s.record.period * static_cast<double>(s.record.position.size())};
}

template <over Of> std::vector<std::vector<parameter>> starts(const screening& s) {
    const double most = 3 * s.force_scale();
    return {[&]<std::size_t... I>(std::index_sequence<I...>){
        return std::vector<parameter>{{.key = "force_N",
                                       .of = own_number<force<Of>, 2 + I>,
                                       .start = 0,
                                       .low = -most,
                                       .high = most,
                                       .step = 1e-6 * most}...};
}
(std::make_index_sequence<terms>())
}; // namespace detail
} // namespace quadrant::inline v0::diagnosis::unlisted

template <over Of> constexpr effect form(std::string_view name) {
    return {.name = name,
            .box = "",
            .exciting_motion = "",
            .starts = starts<Of>,
            .read = [](const plant_model&) { return std::vector<key_value>{}; },
            .join = span<Of>};
}

} // namespace detail

inline constexpr effect by_position = detail::form<detail::over::position>(
                            "the position"),                            ///< as a spring or a slope would be
    by_velocity = detail::form<detail::over::velocity>("the velocity"), ///< as friction would be
    by_time = detail::form<detail::over::time>("time"),                 ///< as what warms up or wears would be
    by_command = detail::form<detail::over::command>("the command");    ///< as an amplifier that bends would be
/// A force that no list names, as a free curve over one of four quantities: where it predicts best, a cause
/// says so (better_form).
inline constexpr std::array curves{&by_position, &by_velocity, &by_time, &by_command};

} // namespace quadrant::inline v0::diagnosis::unlisted
