// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../thesis.hpp"

#include <quadrant/analysis/repetitive_design.hpp>

#include <fmt/format.h>

namespace quadrant_reproduce {

/// The memory loop of the x axis: the loop around which it lies, its filters and its cycle.
template <class Loop, class Smoothing, class Learning> struct memory_loop {
    static constexpr std::array<double, 1> first{1};
    static constexpr std::array<double, 2> second{2, -1};
    Loop axis;
    Smoothing q;
    Learning l;
    quadrant::duration cycle;

    complex closed(quadrant::frequency f) const { return axis.tracking(f); }
    auto indices(const auto& weights, std::size_t harmonics = 1) const {
        return quadrant::analysis::performance(
            [this](quadrant::frequency f) { return closed(f); }, l, q, weights,
            {.cycle = cycle, .harmonics = harmonics, .bandwidth = quadrant::analysis::hertz(100)});
    }
    /// Error with the memory over error without.
    complex error_ratio(const auto& weights, quadrant::frequency f) const {
        const complex wq = quadrant::analysis::memory_response(weights, cycle, f) * complex(q(f));
        return (1.0 - wq) / (1.0 - wq * (1.0 - complex(l(f)) * closed(f)));
    }
};
inline auto memory_of_x() {
    namespace qa = quadrant::analysis;
    using namespace quadrant::literals;
    const auto axis = thesis::loop_around(thesis::model_of(thesis::x), thesis::x);
    const auto q = qa::smoothing_filter<61>(200_Hz, thesis::period);
    const auto l =
        qa::learning_filter<90>([&](quadrant::frequency f) { return axis.tracking(f); }, q, 30, thesis::period);
    return memory_loop<decltype(axis), decltype(q), decltype(l)>{axis, q, l,
                                                                 quadrant::period_of(qa::hertz(23.294))};
}
inline std::vector<double> drawn_frequencies() {
    std::vector<double> at;
    for (double f = 1; f <= 260; f += 0.2) at.push_back(f);
    return at;
}
inline picture error_with_memory(const auto& m) {
    namespace qa = quadrant::analysis;
    picture gain{
        "Error with the memory over error without",
        "Zero at every harmonic of 23.294 Hz; the second order is wide there and costs twice as much between.",
        {panel{.x_label = "frequency [Hz]",
               .y_label = "ratio",
               .lines = {},
               .log_y = true,
               .y_range = std::pair{1e-3, 10.0}}}};
    const std::vector<double> at = drawn_frequencies();
    const auto draw = [&](const char* name, const auto& weights) {
        line curve{.name = name, .x = at, .y = {}};
        for (const double f : at) curve.y.push_back(std::abs(m.error_ratio(weights, qa::hertz(f))));
        gain.panels[0].lines.push_back(std::move(curve));
    };
    draw("weights [1]", m.first);
    draw("weights [2, -1]", m.second);
    return gain;
}
/// Fig. 5.21: the loop around which the memory lies, 1/S - 1, with and without it.
inline picture loop_with_memory(const auto& m) {
    namespace qa = quadrant::analysis;
    picture loop_with{
        "The loop with the memory",
        "x axis, weights [1]: gain of the open loop, sensitivity and complementary sensitivity, without and "
        "with the memory.",
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
        for (const double f : drawn_frequencies()) {
            const complex s =
                (1.0 - m.closed(qa::hertz(f))) * (with ? m.error_ratio(m.first, qa::hertz(f)) : complex(1));
            const std::array values{std::abs(1.0 / s - 1.0), std::abs(s), std::abs(1.0 - s)};
            for (std::size_t i = 0; i < 3; ++i)
                curves[i].x.push_back(f), curves[i].y.push_back(qa::decibel(std::max(values[i], 1e-6)));
        }
        for (std::size_t i = 0; i < 3; ++i) loop_with.panels[i].lines.push_back(std::move(curves[i]));
    }
    return loop_with;
}
inline picture trade_off(const auto& m) {
    namespace qa = quadrant::analysis;
    line one{.name = "first harmonic", .x = {}, .y = {}}, eight{.name = "eight harmonics", .x = {}, .y = {}};
    for (double db = 6.03; db <= 12.04; db += 0.25) {
        const auto weights = qa::repetitive_weights<2>(db);
        const auto p = m.indices(weights);
        const auto p8 = m.indices(weights, 8);
        one.x.push_back(p.non_periodic_db), one.y.push_back(p.periodic);
        eight.x.push_back(p8.non_periodic_db), eight.y.push_back(p8.periodic);
    }
    return {"The trade-off of a second-order memory",
            "gamma_p (what is left at the harmonics when the period is 1 % off) over gamma_np (what is amplified "
            "between them); the left end is the first-order loop.",
            {panel{.x_label = "gamma_np [dB]", .y_label = "gamma_p", .lines = {one, eight}, .log_y = true}}};
}

/// What the memory gains at the harmonics when the period is 1 % off, what it costs between them.
inline outcome repetitive_case() {
    const auto m = memory_of_x();
    const auto chosen = m.indices(m.first), steepest = m.indices(m.second);
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
    out.pictures = {error_with_memory(m), loop_with_memory(m), trade_off(m)};
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
