// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "../virtual_cnc.hpp"

#include <quadrant/analysis/contour_run.hpp>
#include <quadrant/path/cl_reader.hpp>
#include <quadrant/trajectory/interpolator.hpp>

#include <array>
#include <cmath>
#include <sstream>

namespace quadrant_reproduce {

/// The CL files of the source's contours, as examples/path has them.
inline const char* const diamond_program = "PARTNO DIAMOND\nUNITS/MM\nFROM/0,0,0\nFEDRAT/12000,MMPM\n"
                                           "GOTO/35.355339,-35.355339,0\nGOTO/0.000000,-70.710678,0\n"
                                           "GOTO/-35.355339,-35.355339,0\nGOTO/0.000000,0.000000,0\nFINI\n";
inline const char* const circle_program = "PARTNO CIRCLE\nUNITS/MM\nFROM/0,0,0\nFEDRAT/12000,MMPM\n"
                                          "CIRCLE/0,-50,0,0,0,1,50\nGOTO/0,0,0\nFINI\n";

inline std::vector<quadrant::path::move> moves_of(const char* program, const char* name) {
    std::istringstream text(program);
    quadrant::path::cl_reader reader(text, name);
    std::vector<quadrant::path::move> all;
    while (const auto m = reader.next()) all.push_back(*m);
    return all;
}

/// The limits of [Yeung2006] section 4.2 on both axes and along the path.
inline quadrant::analysis::contour_options program_limits() {
    using namespace quadrant::literals;
    quadrant::analysis::contour_options how;
    how.limits.path = {0.2_mps, 2_mps2, 50.0 * 1_mps2 / 1_s};
    return how;
}

/// Published largest errors of one contour [um].
struct contour_printed {
    double x, y, contour;
};

/// Table against path, with the errors magnified, and the errors over time with what the source prints.
inline picture contour_picture(const std::string& title, const quadrant::analysis::contour_figures& f,
                               const std::vector<quadrant::analysis::plane_position>& table, double magnified,
                               const contour_printed& printed) {
    line path{.name = "path", .x = {}, .y = {}, .drawn = line::style::dashed},
        shown{.name = "table", .x = {}, .y = {}};
    line x{.name = "ours", .x = {}, .y = {}}, y = x, contour = x;
    for (std::size_t k = 0; k < table.size(); ++k) {
        const double t = double(k) * vcnc::period.value(), ex = f.x_error[k].value(), ey = f.y_error[k].value();
        path.x.push_back(1e3 * (table[k].x.value() + ex)), path.y.push_back(1e3 * (table[k].y.value() + ey));
        shown.x.push_back(path.x.back() - 1e3 * magnified * ex),
            shown.y.push_back(path.y.back() - 1e3 * magnified * ey);
        for (line* l : {&x, &y, &contour}) l->x.push_back(t);
        x.y.push_back(1e6 * ex), y.y.push_back(1e6 * ey),
            contour.y.push_back(1e6 * std::abs(f.contour_error[k].value()));
    }
    const double end = double(table.size()) * vcnc::period.value();
    const auto level = [&](double at) {
        return line{.name = "published largest", .x = {0, end}, .y = {at, at}, .drawn = line::style::dashed};
    };
    return {title,
            "Top: path, and table with its errors magnified 300 times. Below: tracking errors of both axes and "
            "the distance "
            "from the path; dashed the largest that the source simulated.",
            {panel{.x_label = "x [mm]",
                   .y_label = "y [mm]",
                   .lines = {std::move(path), std::move(shown)},
                   .square = true},
             panel{.x_label = "", .y_label = "x [um]", .lines = {std::move(x), level(printed.x)}},
             panel{.x_label = "", .y_label = "y [um]", .lines = {std::move(y), level(printed.y)}},
             panel{.x_label = "time [s]",
                   .y_label = "contour [um]",
                   .lines = {std::move(contour), level(printed.contour)}}}};
}

/// A CL file through our reader, look-ahead and interpolator to both axes; mean of 5 seeds.
template <class Law>
outcome program_case(const std::string& id, const std::string& title, const char* program,
                     typename Law::parameters (*law_of)(const vcnc::axis&), const contour_printed& printed) {
    using namespace quadrant;
    using namespace quadrant::literals;
    constexpr int seeds = 5;
    const auto moves = moves_of(program, id.c_str());
    contour_printed mean{};
    double duration = 0;
    outcome out;
    for (int seed = 1; seed <= seeds; ++seed) {
        vcnc::servo<Law> x(vcnc::x_axis, law_of(vcnc::x_axis), 0_m, std::uint64_t(2 * seed)),
            y(vcnc::y_axis, law_of(vcnc::y_axis), 0_m, std::uint64_t(2 * seed + 1));
        std::vector<analysis::plane_position> table;
        const auto found = analysis::drive_contour(
            moves,
            [&](const axis_motion<>& to_x, const axis_motion<>& to_y) {
                if (table.empty()) x.settle(to_x.position), y.settle(to_y.position);
                table.push_back({x.place() * 1_m, y.place() * 1_m});
                x.step(to_x), y.step(to_y);
                return table.back();
            },
            program_limits(), vcnc::period);
        mean.x += 1e6 * found.x.most.value() / seeds, mean.y += 1e6 * found.y.most.value() / seeds;
        mean.contour += 1e6 * found.contour.most.value() / seeds;
        duration = found.duration.value();
        if (seed == 1) out.pictures = {contour_picture(title, found, table, 300, printed)};
    }
    out.rows = {{id, "x_error_max", "um", mean.x, printed.x, {}, {}, "mean of 5 seeds, no backlash"},
                {id, "y_error_max", "um", mean.y, printed.y, {}, {}, ""},
                {id, "contour_error_max", "um", mean.contour, printed.contour, {}, {}, "distance to the path"},
                {id, "duration", "s", duration, {}, {}, {}, "of the motion"}};
    return out;
}

/// Fig. 9: feed along 20 mm with each kind of profile.
inline outcome profiles_case(const std::string& id) {
    using namespace quadrant;
    using namespace quadrant::literals;
    outcome out;
    picture drawn{"Feed along 20 mm with three profiles",
                  "200 mm/s, 2000 mm/s^2; the jerk of 50 000 mm/s^3 binds the two with ramps of acceleration. "
                  "Constant acceleration leaves the scale of the jerk: 2000 m/s^3 for one sample.",
                  {panel{.x_label = "", .y_label = "way [mm]", .lines = {}},
                   panel{.x_label = "", .y_label = "feed [mm/s]", .lines = {}},
                   panel{.x_label = "", .y_label = "acceleration [mm/s2]", .lines = {}},
                   panel{.x_label = "time [s]",
                         .y_label = "jerk [m/s3]",
                         .lines = {},
                         .y_range = std::pair{-150.0, 150.0}}}};
    struct kind {
        const char *name, *quantity;
        trajectory::profile_kind is;
    };
    for (const kind& k :
         {kind{"constant acceleration", "duration_constant", trajectory::profile_kind::constant_acceleration},
          kind{"trapezoidal", "duration_trapezoidal", trajectory::profile_kind::trapezoidal_acceleration},
          kind{"cubic", "duration_cubic", trajectory::profile_kind::cubic_acceleration}}) {
        auto limits = program_limits().limits;
        if (k.is == trajectory::profile_kind::constant_acceleration)
            limits.path.jerk = trajectory::motion_limits{}.jerk;
        const auto drive = std::make_unique<trajectory::interpolator<>>(
            trajectory::interpolator<>::parameters{limits, k.is}, vcnc::period);
        drive->push({.path = quadrant::path::line({0, 0, 0}, {0.02, 0, 0}), .feed = 0.2, .line = 1});
        std::array<line, 4> shown; // way, feed, acceleration, jerk
        shown.fill({.name = k.name, .x = {}, .y = {}});
        double t = 0, before = 0;
        while (!drive->done() && t < 1) {
            const auto& m = (*drive)();
            t += vcnc::period.value();
            const double a = m.axis[0].acceleration.value();
            const std::array values{1e3 * m.axis[0].position.value(), 1e3 * m.axis[0].velocity.value(), 1e3 * a,
                                    (a - before) / vcnc::period.value()};
            before = a;
            for (std::size_t i = 0; i < shown.size(); ++i)
                shown[i].x.push_back(t), shown[i].y.push_back(values[i]);
        }
        out.rows.push_back({id, k.quantity, "s", t, {}, {}, {}, "20 mm from rest to rest"});
        for (std::size_t i = 0; i < shown.size(); ++i) drawn.panels[i].lines.push_back(std::move(shown[i]));
    }
    out.pictures = {std::move(drawn)};
    return out;
}

inline experiment vcnc_program() {
    using quadrant::pid, quadrant::sliding_mode;
    const std::string id = "vcnc.program.";
    return {"CL files through reader, look-ahead and interpolator",
            "[Yeung2006] sections 2.2 and 4.2, Figs. 8, 9 and 14 to 17, Tables 11 and 12",
            "The diamond and the circle as CL files, read, looked ahead and interpolated every millisecond by "
            "our own blocks, with "
            "the limits of section 4.2 along the path and the trapezoidal profile; the diamond here starts at "
            "its top.",
            0.10,
            {{id + "profiles", [=] { return profiles_case(id + "profiles"); }},
             {id + "diamond.pid",
              [=] {
                  return program_case<pid<>>(id + "diamond.pid", "Diamond, PID (Fig. 14)", diamond_program,
                                             vcnc::pid_of, {37.5, 41.2, 12.6});
              }},
             {id + "diamond.smc",
              [=] {
                  return program_case<sliding_mode<>>(id + "diamond.smc", "Diamond, sliding mode (Fig. 15)",
                                                      diamond_program, vcnc::sliding_mode_of, {12.2, 7.4, 8.4});
              }},
             {id + "circle.pid",
              [=] {
                  return program_case<pid<>>(id + "circle.pid", "Circle, PID (Fig. 16)", circle_program,
                                             vcnc::pid_of, {47.1, 22.3, 21.5});
              }},
             {id + "circle.smc", [=] {
                  return program_case<sliding_mode<>>(id + "circle.smc", "Circle, sliding mode (Fig. 17)",
                                                      circle_program, vcnc::sliding_mode_of, {11.7, 7.7, 11.7});
              }}}};
}

} // namespace quadrant_reproduce
