// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "../virtual_cnc.hpp"

#include <quadrant/analysis/law_figures.hpp>
#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/control/acceleration_feedback.hpp>
#include <quadrant/friction/stribeck.hpp>

#include <fmt/format.h>
#include <limits>

namespace quadrant_reproduce {

/// Eq. (19) with its third measured row: the PID of Table 10 with an accelerometer in its feedback.
inline outcome accelerometer_case(const std::string& id) {
    using namespace quadrant;
    using namespace quadrant::literals;
    using law = acceleration_feedback<pid<>>;
    outcome out;
    picture drawn{
        "An accelerometer in the feedback of the PID",
        "Compliance of the x axis under the PID of Table 10, and of the y axis along the diamond its error; "
        "the "
        "accelerometer's gain makes a disturbance meet 1.5 and 2 times the inertia, and the gains of the PID "
        "go with "
        "it.",
        {panel{.x_label = "frequency [Hz]",
               .y_label = "compliance [um/N]",
               .lines = {},
               .log_x = true,
               .log_y = true},
         panel{.x_label = "time [s]", .y_label = "error of y [um]", .lines = {}}}};
    for (const double heavier : {0.0, 0.5, 1.0}) {
        const auto of = [&](const vcnc::axis& a) { // gains in proportion to what the axis now weighs
            auto gains = vcnc::pid_of(a);
            gains.gain *= 1 + heavier, gains.integral_gain *= 1 + heavier, gains.derivative_gain *= 1 + heavier;
            return law::parameters{.law = gains, .gain = heavier / vcnc::model(a).gain, .corner = 150_Hz};
        };
        const auto& a = vcnc::x_axis;
        const analysis::law_loop loop{law(of(a), vcnc::period),
                                      analysis::sampled_axis<>{vcnc::model(a), vcnc::period}};
        const std::string name =
            heavier == 0 ? "PID alone" : fmt::format("{:g} times the inertia", 1 + heavier);
        const std::string suffix = heavier == 0 ? "" : heavier == 0.5 ? "_half" : "_one";
        const double newtons_a_volt = a.amplifier * 0.4769 / (0.01 / (2 * std::numbers::pi));
        line compliance{.name = name, .x = {}, .y = {}};
        double softest = 0;
        for (double f = 1; f < 480; f *= 1.03) {
            const double um = 1e6 * std::abs(loop.disturbance(analysis::hertz(f))) / newtons_a_volt;
            compliance.x.push_back(f), compliance.y.push_back(um);
            softest = std::max(softest, um);
        }
        const auto found = analysis::frequency_figures(loop, 1_Hz, 0.5 * once_per(vcnc::period));
        out.rows.push_back({id, "stiffness_least" + suffix, "N/um", 1 / softest, {}, {}, {}, name});
        out.rows.push_back({id, "sensitivity_peak" + suffix, "1", found.sensitivity_peak, {}, {}, {}, ""});
        vcnc::servo<law> y(vcnc::y_axis, of(vcnc::y_axis), 0_m, 2);
        y.settle(vcnc::diamond::at(0).y.position);
        line error{.name = name, .x = {}, .y = {}};
        double most = 0;
        for (int k = 0; k < vcnc::diamond::samples() + 100; ++k) {
            const auto r = vcnc::diamond::at(k).y;
            const double e = 1e6 * (r.position.value() - y.place());
            most = std::max(most, std::abs(e));
            error.x.push_back(k * vcnc::period.value()), error.y.push_back(e);
            y.step(r);
        }
        out.rows.push_back(
            {id, "y_error_max" + suffix, "um", most, {}, {}, {}, "along the diamond, one seed, no backlash"});
        drawn.panels[0].lines.push_back(std::move(compliance));
        drawn.panels[1].lines.push_back(std::move(error));
    }
    out.pictures = {std::move(drawn)};
    return out;
}

/// A drive with another inertia, and Stribeck friction 10 % above the mean of both directions.
using stribeck_screw = quadrant::ball_screw_drive<
    quadrant::stribeck<quadrant::signal::angular_velocity, quadrant::signal::torque>>;
using other_boxes = quadrant::feed_drive_boxes<stribeck_screw>;
inline other_boxes::parameters other_drive(const vcnc::axis& a, double inertia, std::uint64_t seed) {
    using namespace quadrant::literals;
    const auto p = vcnc::drive(a);
    other_boxes::parameters out{
        .amplifier = p.amplifier,
        .drive = {.inertia = inertia * p.drive.inertia,
                  .viscous = p.drive.viscous,
                  .torque_constant = p.drive.torque_constant,
                  .pitch = p.drive.pitch,
                  .friction = {0.55 * (a.forward.coulomb + a.backward.coulomb) * 1_Nm,
                               0.55 * (a.forward.static_level + a.backward.static_level) * 1_Nm,
                               a.forward.fall * 1_radps,
                               {}}}};
    out.encoder_step = p.encoder_step;
    out.tachometer_noise = p.tachometer_noise;
    out.seed = seed;
    return out;
}
/// The largest contour error along the diamond [um].
template <class Law>
double largest_off_the_diamond(double inertia, typename Law::parameters (*law_of)(const vcnc::axis&)) {
    vcnc::servo<Law, other_boxes> x(other_drive(vcnc::x_axis, inertia, 2), law_of(vcnc::x_axis)),
        y(other_drive(vcnc::y_axis, inertia, 3), law_of(vcnc::y_axis));
    x.settle(vcnc::diamond::at(0).x.position), y.settle(vcnc::diamond::at(0).y.position);
    double most = 0;
    for (int k = 0; k < vcnc::diamond::samples() + 100; ++k) {
        most = std::max(most, 1e6 * vcnc::diamond::off_the_path(x.place(), y.place()));
        const auto r = vcnc::diamond::at(k);
        x.step(r.x), y.step(r.y);
    }
    return most;
}

/// The diamond on a machine with another inertia and friction by another law: Stribeck, the same both ways.
inline outcome other_machine_case(const std::string& id) {
    using namespace quadrant;
    outcome out;
    panel drawn{
        .x_label = "inertia, machine over controller", .y_label = "largest contour error [um]", .lines = {}};
    const auto along = [&]<class Law>(const char* name, typename Law::parameters (*law_of)(const vcnc::axis&),
                                      Law*) {
        line curve{.name = name == std::string_view("pid") ? "PID" : "sliding mode", .x = {}, .y = {}};
        for (const double inertia : {0.5, 0.75, 1.0, 1.25, 1.5}) {
            const double most = largest_off_the_diamond<Law>(inertia, law_of);
            const bool lost = !(most < 1000);
            curve.x.push_back(inertia),
                curve.y.push_back(lost ? std::numeric_limits<double>::quiet_NaN() : most);
            if (inertia == 0.5 || inertia == 1 || inertia == 1.5)
                out.rows.push_back({id,
                                    fmt::format("{}_inertia_{:g}", name, inertia),
                                    "um",
                                    lost ? std::nullopt : std::optional(most),
                                    {},
                                    {},
                                    {},
                                    lost ? "diverged; no figure" : "contour error, largest"});
        }
        drawn.lines.push_back(std::move(curve));
    };
    along("pid", vcnc::pid_of, static_cast<pid<>*>(nullptr));
    along("smc", vcnc::sliding_mode_of, static_cast<sliding_mode<>*>(nullptr));
    out.pictures = {
        {"The diamond on another machine",
         "Half to one and a half times the inertia, and Stribeck friction 10 % above the mean of both "
         "directions; the controllers believe the tables. A line ends where the run was lost.",
         {std::move(drawn)}}};
    return out;
}

inline experiment vcnc_other() {
    const std::string accelerometer = "vcnc.accelerometer", other = "vcnc.robustness";
    return {"The Virtual CNC with an accelerometer, and on another machine",
            "[Yeung2006] eq. (19); the machine is not in it",
            "Eq. (19) has three measured rows: position, velocity and acceleration. The third one acts as "
            "inertia that "
            "only disturbances meet. Below, PID and sliding mode law on machines that they do not know.",
            0.10,
            {{accelerometer, [=] { return accelerometer_case(accelerometer); }},
             {other, [=] { return other_machine_case(other); }}}};
}

} // namespace quadrant_reproduce
