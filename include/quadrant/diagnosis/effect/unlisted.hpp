// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

/// What no list names: a force of any smooth form over one quantity. Never a cause; a rival to the causes. Where such a form
/// predicts held-out motion better than a name does, the name is the nearest of a list, not the effect.
namespace quadrant::diagnosis::unlisted {

namespace detail {

using over = free_curve::over;

/// The ends are those of the record.
template <over Of> void span(plant_model& plant, const screening& s) {
    const auto range = [&](const auto& values) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        plant.unlisted = {.of = Of, .low = *low, .high = *high > *low ? *high : *low + 1};
    };
    if constexpr (Of == over::position) range(s.record.position);
    if constexpr (Of == over::velocity) range(s.record.velocity);
    if constexpr (Of == over::command) range(s.record.command);
    if constexpr (Of == over::time)
        plant.unlisted = {.of = Of, .high = s.record.period * static_cast<double>(s.record.position.size())};
}

template <std::size_t I> parameter term(double most) {
    return {.key = "force_N",
            .of = [](plant_model& p) -> double& { return p.unlisted.size[I]; },
            .start = 0,
            .low = -most,
            .high = most,
            .step = 1e-6 * most};
}
inline std::vector<std::vector<parameter>> terms(const screening& s) {
    const double most = 10 * s.force_of_a_volt();
    return {[&]<std::size_t... I>(std::index_sequence<I...>){return std::vector<parameter>{term<I>(most)...};
}
(std::make_index_sequence<free_curve::terms>())
}; // namespace detail
} // namespace quadrant::diagnosis::unlisted

template <over Of> constexpr effect curve(std::string_view name) {
    return {.name = name,
            .box = "",
            .exciting_motion = "",
            .starts = terms,
            .read = [](const plant_model&) { return std::vector<key_value>{}; },
            .join = span<Of>};
}

} // namespace detail

inline constexpr effect by_position = detail::curve<detail::over::position>("the position"),
                        by_velocity = detail::curve<detail::over::velocity>("the velocity"),
                        by_time = detail::curve<detail::over::time>("time"),
                        by_command = detail::curve<detail::over::command>("the command");
inline constexpr std::array curves{&by_position, &by_velocity, &by_time, &by_command};

} // namespace quadrant::diagnosis::unlisted
