// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../thesis.hpp"

#include <quadrant/analysis/repetitive_design.hpp>

#include <fmt/format.h>

namespace quadrant_reproduce {

/// The memory loop on the x axis: what it gains at the harmonics when the period is 1 % off, what it costs
/// between them.
inline outcome repetitive_case() {
    namespace qa = quadrant::analysis;
    using namespace quadrant::literals;
    const auto axis = thesis::loop_around(thesis::model_of(thesis::x), thesis::x);
    const auto closed = [&](quadrant::frequency f) { return axis.tracking(f); };
    const auto q = qa::smoothing_filter<61>(200_Hz, thesis::period);
    const auto l = qa::learning_filter<90>(closed, q, 30, thesis::period);
    const quadrant::frequency spindle = qa::hertz(23.294);
    const quadrant::duration cycle = quadrant::period_of(spindle);
    const auto indices = [&](const auto& weights) {
        return qa::performance(closed, l, q, weights, {.cycle = cycle, .bandwidth = 100_Hz});
    };
    const std::array<double, 1> first{1};
    const std::array<double, 2> second{2, -1};
    const auto chosen = indices(first), steepest = indices(second);
    outcome out;
    // Reference: shared/reference/thesis.md, "Repetitive control", the closed form
    // 2 sin(0.01 pi) and 6.02 dB.
    out.rows = {{"thesis.repetitive",
                 "gamma_p",
                 "1",
                 chosen.periodic,
                 {},
                 {},
                 0.0628,
                 "weights [1]: the published pair is that of a first-order loop, though the text has order 2"},
                {"thesis.repetitive",
                 "gamma_np",
                 "dB",
                 chosen.non_periodic_db,
                 {},
                 {},
                 6.02,
                 fmt::format("weights [1]; [2, -1] gives {:.2f} dB and a gamma_p of {:.4f}",
                             steepest.non_periodic_db, steepest.periodic)}};

    const auto error_ratio = [&](const auto& weights) {
        return [&, weights](quadrant::frequency f) {
            const complex wq = qa::memory_response(weights, cycle, f) * complex(q(f));
            return (1.0 - wq) / (1.0 - wq * (1.0 - complex(l(f)) * closed(f)));
        };
    };
    picture gain{
        "Error with the memory over error without",
        "Zero at every harmonic of 23.294 Hz; the second order is wide there and costs twice as much between.",
        {panel{.x_label = "frequency [Hz]",
               .y_label = "ratio",
               .lines = {},
               .log_y = true,
               .y_range = std::pair{1e-3, 10.0}}}};
    std::vector<double> at;
    for (double f = 1; f <= 260; f += 0.2) at.push_back(f);
    const auto draw = [&](const char* name, const auto& ratio) {
        line curve{.name = name, .x = at, .y = {}};
        for (const double f : at) curve.y.push_back(std::abs(ratio(qa::hertz(f))));
        gain.panels[0].lines.push_back(std::move(curve));
    };
    draw("weights [1]", error_ratio(first));
    draw("weights [2, -1]", error_ratio(second));

    // Fig. 5.21: the loop around which the memory lies, 1/S - 1, with and without it.
    picture loop_with{
        "The loop with the memory",
        "x axis, weights [1]: gain of the open loop, sensitivity and complementary sensitivity, without and "
        "with "
        "the memory.",
        {panel{.x_label = "", .y_label = "loop gain [dB]", .lines = {}, .log_x = true},
         panel{
             .x_label = "", .y_label = "S [dB]", .lines = {}, .log_x = true, .y_range = std::pair{-70.0, 15.0}},
         panel{.x_label = "frequency [Hz]",
               .y_label = "T [dB]",
               .lines = {},
               .log_x = true,
               .y_range = std::pair{-70.0, 15.0}}}};
    for (const bool with : {false, true}) {
        std::array<line, 3> curves;
        for (line& c : curves) c.name = with ? "with the memory" : "cascade";
        const auto ratio = error_ratio(first);
        for (const double f : at) {
            const complex s = (1.0 - closed(qa::hertz(f))) * (with ? ratio(qa::hertz(f)) : complex(1));
            const std::array values{std::abs(1.0 / s - 1.0), std::abs(s), std::abs(1.0 - s)};
            for (std::size_t i = 0; i < 3; ++i)
                curves[i].x.push_back(f), curves[i].y.push_back(qa::decibel(std::max(values[i], 1e-6)));
        }
        for (std::size_t i = 0; i < 3; ++i) loop_with.panels[i].lines.push_back(std::move(curves[i]));
    }

    line one{.name = "first harmonic", .x = {}, .y = {}}, eight{.name = "eight harmonics", .x = {}, .y = {}};
    for (double db = 6.03; db <= 12.04; db += 0.25) {
        const auto weights = qa::repetitive_weights<2>(db);
        const auto p = indices(weights);
        const auto p8 =
            qa::performance(closed, l, q, weights, {.cycle = cycle, .harmonics = 8, .bandwidth = 100_Hz});
        one.x.push_back(p.non_periodic_db), one.y.push_back(p.periodic);
        eight.x.push_back(p8.non_periodic_db), eight.y.push_back(p8.periodic);
    }
    out.pictures = {
        gain,
        loop_with,
        {"The trade-off of a second-order memory",
         "gamma_p (what is left at the harmonics when the period is 1 % off) over gamma_np (what is amplified "
         "between "
         "them); the left end is the first-order loop.",
         {panel{.x_label = "gamma_np [dB]", .y_label = "gamma_p", .lines = {one, eight}, .log_y = true}}}};
    return out;
}

inline experiment repetitive() {
    return {"Repetitive control",
            "[Jamaludin2008] section 5.4.1, Figs. 5.17 to 5.21",
            "L is the inverse of the closed loop by least squares (90 taps, 30 ahead), Q a zero-phase low-pass "
            "of 200 Hz with 61 taps, "
            "the period that of 23.294 Hz, 1 % uncertain.",
            0.02,
            {{"thesis.repetitive", repetitive_case}}};
}

} // namespace quadrant_reproduce
