// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction_run.hpp"
#include "../row.hpp"

#include <quadrant/analysis/circular_test.hpp>
#include <quadrant/block/axis_motion.hpp>

#include <array>
#include <cmath>

namespace quadrant_reproduce {

/// What the axes are asked for at time t: a circle of this radius about (-radius, 0), from (0, 0), where both
/// axes stand; at the angular velocity w from `started` on.
inline std::array<quadrant::axis_motion<>, 2> along_a_circle(double t, double radius, double w,
                                                             double started) {
    using namespace quadrant::literals;
    // The angle gains speed as sin^2 does, so that its acceleration starts and ends at zero.
    const double c = thesis::pi_ / started;
    const bool starts = t < started;
    const double angle = starts ? w * (t / 2 - std::sin(c * t) / (2 * c)) : w * (t - started / 2),
                 rate = starts ? w * (1 - std::cos(c * t)) / 2 : w,
                 gain = starts ? w * c * std::sin(c * t) / 2 : 0;
    const double cs = std::cos(angle), sn = std::sin(angle);
    return {
        {{radius * (cs - 1) * 1_m, -radius * sn * rate * 1_mps,
          radius * (-cs * rate * rate - sn * gain) * 1_mps2},
         {radius * sn * 1_m, radius * cs * rate * 1_mps, radius * (-sn * rate * rate + cs * gain) * 1_mps2}}};
}

/// Both axes along a circle of 30 mm at some speed [m/s]: half a turn to get going, one and a half turns at it;
/// the middle turn is judged. Radii are those of the axes, not of their encoders.
template <class Compensation, class Observer>
outcome circle_case(const std::string& id, const std::string& name, double speed = 0.1,
                    std::size_t substeps = 50) {
    using namespace quadrant;
    using namespace quadrant::literals;
    const double radius = 0.03, w = speed / radius, T = thesis::period.value(), started = thesis::pi_ / w;
    const thesis::reading how{.substeps = substeps};
    thesis::friction_axis<Compensation, Observer> x(thesis::x, how), y(thesis::y, how);
    analysis::circular_path path{{}, {}, thesis::period};
    bool diverged = false;
    double squares_x = 0, squares_y = 0, counted = 0; // of the whole turn that is judged
    const auto samples = static_cast<int>((started + 1.25 * 2 * thesis::pi_ / w) / T);
    for (int k = 0; k < samples && !diverged; ++k) {
        const double t = k * T;
        const auto [to_x, to_y] = along_a_circle(t, radius, w, started);
        path.x.push_back(x.position() * 1_m);
        path.y.push_back(y.position() * 1_m);
        diverged =
            x.stopped() || y.stopped() ||
            !(std::hypot(to_x.position.value() - x.position(), to_y.position.value() - y.position()) < 1e-3);
        if (t >= started && t < started + 2 * thesis::pi_ / w) {
            squares_x += std::pow(1e6 * (to_x.position.value() - x.position()), 2);
            squares_y += std::pow(1e6 * (to_y.position.value() - y.position()), 2);
            counted += 1;
        }
        x.step(to_x, to_x);
        y.step(to_y, to_y);
    }
    outcome out;
    if (diverged) {
        for (const char* quantity : {"radial_max", "radial_rms", "x_error_rms", "y_error_rms"})
            out.rows.push_back({id, quantity, "um", {}, {}, {}, {}, thesis::diverged_note});
        return out;
    }
    const auto found =
        analysis::circular_test(path, {.nominal = {.x = -radius * 1_m, .y = 0_m, .radius = radius * 1_m}});
    const double most = std::max(found.radial_max.value(), -found.radial_min.value());
    out.rows = {{id, "radial_max", "um", 1e6 * most, {}, {}, {}, ""},
                {id, "radial_rms", "um", 1e6 * found.radial_rms.value(), {}, {}, {}, ""},
                {id, "x_error_rms", "um", std::sqrt(squares_x / counted), {}, {}, {}, "over one turn"},
                {id, "y_error_rms", "um", std::sqrt(squares_y / counted), {}, {}, {}, "over one turn"}};
    line polar{.name = name, .x = found.angle, .y = {}};
    for (const auto& d : found.deviation) polar.y.push_back(1e6 * d.value());
    const bool observed = !std::is_same_v<Observer, thesis::no_observer>;
    out.pictures = {
        {std::string("Radial deviation ") + (speed < 0.1 ? "at 10 mm/s " : "") +
             (observed ? "with the observer" : "without observer"),
         "Polar plot in um about the nominal circle; x reverses at 0 and 180 degrees, y at 90 and 270.",
         {panel{.x_label = "",
                .y_label = "um",
                .lines = {std::move(polar)},
                .polar = true,
                .polar_zero = observed ? 20.0 : 40.0}}}};
    return out;
}

inline experiment circle() {
    using namespace thesis;
    const std::string id = "thesis.circle.";
    return {
        "A circle of 30 mm at 100 mm/s",
        "[Jamaludin2008] Table 4.11, Figs. 4.10, 4.30 and 4.32",
        "Largest and rms deviation from the nominal radius over one turn, after a smooth start. The thesis "
        "measured this on its machine; "
        "it prints no simulation of it.",
        0.10,
        {{id + "none", [=] { return circle_case<no_friction_model, no_observer>(id + "none", "none"); }},
         {id + "static", [=] { return circle_case<static_curve, no_observer>(id + "static", "static"); }},
         {id + "gms", [=] { return circle_case<gms_model, no_observer>(id + "gms", "GMS"); }},
         {id + "dob", [=] { return circle_case<no_friction_model, observer>(id + "dob", "observer alone"); }},
         {id + "dob_static",
          [=] { return circle_case<static_curve, observer>(id + "dob_static", "and static"); }},
         {id + "dob_gms", [=] { return circle_case<gms_model, observer>(id + "dob_gms", "and GMS"); }}}};
}

/// Figs. 4.11 and 4.31.
inline experiment slow_circle() {
    using namespace thesis;
    const std::string id = "thesis.circle_slow.";
    const auto of = [=]<class Compensation, class Observer>(const char* which, const char* name, Compensation*,
                                                            Observer*) {
        return run_case{id + which,
                        [=] { return circle_case<Compensation, Observer>(id + which, name, 0.01, 10); }};
    };
    constexpr no_friction_model* none = nullptr;
    constexpr static_curve* curve = nullptr;
    constexpr gms_model* gms = nullptr;
    constexpr no_observer* alone = nullptr;
    constexpr observer* observed = nullptr;
    return {
        "The circle at 10 mm/s",
        "[Jamaludin2008] Figs. 4.11 and 4.31",
        "The same circle ten times slower, plant sub-steps of 50 us. The thesis draws what its machine did and "
        "prints no number of it.",
        0.10,
        {of("none", "none", none, alone), of("static", "static", curve, alone), of("gms", "GMS", gms, alone),
         of("dob", "observer alone", none, observed), of("dob_static", "and static", curve, observed),
         of("dob_gms", "and GMS", gms, observed)}};
}

} // namespace quadrant_reproduce
