// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction_run.hpp"
#include "../one_axis.hpp"
#include "../row.hpp"

#include <cmath>
#include <complex>

namespace quadrant_reproduce {

/// Amplitude [um] of the error that a sinusoidal push of 1 V leaves on the resting, linear axis; nothing when
/// it diverges.
template <class Observer, template <class, class> class Axis = thesis::one_axis>
std::optional<double> error_under_push(const thesis::axis& a, typename Observer::box::parameters observer,
                                       double hertz) {
    using namespace quadrant;
    using namespace quadrant::literals;
    using boxes = milling_axis_boxes<thesis::no_friction_model::box, typename Observer::box>;
    using motor = linear_motor<coulomb_viscous<>>;
    auto controller = thesis::controller_of<boxes>(a);
    controller.plant_pole = a.A; // friction in it
    controller.disturbance = observer;
    Axis<boxes, motor> axis({controller, thesis::linear_machine(a, a.delay - 0.5 * thesis::period, 10)});
    const typename Axis<boxes, motor>::motion rest{}; // the hold is the rest of Td
    std::complex<double> sum = 0;
    const int second = 2000, settles = 2 * second;
    for (int k = 0; k < settles + second; ++k) {
        const double angle = 2 * thesis::pi_ * hertz * k * thesis::period.value();
        if (k >= settles) sum += axis.now().x.value() * std::polar(2.0 / second, -angle);
        axis.step(rest, rest, a.kf * (std::sin(angle) * 1_V));
        if (axis.stopped() || !(std::abs(axis.now().x.value()) < 0.01)) return std::nullopt;
    }
    return 1e6 * std::abs(sum);
}

inline outcome dob_force_case(const thesis::axis& a) {
    outcome out;
    const std::string id = std::string("thesis.dob_force.") + a.name;
    for (const int hertz : {1, 58, 100}) {
        const std::string quantity = "error_" + std::to_string(hertz) + "Hz_";
        const auto add = [&](const char* what, std::optional<double> error) {
            out.rows.push_back(
                {id, quantity + what, "um", error, {}, {}, {}, error ? "" : thesis::diverged_note});
        };
        add("off", error_under_push<thesis::no_observer>(a, {}, hertz));
        add("on", error_under_push<thesis::observer>(
                      a, {a.corner, quadrant::axis_model<quadrant::signal::voltage>{a.B, a.A}}, hertz));
    }
    line off{.name = "without observer", .x = {}, .y = {}}, on{.name = "with observer", .x = {}, .y = {}};
    for (const int hertz :
         {1, 2, 3, 5, 7, 10, 14, 20, 25, 30, 35, 40, 45, 50, 58, 66, 75, 85, 100, 115, 130, 150, 200, 300}) {
        const auto draw = [&](line& into, std::optional<double> error) {
            into.x.push_back(hertz);
            into.y.push_back(error.value_or(NAN));
        };
        draw(off, error_under_push<thesis::no_observer>(a, {}, hertz));
        draw(on, error_under_push<thesis::observer>(
                     a, {a.corner, quadrant::axis_model<quadrant::signal::voltage>{a.B, a.A}}, hertz));
    }
    // Where the observer stops helping: the first crossing of the two lines, straight between them.
    std::optional<double> crossing;
    for (std::size_t i = 1; i < off.x.size() && !crossing; ++i) {
        const double before = std::log(on.y[i - 1] / off.y[i - 1]), now = std::log(on.y[i] / off.y[i]);
        if (before < 0 && now >= 0)
            crossing = off.x[i - 1] + (off.x[i] - off.x[i - 1]) * before / (before - now);
    }
    out.rows.push_back({id, "helps_up_to", "Hz", crossing, {}, {}, {}, "between the lines of the picture"});
    panel drawn{.x_label = "frequency [Hz]",
                .y_label = "error amplitude [um]",
                .lines = {off, on},
                .log_x = true,
                .log_y = true};
    if (a.name == std::string("y"))
        drawn.lines.push_back({.name = "published, Fig. 5.3",
                               .x = {1, 1, 58, 58.2, 100, 100},
                               .y = {133, 2.96, 109, 112, 36.4, 57.8},
                               .drawn = line::style::points});
    out.pictures = {{std::string("Axis ") + a.name + ": error under a push of 1 V",
                     "Where the lines cross the observer stops helping; above it makes worse.",
                     {std::move(drawn)}}};
    return out;
}

inline experiment dob_force() {
    return {
        "A sinusoidal force against the observer",
        "[Jamaludin2008] eqs. (4.20), (5.1), (5.2), Figs. 5.2 and 5.3",
        "The resting axis on its linear model is pushed as by 1 V at the motor; simulated sample by sample "
        "at 2 kHz with the delay and the hold. The thesis prints the amplitudes of the y axis, simulated "
        "(Fig. 5.2) and by the transfer functions (Fig. 5.3); it takes 1 V for 1450 N, which is the x axis.",
        0.02,
        {{"thesis.dob_force.x", [] { return dob_force_case(thesis::x); }},
         {"thesis.dob_force.y", [] { return dob_force_case(thesis::y); }}}};
}

} // namespace quadrant_reproduce
