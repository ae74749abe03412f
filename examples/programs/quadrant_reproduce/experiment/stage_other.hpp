// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "stage_moves.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// The short move on a stage of another mass, with friction by another law than the one that is fed forward.
inline outcome stage_other_case(const std::string& id) {
    outcome out;
    picture drawn{
        "500 um in 0.2 s on another stage",
        "Largest error and time into 2 um over the mass; friction by two springs instead of LuGre, the "
        "controller believes LuGre with numbers of its own. Means of three machines that differ by 0.2 % of "
        "their mass.",
        {panel{.x_label = "", .y_label = "largest error [um]", .lines = {}},
         panel{.x_label = "mass, machine over controller", .y_label = "settled after [s]", .lines = {}}}};
    const auto with = [&]<class Compensation>(const char* name, Compensation) {
        line error{.name = name == std::string_view("none")    ? "no friction compensation"
                           : name == std::string_view("lugre") ? "LuGre fed forward"
                                                               : "LuGre observer",
                   .x = {},
                   .y = {}},
            settles = error;
        for (const double mass : {0.5, 0.75, 1.0, 1.25, 1.5}) {
            double most = 0, time = 0;
            constexpr int machines = 3;
            for (int k = 0; k < machines; ++k) {
                stage::machine is = stage::real;
                is.mass = stage::believed.mass * mass * (1 + 2e-3 * (k - 1));
                const auto f = stage::move<Compensation, stage::springs_machine>(
                    is, stage::believed, stage::moderate, 500e-6, 0.2, 1.5, [](const stage::moment&) {});
                most += f.max_error / machines, time += f.settling / machines;
            }
            error.x.push_back(mass), error.y.push_back(most);
            settles.x.push_back(mass), settles.y.push_back(time);
            if (mass == 0.5 || mass == 1 || mass == 1.5) {
                out.rows.push_back(
                    {id, fmt::format("max_error_{}_mass_{:g}", name, mass), "um", most, {}, {}, {}, ""});
                out.rows.push_back(
                    {id, fmt::format("settling_time_{}_mass_{:g}", name, mass), "s", time, {}, {}, {}, ""});
            }
        }
        drawn.panels[0].lines.push_back(std::move(error));
        drawn.panels[1].lines.push_back(std::move(settles));
    };
    with("none", stage::no_feedforward{});
    with("lugre", stage::fed_forward{});
    with("observer", stage::observed{});
    out.pictures = {std::move(drawn)};
    return out;
}

inline experiment stage_other() {
    const std::string id = "stage.robustness";
    return {"The precision stage on another machine",
            stage_source,
            "The move that shows friction, with half to one and a half times the mass that the controller "
            "believes.",
            0.10,
            {{id, [=] { return stage_other_case(id); }}}};
}

} // namespace quadrant_reproduce
