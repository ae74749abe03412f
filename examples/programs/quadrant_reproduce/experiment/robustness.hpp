// SPDX-License-Identifier: BSL-1.0
// Long: robustness() is a list of what is changed, each with its two figures.
#pragma once
#include "cutting.hpp"

#include <algorithm>
#include <limits>

namespace quadrant_reproduce {

/// A machine that is not the one of the controller's tables.
struct wrong_table {
    const char* name;
    thesis::cut cut;
    bool lugre = false; ///< friction by another law
    const char* note = "";
};

/// Largest |Q W (1 - L T)| of both axes when the mass is not what L was made for; below 1 the memory converges
/// for every cycle.
inline double learning_mismatch(const thesis::cut& c) {
    namespace qa = quadrant::analysis;
    double worst = 0;
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        thesis::axis heavier = *a;
        heavier.B = a->B / c.mass;
        const auto t = thesis::tracking_of(heavier, *a);
        worst = std::max(worst, qa::stability(t, thesis::learning_of(*a), thesis::smoothing_of(c), c.weights,
                                              qa::up_to_nyquist(thesis::period))
                                    .value);
    }
    return worst;
}

template <class Configuration> thesis::circle_result mill(const wrong_table& table) {
    return table.lugre ? thesis::mill<Configuration, thesis::lugre_plant>(table.cut)
                       : thesis::mill<Configuration>(table.cut);
}

/// Rms of (iii) while one property of the machine runs over its range; where it is stopped the line is
/// interrupted.
template <class Change>
picture sweep(const std::string& title, const std::string& label, double from, double to, int steps,
              Change&& change) {
    panel rms{.x_label = label, .y_label = "radial error, rms [um]", .lines = {}, .log_y = true};
    const auto draw = [&](const char* name, auto&& at) {
        line drawn{.name = name, .x = {}, .y = {}};
        for (int i = 0; i <= steps; ++i) {
            const double value = from + (to - from) * i / steps;
            thesis::cut c{.cycle = thesis::exact_cycle};
            change(c, value);
            const auto found = at(c);
            drawn.x.push_back(value);
            drawn.y.push_back(found.diverged ? std::numeric_limits<double>::quiet_NaN() : found.rms);
        }
        rms.lines.push_back(std::move(drawn));
    };
    draw("(ii) observer and GMS", [](const thesis::cut& c) { return thesis::mill<thesis::compensated>(c); });
    draw("(iii) weights [2, -1]", [](const thesis::cut& c) { return thesis::mill<thesis::learning>(c); });
    draw("(iii) weights [1]", [](thesis::cut c) {
        c.weights = thesis::first_order;
        return thesis::mill<thesis::learning>(c);
    });
    return {title,
            "Circle of 30 mm at 100 mm/s under cutting; a line ends where the run was unstable.",
            {std::move(rms)}};
}

inline outcome learning_on(const std::string& id, wrong_table table) {
    outcome out{{radial_row(id, "radial_rms", mill<thesis::learning>(table), table.note)}};
    table.cut.weights = thesis::first_order;
    out.rows.push_back(radial_row(id, "radial_rms_first_order", mill<thesis::learning>(table), "weights [1]"));
    if (table.cut.mass == 1 || table.cut.noise > 0) return out;
    const auto with_mismatch = [&](const std::string& quantity) {
        out.rows.push_back(
            {id,
             quantity,
             "1",
             learning_mismatch(table.cut),
             {},
             {},
             {},
             "largest |Q (1 - L T)| with this mass; weights [2, -1] treble it; surely stable below 1"});
    };
    with_mismatch("largest_mismatch_first_order");
    table.cut.smoothing = 60;
    out.rows.push_back(radial_row(id, "radial_rms_first_order_60Hz", mill<thesis::learning>(table),
                                  "weights [1], Q of 60 Hz: what the cutter does above that stays"));
    with_mismatch("largest_mismatch_first_order_60Hz");
    return out;
}

/// From which to which mass (iii) runs, in steps of 0.05.
inline outcome mass_range(const std::string& id) {
    outcome out;
    out.pictures = {sweep("Radial error over the mass", "mass, machine over controller", 0.5, 1.5, 20,
                          [](thesis::cut& c, double mass) { c.mass = mass; })};
    const auto& lines = out.pictures[0].panels[0].lines;
    for (const auto& [which, name] : {std::pair{&lines[1], ""}, std::pair{&lines[2], "_first_order"}}) {
        const auto middle = which->y.size() / 2;
        auto from = middle, to = middle;
        while (from > 0 && std::isfinite(which->y[from - 1])) --from;
        while (to + 1 < which->y.size() && std::isfinite(which->y[to + 1])) ++to;
        const std::string note = "searched between 0.5 and 1.5 in steps of 0.05";
        out.rows.push_back({id, std::string("stable_from") + name, "1", which->x[from], {}, {}, {}, note});
        out.rows.push_back({id, std::string("stable_to") + name, "1", which->x[to], {}, {}, {}, note});
    }
    return out;
}

/// The largest figures of a sweep; none when one of its runs was stopped.
inline outcome worst_of(const std::string& id, const std::string& note, picture over) {
    outcome out;
    const auto& lines = over.panels[0].lines;
    for (const auto& [which, name] : {std::pair{&lines[1], ""}, std::pair{&lines[2], "_first_order"}}) {
        thesis::circle_result worst;
        for (const double rms : which->y) {
            worst.diverged = worst.diverged || !std::isfinite(rms);
            worst.rms = std::max(worst.rms, rms);
        }
        out.rows.push_back(radial_row(id, std::string("largest_radial_rms") + name, worst, note));
    }
    out.pictures.push_back(std::move(over));
    return out;
}

inline experiment robustness() {
    const double exact = thesis::exact_cycle;
    const std::vector<wrong_table> tables{
        {"as_believed", {.cycle = exact}},
        {"lugre",
         {.cycle = exact},
         true,
         "one bristle that breaks away over 4 um, levels 10 % higher, other viscous part"},
        {"adjusted", {.friction_y = thesis::y_adjusted, .cycle = exact}, false, "y axis of Table 4.3b"},
        {"mass_minus_50", {.mass = 0.5, .cycle = exact}},
        {"mass_plus_50", {.mass = 1.5, .cycle = exact}},
        {"spindle_minus_1", {.spindle = 0.99, .cycle = exact}},
        {"spindle_plus_1", {.spindle = 1.01, .cycle = exact}},
        {"noise_025", {.cycle = exact, .noise = 0.25}, false, "encoders with 0.25 um rms of white noise"},
        {"noise_1", {.cycle = exact, .noise = 1}, false, "encoders with 1 um rms of white noise"},
        {"lugre_spindle_noise",
         {.spindle = 1.01, .cycle = exact, .noise = 0.25},
         true,
         "LuGre, spindle 1 % faster, noise of 0.25 um"},
        {"adjusted_mass_noise",
         {.friction_y = thesis::y_adjusted, .mass = 1.2, .cycle = exact, .noise = 0.25},
         false,
         "Table 4.3b, mass + 20 %, noise of 0.25 um"},
        {"lugre_mass_spindle_noise",
         {.mass = 1.5, .spindle = 1.01, .cycle = exact, .noise = 1},
         true,
         "LuGre, mass + 50 %, spindle 1 % faster, noise of 1 um"}};
    experiment e{
        "How much may the tables be wrong",
        "not in the thesis; circle and forces of its Table 5.4",
        "The controllers stay those of the tables, memory of 85.859 periods; the machine is another one. L "
        "inverts the loop of the believed mass: |Q W (1 - L T)| passes 1 before the mass is off by 50 %, and "
        "what is unstable has no figure. With a Q of 60 Hz it is stable again, and gains less. Weights [2, -1] "
        "forgive a wrong cycle, and pay twice for noise, for other friction and for a wrong mass.",
        0.10,
        {}};
    for (const wrong_table& table : tables) {
        const std::string id = std::string("milling.robustness.") + table.name;
        const auto alone = [=](const char* which, auto run) {
            return run_case{id + which,
                            [=] { return outcome{{radial_row(id + which, "radial_rms", run(), table.note)}}; }};
        };
        e.cases.push_back(alone(".i", [=] { return mill<thesis::uncompensated>(table); }));
        e.cases.push_back(alone(".ii", [=] { return mill<thesis::compensated>(table); }));
        e.cases.push_back({id + ".iii", [=] { return learning_on(id + ".iii", table); }});
    }
    const std::string mass = "milling.robustness.mass_range.iii",
                      speed = "milling.robustness.spindle_range.iii",
                      noise = "milling.robustness.noise_range.iii";
    e.cases.push_back({mass, [=] { return mass_range(mass); }});
    e.cases.push_back({speed, [=] {
                           return worst_of(
                               speed, "between 4 % slower and 4 % faster than the memory knows",
                               sweep("Radial error over the cutter's speed",
                                     "speed over the one that the memory knows [%]", -4, 4, 8,
                                     [](thesis::cut& c, double percent) { c.spindle = 1 + percent / 100; }));
                       }});
    e.cases.push_back({noise, [=] {
                           return worst_of(noise, "encoder noise up to 1 um rms",
                                           sweep("Radial error over encoder noise", "noise, rms [um]", 0, 1, 8,
                                                 [](thesis::cut& c, double rms) { c.noise = rms; }));
                       }});
    return e;
}

} // namespace quadrant_reproduce
