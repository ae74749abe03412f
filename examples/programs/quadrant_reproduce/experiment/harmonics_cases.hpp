// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../milling_table.hpp"
#include "../push_run.hpp"
#include "../row.hpp"

namespace quadrant_reproduce {

inline std::optional<double> rms_of(const thesis::push_result& r) {
    return r.diverged ? std::nullopt : std::optional(r.rms);
}

/// The last so many seconds of a run, time from there.
inline line last_of(const std::string& name, const thesis::push_result& r, const std::vector<double>& y,
                    double seconds) {
    line out{.name = name, .x = {}, .y = {}};
    const auto count = std::min(y.size(), std::size_t(seconds / thesis::period.value()));
    for (std::size_t k = y.size() - count; k < y.size(); ++k) {
        out.x.push_back(r.time[k] - r.time[y.size() - count]);
        out.y.push_back(y[k]);
    }
    return out;
}

/// Fig. 5.7: both axes along the circle, GMS friction and the inverse model fed forward, without and with
/// observer.
inline outcome harmonics_circle(const std::string& id) {
    using namespace thesis;
    const auto off = thesis::mill<configuration<gms_model, no_observer, no_memory>>();
    const auto on = thesis::mill<compensated>();
    const auto largest = [](const circle_result& r) {
        return r.diverged ? std::nullopt : std::optional(r.largest);
    };
    outcome out;
    out.rows = {{id, "radial_max_off", "um", largest(off), {}, {}, {}, "30 mm at 100 mm/s, force scale 1.38"},
                {id, "radial_max_on", "um", largest(on), {}, {}, {}, ""}};
    panel polar{.x_label = "", .y_label = "um", .lines = {}, .polar = true, .polar_zero = 60.0};
    for (const auto& [name, r] : {std::pair{"without observer", &off}, std::pair{"with observer", &on}}) {
        line turn{.name = name, .x = {}, .y = {}};
        for (std::size_t k = r->radial.size() / 3 * 2; k < r->radial.size(); ++k)
            turn.x.push_back(r->angle[k]), turn.y.push_back(r->radial[k]);
        polar.lines.push_back(std::move(turn));
    }
    out.pictures = {{"Radial error with 15 harmonics, without and with observer",
                     "Polar plot in um about the nominal circle of 30 mm.",
                     {std::move(polar)}}};
    return out;
}

/// Figs. 5.23 and 5.24: GMS friction, its feedforward and the observer, along the sinusoid of 30 mm; without
/// and with the memory.
inline outcome harmonics_memory(const std::string& id, const thesis::axis& a) {
    using namespace thesis;
    outcome out;
    picture errors{
        "The memory against 1 to 15 harmonics",
        "Tracking error along the sinusoid of 30 mm, the last half second, without and with the memory.",
        {}};
    const auto& table = a.name == std::string("x") ? milling_harmonics::x : milling_harmonics::y;
    const auto follow = [&](auto configured, int harmonics) {
        using chosen = decltype(configured);
        const cut c{.cycle = exact_cycle, .weights = first_order};
        table_in_cut<chosen, gms_plant> both(c); // the other axis stands
        using motion = typename decltype(both)::loop::motion;
        const bool of_y = a.name == std::string("y");
        auto some = table;
        for (std::size_t i = std::size_t(harmonics); i < 15; ++i) some.real[i] = some.imaginary[i] = 0;
        cutting_force<15> cutter({milling_harmonics::fundamental, c.force * milling_harmonics::scale, some},
                                 period);
        push_result r;
        const double w = 0.1 / 0.03, T = period.value(), end = 2 * 2 * pi_ / w;
        double squares = 0, counted = 0;
        for (int k = 0; k * T < end; ++k) {
            const double t = k * T, x = 0.03 * (1 - std::cos(w * t));
            const double error = 1e6 * (x - both.place(of_y));
            if (!(std::abs(error) < 1000) || both.stopped()) return push_result{.diverged = true};
            r.time.push_back(t), r.error.push_back(error);
            if (t > end / 2) squares += error * error, counted += 1;
            const motion along{x * 1_m, 0.03 * w * std::sin(w * t) * 1_mps,
                               0.03 * w * w * std::cos(w * t) * 1_mps2};
            const auto push = cutter();
            both.step({.x = of_y ? motion{} : along, .y = of_y ? along : motion{}}, of_y ? 0.0 * push : push,
                      of_y ? push : 0.0 * push);
        }
        r.rms = std::sqrt(squares / counted);
        return r;
    };
    for (const int h : {1, 2, 3, 15}) {
        const auto off = follow(compensated{}, h), on = follow(thesis::learning{}, h);
        const std::string n = std::to_string(h);
        out.rows.push_back({id, "rms_off_" + n, "um", rms_of(off), {}, {}, {}, "observer and GMS feedforward"});
        out.rows.push_back(
            {id, "rms_on_" + n, "um", rms_of(on), {}, {}, {}, "and the memory, weights [1], exact cycle"});
        if (a.name == std::string("y"))
            errors.panels.push_back(
                panel{.x_label = h == 15 ? "time [s]" : "",
                      .y_label = n + (h == 1 ? " harmonic [um]" : " harmonics [um]"),
                      .lines = {last_of("without", off, off.error, 0.5), last_of("with", on, on.error, 0.5)}});
    }
    if (!errors.panels.empty()) out.pictures = {std::move(errors)};
    return out;
}

/// Fig. 5.10: the force on the resting y axis and what the estimator says of it, without being fed back.
struct ferraris_lines {
    line given{.name = "force", .x = {}, .y = {}}, estimated{.name = "estimate", .x = {}, .y = {}};
};
template <template <class, class> class Axis = thesis::one_axis>
ferraris_lines ferraris_run(bool fed_back = false) {
    using namespace thesis;
    using boxes = milling_axis_boxes<absent<signal::velocity, signal::voltage>, by_ferraris>;
    auto c = controller_of<boxes>(y);
    c.plant_pole = y.A;
    c.disturbance = {.feeds_back = fed_back};
    Axis<boxes, linear_motor<coulomb_viscous<>>> axis({c, linear_machine(y, 0.4_ms, 10)});
    const typename decltype(axis)::motion rest{};
    cutting_force<15> cutter(
        {milling_harmonics::fundamental, 1.38 * milling_harmonics::scale, milling_harmonics::y}, period);
    ferraris_lines out;
    auto before = axis.now().v;
    for (int k = 0; k < 2400; ++k) {
        axis.disturbance().sense((axis.now().v - before) / period);
        before = axis.now().v;
        const auto force = cutter();
        axis.step(rest, rest, force);
        if (k < 2000) continue; // the estimate after the step is the one of this sample
        const double t = (k - 2000) * period.value();
        out.given.x.push_back(t), out.given.y.push_back(force.value());
        out.estimated.x.push_back(t), out.estimated.y.push_back(axis.disturbance().force().value());
    }
    return out;
}
inline outcome ferraris_estimate(const std::string& id) {
    using namespace thesis;
    const auto [given, estimated] = ferraris_run();
    auto fed_back = ferraris_run(true).estimated;
    fed_back.name = "estimate, fed back";
    double squares_of_force = 0, squares_of_rest = 0;
    for (std::size_t k = 0; k < given.y.size(); ++k) {
        squares_of_force += given.y[k] * given.y[k];
        squares_of_rest += std::pow(fed_back.y[k] - given.y[k], 2);
    }
    // How late: the shift that fits best, in steps of a sample.
    double best = HUGE_VAL, late = 0;
    for (std::size_t shift = 0; shift < 30; ++shift) {
        double squares = 0;
        for (std::size_t k = 30; k < given.y.size(); ++k) {
            const double e = estimated.y[k] - given.y[k - shift];
            squares += e * e;
        }
        if (squares < best) best = squares, late = double(shift) * period.value();
    }
    outcome out;
    out.rows = {
        {id,
         "estimate_late_by",
         "ms",
         1e3 * late,
         {},
         {},
         {},
         "the shift by whole samples that fits the force best; the thesis sees it late, without a number"},
        {id,
         "left_when_fed_back",
         "%",
         100 * std::sqrt(squares_of_rest / squares_of_force),
         {},
         {},
         {},
         "of the force, rms, that the estimate misses while it is fed back; the thesis calls it poor"}};
    out.pictures = {
        {"The force and what the Ferraris estimator says of it",
         "y axis at rest, 15 harmonics, Q of 90 Hz: while the estimate is not fed back, and while it is.",
         {panel{.x_label = "time [s]",
                .y_label = "force [N]",
                .lines = {given, estimated, std::move(fed_back)}}}}};
    return out;
}

} // namespace quadrant_reproduce
