// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "../virtual_cnc.hpp"

namespace quadrant_reproduce {

/// Largest errors along one contour [um], of the table, not of its encoder.
struct contour_figures {
    double x = 0, y = 0;
    double to_path = 0; ///< distance to the nearest place of the path
    double to_side = 0; ///< diamond: to the line through the side that is under way
};
struct contour_run {
    contour_figures most;
    std::vector<double> time, x_error, y_error; ///< [s], [um]
};

/// Both axes along the diamond or the circle, until a tenth of a second after its end.
template <class Law, class Path>
contour_run along(typename Law::parameters (*law_of)(const vcnc::axis&),
                  quadrant::quantity<quadrant::si::length> play, std::uint64_t seed) {
    constexpr bool is_diamond = std::is_same_v<Path, vcnc::diamond>;
    vcnc::servo<Law> x(vcnc::x_axis, law_of(vcnc::x_axis), play, 2 * seed),
        y(vcnc::y_axis, law_of(vcnc::y_axis), play, 2 * seed + 1);
    const vcnc::asked first = Path::at(0);
    x.settle(first.x.position);
    y.settle(first.y.position);
    contour_run run;
    const auto keep = [](double& most, double e) { most = std::max(most, 1e6 * std::abs(e)); };
    for (int k = 0; k < Path::samples() + 100; ++k) {
        const vcnc::asked r = Path::at(k);
        const double ex = r.x.position.value() - x.place(), ey = r.y.position.value() - y.place();
        keep(run.most.x, ex);
        keep(run.most.y, ey);
        keep(run.most.to_path, Path::off_the_path(x.place(), y.place()));
        if constexpr (is_diamond) keep(run.most.to_side, Path::off_the_side(k, x.place(), y.place()));
        run.time.push_back(k * vcnc::period.value());
        run.x_error.push_back(1e6 * ex);
        run.y_error.push_back(1e6 * ey);
        x.step(r.x);
        y.step(r.y);
    }
    return run;
}

/// What was computed beside it [um]; nothing for the circle.
struct contour_given {
    std::optional<double> x, y, contour;
};

template <class Law, class Path>
outcome contour_case(const std::string& id, const std::string& name,
                     typename Law::parameters (*law_of)(const vcnc::axis&), const contour_given& reference) {
    using namespace quadrant::literals;
    constexpr bool is_diamond = std::is_same_v<Path, vcnc::diamond>;
    constexpr int seeds = 5;
    contour_figures mean, with_play;
    contour_run shown;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto add = [](contour_figures& sum, const contour_figures& one) {
            sum.x += one.x / seeds, sum.y += one.y / seeds;
            sum.to_path += one.to_path / seeds, sum.to_side += one.to_side / seeds;
        };
        contour_run run = along<Law, Path>(law_of, 0_m, std::uint64_t(seed));
        add(mean, run.most);
        add(with_play, along<Law, Path>(law_of, 3_um, std::uint64_t(seed)).most);
        if (seed == 1) shown = std::move(run);
    }
    const char* without = "no backlash, mean of 5 seeds";
    const char* play = "backlash of 3 um, scale on the table";
    outcome out;
    out.rows = {{id, "x_error_max", "um", mean.x, {}, {}, reference.x, without},
                {id, "y_error_max", "um", mean.y, {}, {}, reference.y, without},
                {id,
                 "contour_error_max",
                 "um",
                 mean.to_path,
                 {},
                 {},
                 reference.contour,
                 is_diamond ? "distance to the path; no backlash, mean of 5 seeds" : without}};
    if constexpr (is_diamond)
        out.rows.push_back({id,
                            "side_error_max",
                            "um",
                            mean.to_side,
                            {},
                            {},
                            {},
                            "distance to the line of the side under way, what lies past a corner included"});
    out.rows.push_back({id, "x_error_max_with_backlash", "um", with_play.x, {}, {}, {}, play});
    out.rows.push_back({id, "y_error_max_with_backlash", "um", with_play.y, {}, {}, {}, play});
    out.rows.push_back({id, "contour_error_max_with_backlash", "um", with_play.to_path, {}, {}, {}, play});
    out.pictures = {{is_diamond ? "Tracking errors along the diamond" : "Tracking errors along the circle",
                     "Reference minus table; one seed, no backlash.",
                     {panel{.x_label = "time [s]",
                            .y_label = "x [um]",
                            .lines = {{.name = name, .x = shown.time, .y = shown.x_error}}},
                      panel{.x_label = "time [s]",
                            .y_label = "y [um]",
                            .lines = {{.name = name, .x = shown.time, .y = shown.y_error}}}}}};
    return out;
}

inline experiment vcnc_contour() {
    using quadrant::pid, quadrant::sliding_mode;
    // Reference: shared/reference/virtual_cnc.md, section 4.2.
    return {
        "The Virtual CNC along a diamond and a circle",
        "[Yeung2006] section 4.2, Tables 10 to 12",
        "200 mm/s, 2000 mm/s^2, 50 000 mm/s^3, control every millisecond. Diamond: from its lowest corner, "
        "counterclockwise, each side from rest to rest, no dwell. Circle: from 90 degrees, counterclockwise. "
        "The published contour error of the diamond "
        "fits the distance to the line of the side under way better than the distance to the path.",
        0.10,
        {{"vcnc.diamond.pid",
          [] {
              return contour_case<pid<>, vcnc::diamond>("vcnc.diamond.pid", "PID", vcnc::pid_of,
                                                        {36.9, 40.8, 9.0});
          }},
         {"vcnc.diamond.smc",
          [] {
              return contour_case<sliding_mode<>, vcnc::diamond>("vcnc.diamond.smc", "sliding mode",
                                                                 vcnc::sliding_mode_of, {12.5, 11.9, 8.5});
          }},
         {"vcnc.circle.pid",
          [] { return contour_case<pid<>, vcnc::circle>("vcnc.circle.pid", "PID", vcnc::pid_of, {}); }},
         {"vcnc.circle.smc", [] {
              return contour_case<sliding_mode<>, vcnc::circle>("vcnc.circle.smc", "sliding mode",
                                                                vcnc::sliding_mode_of, {});
          }}}};
}

} // namespace quadrant_reproduce
