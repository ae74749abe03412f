// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cutting.hpp"

#include <quadrant/memory/cycle_tracker.hpp>

namespace quadrant_reproduce {

/// A cut through which the spindle becomes slower, and what its memories made of it.
struct spindle_change {
    double before = 0, after = 0; ///< radial rms, um: over the turn before, over the last turn
    double cycle = 0;             ///< of the memory at the end, in periods
    bool diverged = false;
    line radial{.name = "", .x = {}, .y = {}};
};
/// The circle of Table 5.4 in configuration (iii), five turns; after two the spindle turns 2 % slower. The
/// cycle of each memory stays, or follows what the axis' observer sees.
inline spindle_change mill_through_change(const thesis::order_2& weights, bool follows,
                                          const std::string& name) {
    using namespace quadrant;
    using namespace quadrant::literals;
    constexpr double slower = 0.98;
    thesis::cut c{.cycle = thesis::exact_cycle, .weights = weights, .turns = 5};
    thesis::table_in_cut<thesis::learning, thesis::gms_plant> table(c);
    using motion = typename decltype(table)::loop::motion;
    using tracker = cycle_tracker<signal::voltage, 100>;
    const tracker::parameters watch{
        .cycle = thesis::exact_cycle * thesis::period, .range = 0.05, .settles_in = 300_ms};
    tracker of_x(watch, thesis::period), of_y(watch, thesis::period);
    thesis::synthesized fast(c);
    c.spindle = slower;
    thesis::synthesized slow(c);
    const double w = c.feed / c.radius, T = thesis::period.value(), start = 0.05;
    const auto turn = static_cast<std::size_t>(2 * thesis::pi_ / w / T);
    thesis::divergence_guard runs_away(100, 100 * turn); // the error grows where the spindle changes
    spindle_change found;
    found.radial.name = name;
    table.settle(c.radius * 1_m);
    for (std::size_t k = 0; k < 5 * turn; ++k) {
        const double t = static_cast<double>(k) * T, fade = std::exp(-t / start);
        const double angle = w * (t - start * (1 - fade)), speed = w * (1 - fade), gain = w / start * fade;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double error = 1e6 * (table.from_middle() - c.radius);
        if (runs_away(error) || table.stopped()) {
            found.diverged = true;
            return found;
        }
        if (k >= turn && k < 2 * turn) found.before += error * error / static_cast<double>(turn);
        if (k >= 4 * turn) found.after += error * error / static_cast<double>(turn);
        if (k >= turn && k % 4 == 0) found.radial.x.push_back(t), found.radial.y.push_back(error);
        const auto push = k < 2 * turn ? fast(0) : slow(0);
        const auto along = [&](double p, double v, double a) {
            return motion{c.radius * p * 1_m, c.radius * v * 1_mps, c.radius * a * 1_mps2};
        };
        table.step({.x = along(cosine, -sine * speed, -sine * gain - cosine * speed * speed),
                    .y = along(sine, cosine * speed, cosine * gain - sine * speed * speed)},
                   push.x, push.y);
        auto& control = table.whole().control();
        of_x(control.x().wire.disturbance), of_y(control.y().wire.disturbance);
        if (follows) {
            control.x().box.memory.cycle(of_x.cycle());
            control.y().box.memory.cycle(of_y.cycle());
        }
    }
    found.before = std::sqrt(found.before), found.after = std::sqrt(found.after);
    found.cycle = table.whole().control().y().box.memory.cycle() / thesis::period;
    return found;
}

inline outcome cycle_case(const std::string& id) {
    outcome out;
    panel drawn{
        .x_label = "time [s]", .y_label = "radial error [um]", .lines = {}, .y_range = std::pair{-12.0, 12.0}};
    for (const auto& [weights, words, suffix] : {std::tuple{thesis::first_order, "weights [1]", "_first_order"},
                                                 {thesis::flattest, "weights [2, -1]", ""}})
        for (const bool follows : {false, true}) {
            auto found = mill_through_change(weights, follows, follows ? "cycle followed" : "cycle held");
            const std::string how = (follows ? "followed" : "held") + std::string(suffix);
            const auto figure = [&](const std::string& quantity, const char* unit, double value,
                                    std::optional<double> reference, const std::string& note) {
                out.rows.push_back({id,
                                    quantity,
                                    unit,
                                    found.diverged ? std::nullopt : std::optional(value),
                                    {},
                                    {},
                                    reference,
                                    found.diverged ? stopped_note : note});
            };
            if (!follows)
                figure("radial_rms_before" + std::string(suffix), "um", found.before, {},
                       std::string(words) + ": before the spindle slows down by 2 %");
            figure("radial_rms_" + how, "um", found.after, {}, std::string(words) + ": three turns later");
            if (follows)
                figure("cycle_" + how, "1", found.cycle, thesis::exact_cycle / 0.98,
                       "periods, of the y axis at the end; the reference is the spindle's");
            if (weights == thesis::first_order) drawn.lines.push_back(std::move(found.radial));
        }
    out.pictures = {
        {"The spindle slows down by 2 %",
         "Radial error on the circle of 30 mm, weights [1], from the second turn on; the spindle slows "
         "down at 3.8 s.",
         {std::move(drawn)}}};
    return out;
}

/// Glitches of the y axis with observer on a machine whose friction is another one, by model and by one that
/// learns its level.
inline outcome level_case(const std::string& id) {
    outcome out;
    picture drawn{
        "Axis y with a third more friction",
        "Tracking error at 100 mm/s with observer, the last cycle: GMS friction fed forward as the table has "
        "it, and with a level that is learned.",
        {panel{.x_label = "time [s]", .y_label = "tracking error [um]", .lines = {}}}};
    for (const double level : {1.0, 4.0 / 3, 2.0 / 3}) {
        const thesis::reading how{.substeps = 20, .cycles = 4, .level = level};
        const std::string machine = level == 1 ? "as_believed" : level > 1 ? "more" : "less";
        line error{.name = "", .x = {}, .y = {}};
        const auto keep = [&](const thesis::moment& m) {
            if (m.turns >= 6) error.x.push_back(m.time), error.y.push_back(m.error);
        };
        const auto add = [&](const thesis::lag& found, const std::string& how_fed, const char* name) {
            const std::string note = level == 1  ? "friction as the table has it"
                                     : level > 1 ? "a third more friction than the table"
                                                 : "a third less";
            out.rows.push_back(
                {id,
                 "quadrant_glitch_" + machine + how_fed,
                 "um",
                 found.diverged ? std::nullopt : std::optional(found.worst),
                 {},
                 {},
                 {},
                 found.diverged ? thesis::diverged_note : note + "; the largest after the first reversal"});
            if (level > 1) {
                error.name = name;
                drawn.panels[0].lines.push_back(error);
            }
            error.x.clear(), error.y.clear();
        };
        add(thesis::run<thesis::gms_model, thesis::observer>(thesis::y, how, keep), "", "GMS of the table");
        const auto learned = thesis::run<thesis::learning_model, thesis::observer>(thesis::y, how, keep);
        add(learned, "_learned", "level learned");
        out.rows.push_back({id,
                            "level_" + machine,
                            "1",
                            learned.level,
                            {},
                            {},
                            level,
                            "after four cycles; the reference is the machine's"});
    }
    out.pictures = {std::move(drawn)};
    return out;
}

inline experiment adaptation() {
    const std::string cycle = "milling.adaptation.cycle", level = "milling.adaptation.level";
    return {
        "A machine that changes",
        "not in the thesis; circle and forces of its Table 5.4, friction run of its section 4.2",
        "Two things that the authors would meet next. The spindle changes its speed: a `cycle_tracker` on what "
        "the "
        "observer of each axis sees leads the memory. The friction changes by a third: a "
        "`maxwell_slip_observer` "
        "learns the level of the GMS model from what the observer is left with, with a time constant of 0.5 s.",
        0.10,
        {{cycle, [=] { return cycle_case(cycle); }}, {level, [=] { return level_case(level); }}}};
}

} // namespace quadrant_reproduce
