// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "stage_moves.hpp"

#include <quadrant/analysis/genetic.hpp>

#include <array>
#include <cmath>

namespace quadrant_reproduce {

/// A move with the two current loops of Fig. 2, beside one whose current follows at once.
inline outcome stage_current_case(const std::string& id, const std::string& title, double length, double time,
                                  const stage::tuning& t) {
    stage::machine with = stage::real;
    with.current_loops = true;
    outcome out;
    for (const auto& [name, machine] : {std::pair{"ideal", stage::real}, std::pair{"loops", with}}) {
        const auto f = stage::usual<stage::fed_forward>(machine, stage::believed, t, length, time, time + 1);
        const std::string suffix = std::string("_") + name;
        out.rows.push_back({id, "settling_time" + suffix, "s", f.settling, {}, {}, {}, ""});
        out.rows.push_back({id, "max_error" + suffix, "um", f.max_error, {}, {}, {}, ""});
        stage_lines lines(name == std::string("ideal") ? "current at once" : "two current loops");
        stage::move<stage::fed_forward>(machine, stage::believed, t, length, time, time + 0.2,
                                        [&](const stage::moment& m) { lines.add(m); });
        out.pictures.push_back(stage_picture(title,
                                             "Reference minus axis; commanded current; speed over position. "
                                             "300 Hz of bandwidth, twenty steps a period.",
                                             std::move(lines)));
    }
    return out;
}

/// Mean force [N] at a constant speed, once the bristles are bent: the command times the force constant.
inline double stage_force_at(double speed) {
    const auto reference = [&](double at) {
        constexpr double start = 0.2; // s
        const double t = std::max(at, 0.0);
        return t < start
                   ? quadrant::axis_motion<>{quadrant::in_si(0.5 * speed / start * t * t),
                                             quadrant::in_si(speed / start * t), quadrant::in_si(speed / start)}
                   : quadrant::axis_motion<>{quadrant::in_si(speed * (t - 0.5 * start)), quadrant::in_si(speed),
                                             quadrant::in_si(0.0)};
    };
    double sum = 0;
    int count = 0;
    stage::run<stage::fed_forward>(stage::real, stage::believed, stage::tight, reference, 3,
                                   [&](const stage::moment& m) {
                                       if (m.time >= 1) sum += stage::real.force_constant * m.command, ++count;
                                   });
    return sum / count;
}

/// Fig. 4: forces at constant speeds, and the four static parameters found from them by the genetic algorithm,
/// as the source does.
inline outcome stage_friction_case(const std::string& id) {
    using namespace quadrant::analysis;
    static constexpr std::array speeds{2e-4,   5e-4, 1e-3, 2e-3, 4e-3, 6e-3, 1e-2,
                                       1.5e-2, 2e-2, 3e-2, 5e-2, 8e-2, 0.1};
    std::array<double, speeds.size()> force{};
    for (std::size_t i = 0; i < speeds.size(); ++i)
        force[i] = 0.5 * (stage_force_at(speeds[i]) - stage_force_at(-speeds[i]));
    const auto curve = [](const std::vector<double>& g, double v) { // eq. (13)
        return g[0] + (g[1] - g[0]) * std::exp(-(v / g[2]) * (v / g[2])) + g[3] * v;
    };
    const std::vector<gene> genes{{1, 30, true}, {1, 30, true}, {5e-4, 5e-2, true}, {1, 100, true}};
    const auto found = tune_genetic(
        genes,
        [&](const std::vector<double>& g) {
            double squares = 0;
            for (std::size_t i = 0; i < speeds.size(); ++i)
                squares += std::pow(curve(g, speeds[i]) - force[i], 2);
            return squares;
        },
        20000, {}, [](const genetic_state&) { return true; });
    const auto best = best_of(found, genes);
    const auto& m = stage::real;
    outcome out;
    out.rows = {{id, "Fc", "N", best[0], {}, {}, m.coulomb, ""},
                {id, "Fs", "N", best[1], {}, {}, m.static_level, ""},
                {id, "vs", "mm/s", 1e3 * best[2], {}, {}, 1e3 * m.stribeck, ""},
                {id, "sigma2", "N s/m", best[3], {}, {}, m.viscous, ""}};
    line measured{.name = "constant speeds", .x = {}, .y = {}, .drawn = line::style::points},
        fitted{.name = "found", .x = {}, .y = {}};
    for (std::size_t i = 0; i < speeds.size(); ++i)
        for (const double way : {-1.0, 1.0})
            measured.x.push_back(way * 1e3 * speeds[i]), measured.y.push_back(way * force[i]);
    for (double v = -100; v <= 100; v += 0.25)
        fitted.x.push_back(v), fitted.y.push_back((v < 0 ? -1 : 1) * curve(best, std::abs(v) * 1e-3));
    out.pictures = {{"Friction of the stage over speed",
                     "Forces at constant speeds both ways, and the static curve that the genetic algorithm "
                     "found from them.",
                     {panel{.x_label = "speed [mm/s]",
                            .y_label = "force [N]",
                            .lines = {std::move(fitted), std::move(measured)}}}}};
    return out;
}

inline experiment stage_drive() {
    return {
        "The drive and the friction of the stage",
        "[LowKeck2003] section III, Figs. 2 and 4, eqs. (10-13); parameters: shared/reference/linear_stage.md",
        "The two PI current loops in the frame of the magnets, in amperes, in place of a current that follows "
        "at once; and "
        "the friction map with its four static parameters found by the genetic algorithm. The reference is "
        "what was "
        "simulated: the source prints no parameter of its motor and of its friction.",
        0.10,
        {{"stage.current.300mm",
          [] {
              return stage_current_case("stage.current.300mm", "30 cm with current loops", 0.3, 1.0,
                                        stage::tight);
          }},
         {"stage.current.500um",
          [] {
              return stage_current_case("stage.current.500um", "500 um with current loops", 500e-6, 0.2,
                                        stage::moderate);
          }},
         {"stage.friction", [] { return stage_friction_case("stage.friction"); }}}};
}

} // namespace quadrant_reproduce
