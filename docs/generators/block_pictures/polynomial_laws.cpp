// SPDX-License-Identifier: BSL-1.0
// Control laws that are polynomials (rst) on the axis of trial_axis.hpp.
#include "families.hpp"
#include "trial_axis.hpp"

#include <quadrant/control/generalized_predictive.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>

namespace block_pictures {
namespace {
constexpr double pi = std::numbers::pi;
const auto& G = trial_model;
const duration T = trial_period;

axis_motion<> sine_20(double t) {
    const double w = 2 * pi * 20, a = 100e-6;
    return {a * std::sin(w * t) * 1_m, a * w * std::cos(w * t) * 1_mps, -a * w * w * std::sin(w * t) * 1_mps2};
}

picture draw_generalized_predictive() {
    using law = generalized_predictive_law<20>;
    const auto with = [](double effort) {
        return trial_axis<law>(generalized_predictive<20, 2>(G, predictive_costs<>{effort * 1_um / 1_V}, T));
    };
    const record fast = ran("effort 10 um/V", with(10), step_and_push),
                 slow = ran("effort 100 um/V", with(100), step_and_push);
    curve due("reference, as it is due", dashed);
    for (const auto& [t, x] : {std::pair{0.0, 0.0}, {40.0, 0.0}, {40.0, 50.0}, {400.0, 50.0}}) due.add(t, x);
    return of("Generalized predictive control over 20 ms at a step of 50 um, and a force of 500 N from 200 ms "
              "on, with two efforts",
              {over("", "position [um]", {fast.place, slow.place, due}),
               over("time [ms]", "command [V]", {fast.command, slow.command})});
}
picture draw_pole_placement() {
    const auto with = [](double observer) {
        return trial_axis<pole_placement<>>(place_rst(G, {.natural = 20_Hz, .observer = observer * 1_Hz}, T));
    };
    const record slow = ran("observer 30 Hz", with(30), step_and_push),
                 fast = ran("observer 60 Hz", with(60), step_and_push);
    return of("Pole placement at 20 Hz after a step of 50 um, and a force of 500 N from 200 ms on, with "
              "observer poles at 30 and 60 Hz",
              {over("", "position [um]", {slow.place, fast.place, asked(step_and_push)}),
               over("time [ms]", "command [V]", {slow.command, fast.command})});
}
picture draw_zero_phase_tracking() {
    const rst_poles poles{.natural = 20_Hz, .observer = 30_Hz};
    const run sine{0.2, sine_20};
    // With a lead the law is asked that much later: shown beside the reference as it is due.
    const int lead = int(zero_phase_tracking<>(zero_phase_rst(G, poles, T), T).lead());
    record zero =
        ran("zero_phase_tracking", trial_axis<zero_phase_tracking<>>(zero_phase_rst(G, poles, T)), sine);
    record placed =
        ran("pole_placement, the same poles", trial_axis<pole_placement<>>(place_rst(G, poles, T)), sine);
    for (double& t : zero.place.x) t -= lead;
    for (line* l : {static_cast<line*>(&zero.place), static_cast<line*>(&placed.place)}) {
        const auto skip = std::ptrdiff_t(102);
        l->x.erase(l->x.begin(), l->x.begin() + skip), l->y.erase(l->y.begin(), l->y.begin() + skip);
    }
    curve r("reference", dashed);
    for (int k = 100; k <= 200; ++k) r.add(k, 1e6 * sine_20(1e-3 * k).position.value());
    panel p = over("time [ms]", "position [um]", {zero.place, placed.place, r});
    p.x_range = std::pair{100.0, 200.0};
    return of(
        "A sine of 100 um and 20 Hz followed with zero phase error and by pole placement with the same poles",
        {p});
}
picture draw_lead_lag() {
    const auto plant = pulse_transfer(G, T);
    const auto p = design_lead_lag(G, {.crossover = 40_Hz, .phase_margin = 50}, T);
    const lead_lag<> law(p, T);
    const auto open = [&](frequency f) {
        const std::complex<double> back = std::polar(1.0, -2 * pi * f.value() * T.value());
        const auto value = [&](const auto& polynomial) {
            std::complex<double> sum = 0;
            for (std::size_t i = polynomial.size(); i-- > 0;) sum = sum * back + polynomial[i];
            return sum;
        };
        return law.response(f).from_position * value(plant.b) / value(plant.a);
    };
    const auto at = frequencies(2, 490);
    curve crossover("crossover asked for", points), margin("phase margin asked for", points);
    crossover.add(40, 0), margin.add(40, -130);
    return of(
        "Open loop of an axis under lead-lag compensation for 40 Hz and 50 degrees",
        {gains({gain("open loop", at, open), crossover}), phases({phase("open loop", at, open), margin})});
}
picture draw_rst() {
    const auto p = place_rst(G, {.natural = 20_Hz, .observer = 30_Hz}, T);
    const run far{0.3, [](double t) { return at_rest(t < 0.02 ? 0 : 1e-3); }};
    const record told = ran("told what was applied", trial_axis<pole_placement<>>(p), far),
                 not_told = ran("not told", trial_axis<pole_placement<>>(p, false), far);
    curve high("limit of the amplifier", dashed);
    for (const double t : {0.0, 300.0}) high.add(t, 5);
    return of("A step of 1 mm that asks for more than 5 V, by an RST law that is told of the limit and by one "
              "that is not",
              {over("", "position [um]", {told.place, not_told.place, asked(far)}),
               over("time [ms]", "command [V]", {told.command, not_told.command, high})});
}
} // namespace

family polynomial_laws() {
    return {{"generalized_predictive", draw_generalized_predictive},
            {"pole_placement", draw_pole_placement},
            {"zero_phase_tracking", draw_zero_phase_tracking},
            {"lead_lag", draw_lead_lag},
            {"rst", draw_rst}};
}
} // namespace block_pictures
