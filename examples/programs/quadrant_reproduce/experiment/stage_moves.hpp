// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "../stage.hpp"

namespace quadrant_reproduce {

inline const char* const stage_source = "[LowKeck2003]; parameters: shared/reference/linear_stage.md";

/// Lines of one run, as the source's figures have them.
struct stage_lines {
    line position, error, command, speed_over_position;
    explicit stage_lines(const std::string& name)
        : position{.name = name, .x = {}, .y = {}}, error{position}, command{position}, speed_over_position{
                                                                                            position} {}
    void add(const stage::moment& m) {
        position.x.push_back(m.time), position.y.push_back(1e6 * m.position);
        error.x.push_back(m.time), error.y.push_back(1e6 * m.error());
        command.x.push_back(m.time), command.y.push_back(m.command);
        speed_over_position.x.push_back(1e6 * m.position), speed_over_position.y.push_back(m.velocity);
    }
};
template <class Compensation>
stage_lines stage_run(const std::string& name, const stage::tuning& t, double length, double time, double end) {
    stage_lines lines(name);
    stage::move<Compensation>(stage::real, stage::believed, t, length, time, end,
                              [&](const stage::moment& m) { lines.add(m); });
    return lines;
}
inline picture stage_picture(const std::string& title, const std::string& caption, stage_lines&& l) {
    const bool far = l.position.y.back() > 2000; // um
    if (far)                                     // in millimetres
        for (auto* numbers : {&l.position.y, &l.speed_over_position.x})
            for (double& um : *numbers) um *= 1e-3;
    const std::string position = far ? "position [mm]" : "position [um]";
    return {
        title,
        caption,
        {panel{.x_label = "time [s]", .y_label = position, .lines = {std::move(l.position)}},
         panel{.x_label = "time [s]", .y_label = "error [um]", .lines = {std::move(l.error)}},
         panel{.x_label = "time [s]", .y_label = "current [A]", .lines = {std::move(l.command)}},
         panel{.x_label = position, .y_label = "speed [m/s]", .lines = {std::move(l.speed_over_position)}}}};
}

/// A move with tight gains and the friction fed forward, beside one without that.
inline outcome stage_long_move(const std::string& id, double length, double time, const std::string& title) {
    const double end = time + 2;
    const auto with = stage::usual<stage::fed_forward>(stage::real, stage::believed, stage::tight, length, time,
                                                       end),
               without = stage::usual<stage::no_feedforward>(stage::real, stage::believed, stage::tight, length,
                                                             time, end);
    outcome out;
    out.rows = {{id, "peak_speed", "m/s", with.peak_speed, {}, {}, {}, ""},
                {id, "peak_speed_at", "s", with.peak_speed_at, {}, {}, {}, ""},
                {id, "settling_time", "s", with.settling, {}, {}, {}, "published: at the set time"},
                {id, "max_error", "um", with.max_error, {}, {}, {}, ""},
                {id, "final_error", "um", with.final, {}, {}, {}, "half a count of the encoder is 0.5 um"},
                {id, "peak_current", "A", with.peak_command, {}, {}, {}, ""},
                {id, "max_error_uncompensated", "um", without.max_error, {}, {}, {}, ""}};
    const std::string caption = "Reference minus axis; current; speed over position.";
    stage_lines plain =
        stage_run<stage::no_feedforward>("no friction compensation", stage::tight, length, time, time + 0.2);
    const auto& u = plain.command;
    std::size_t sharpest = 1;
    const auto bend = [&](std::size_t k) { return std::abs(u.y[k - 1] - 2 * u.y[k] + u.y[k + 1]); };
    for (std::size_t k = 1; k + 1 < u.y.size(); ++k)
        if (bend(k) > bend(sharpest)) sharpest = k;
    out.rows.push_back(
        {id,
         "current_bends_at",
         "s",
         u.x[sharpest],
         {},
         {},
         {},
         "where the current of the axis without compensation bends most; friction that depends on "
         "speed alone has no change on the way, as the source's machine has"});
    out.pictures = {
        stage_picture(title, caption, std::move(plain)),
        stage_picture(title, caption,
                      stage_run<stage::fed_forward>("LuGre", stage::tight, length, time, time + 0.2))};
    return out;
}

template <class Compensation>
outcome stage_short_move(const std::string& id, const std::string& name, const std::string& note) {
    const double length = 500e-6, time = 0.2, end = 2.2;
    const auto soft =
                   stage::usual<Compensation>(stage::real, stage::believed, stage::moderate, length, time, end),
               hard = stage::usual<Compensation>(stage::real, stage::believed, stage::tight, length, time, end);
    outcome out;
    out.rows = {{id, "settling_time", "s", soft.settling, {}, {}, {}, note},
                {id, "max_error", "um", soft.max_error, {}, {}, {}, ""},
                {id, "final_error", "um", soft.final, {}, {}, {}, ""},
                {id,
                 "stuck_from",
                 "um",
                 soft.stuck_from,
                 {},
                 {},
                 {},
                 "way to go where it first stands still after half the time; published: stick-slip over the "
                 "last 50 um"},
                {id, "settling_time_tight", "s", hard.settling, {}, {}, {}, "gains of the long moves"},
                {id, "max_error_tight", "um", hard.max_error, {}, {}, {}, "gains of the long moves"}};
    out.pictures = {
        stage_picture("500 um in 0.2 s",
                      "Moderate gains: without compensation the axis sticks before the target, until the "
                      "integral frees it.",
                      stage_run<Compensation>(name, stage::moderate, length, time, 1.0))};
    return out;
}

inline experiment stage_moves() {
    return {
        "Moves of the precision stage",
        stage_source,
        "Predictive control over 10 periods of 2 ms, Kalman filter, encoder of 1 um, LuGre friction. What the "
        "controller believes of mass, motor and friction is off by 5 to 20 %. The bristles' damping falls with "
        "the "
        "speed: constant, as published, these parameters are not passive. The source's gains are not "
        "published: two sets of ours, tight for the long moves, moderate for the short one, where friction "
        "shows. Medians over nine machines whose mass differs by 0.1 %, the final error the largest of them.",
        0.02,
        {{"stage.move_300mm", [] { return stage_long_move("stage.move_300mm", 0.3, 1.0, "30 cm in 1 s"); }},
         {"stage.move_20mm", [] { return stage_long_move("stage.move_20mm", 0.02, 0.5, "2 cm in 0.5 s"); }},
         {"stage.move_500um.none",
          [] {
              return stage_short_move<stage::no_feedforward>("stage.move_500um.none",
                                                             "no friction compensation",
                                                             "published: long, stick-slip over the last 50 um");
          }},
         {"stage.move_500um.lugre",
          [] {
              return stage_short_move<stage::fed_forward>("stage.move_500um.lugre", "LuGre",
                                                          "published: much shorter, no stick-slip");
          }},
         {"stage.move_500um.observer", [] {
              return stage_short_move<stage::observed>("stage.move_500um.observer",
                                                       "LuGre, corrected by the error", "");
          }}}};
}

} // namespace quadrant_reproduce
