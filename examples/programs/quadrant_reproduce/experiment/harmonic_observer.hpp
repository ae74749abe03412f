// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../milling_table.hpp"
#include "../push_run.hpp"
#include "force_observer_loop.hpp"
#include "harmonics.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// Fig. D.4: the error under 1 V with no observer, with one harmonic and with two.
inline picture error_with_harmonics(const force_observer_loop& one, const force_observer_loop& two) {
    using quadrant::analysis::hertz;
    const band b{hertz(1), hertz(400), 200};
    const auto curve = [&](const char* name, const force_observer_loop& l) {
        return over_frequency(name, b, [&](quadrant::frequency f) { return l.error(f); });
    };
    const auto bare = thesis::loop_around(thesis::model_of(thesis::y), thesis::y);
    return {
        "Error under 1 V with the harmonic observer",
        "By eq. (D.14), y axis: zero at the harmonics it knows, more beside them, the more harmonics the "
        "more.",
        {panel{.x_label = "frequency [Hz]",
               .y_label = "error amplitude [um]",
               .lines = {over_frequency("no observer", b,
                                        [&](quadrant::frequency f) {
                                            return 1e6 * std::abs(complex(thesis::model_of(thesis::y)(f)) *
                                                                  bare.sensitivity(f));
                                        }),
                         curve("46 Hz", one),
                         curve("46 and 69 Hz", two),
                         {.name = "published, Fig. D.4", .x = {23}, .y = {783}, .drawn = line::style::points}},
               .log_x = true,
               .log_y = true,
               .y_range = std::pair{0.1, 3000.0}}}};
}

/// Figs. D.3 to D.5 by the transfer functions, and D.4 by simulation.
inline outcome harmonic_sensitivity(const std::string& id) {
    using quadrant::analysis::hertz;
    constexpr double decay = 200;
    const force_observer_loop one(thesis::y, {46}, decay), two(thesis::y, {46, 69}, decay);
    outcome out;
    thesis::by_harmonics<2>::parameters slot;
    slot.at = {hertz(46), hertz(69)};
    const thesis::push p{.sines = {{23, thesis::y.kf.value()}}};
    const auto run = thesis::pushed<thesis::by_harmonics<2>>(p, slot);
    const char* poles = "1 V at 23 Hz; depends on the observer's poles, which the thesis does not print: ours "
                        "decay with 200 1/s";
    out.rows.push_back({id,
                        "error_23Hz",
                        "um",
                        run.diverged ? std::nullopt : std::optional(std::sqrt(2.0) * run.rms),
                        {},
                        {},
                        {},
                        poles});
    out.rows.push_back({id, "error_23Hz_response", "um", two.error(hertz(23)), {}, {}, {}, poles});
    // At a harmonic itself eq. (D.15) is exactly 0, which has no decibels: the frequency is off by its last
    // digit.
    const auto zero = [&](const char* what, const force_observer_loop& l, double at) {
        const double beside = std::nextafter(at, 2 * at);
        out.rows.push_back(
            {id,
             what,
             "dB",
             quadrant::analysis::decibel(std::abs(l.sensitivity(hertz(beside)))),
             {},
             {},
             {},
             "an exact zero: digits of rounding, the published ones too; ours one last digit of the "
             "frequency beside it"});
    };
    zero("zero_one_46Hz", one, 46);
    zero("zero_two_46Hz", two, 46);
    zero("zero_two_69Hz", two, 69);
    out.pictures = {error_with_harmonics(one, two)};
    return out;
}

/// The error from the moment when the observer comes on: half a run without it, half with it.
template <std::size_t Count>
line switched_on(const thesis::push& p, const typename thesis::by_harmonics<Count>::parameters& slot = {}) {
    const auto off = thesis::pushed<thesis::nothing_observed>(p),
               on = thesis::pushed<thesis::by_harmonics<Count>>(p, slot);
    line out{.name = fmt::format("{} harmonic{}", Count, Count > 1 ? "s" : ""), .x = {}, .y = {}};
    const std::size_t half = off.error.size() / 2, shown = std::min<std::size_t>(half, 800);
    for (std::size_t k = 0; k < shown; ++k)
        out.x.push_back(double(k) * thesis::period.value() - double(shown) * thesis::period.value()),
            out.y.push_back(off.error[half + k]);
    for (std::size_t k = 0; k < shown; ++k)
        out.x.push_back(double(k) * thesis::period.value()), out.y.push_back(on.error[k]);
    return out;
}

/// Of the error at a frequency, over the second half of a run.
inline double amplitude(const thesis::push_result& r, double f) {
    std::complex<double> sum = 0;
    const std::size_t from = r.error.size() / 2;
    for (std::size_t k = from; k < r.error.size(); ++k)
        sum += r.error[k] * std::polar(2.0 / double(r.error.size() - from), -2 * thesis::pi_ * f * r.time[k]);
    return std::abs(sum);
}
/// Rms errors while tracking, without and with an observer of one and of three harmonics.
inline std::vector<row> tracking_rows(const std::string& id) {
    std::vector<row> rows;
    for (const int h : {1, 3}) {
        const thesis::push p{.harmonics = h, .tracking = true};
        const auto off = thesis::pushed<thesis::nothing_observed>(p);
        const auto on =
            h == 1 ? thesis::pushed<thesis::by_harmonics<1>>(p) : thesis::pushed<thesis::by_harmonics<3>>(p);
        const std::string n = std::to_string(h);
        rows.push_back({id,
                        "rms_off_" + n,
                        "um",
                        rms_of(off),
                        {},
                        {},
                        {},
                        "tracking 30 mm at 100 mm/s, friction by GMS feedforward; force scale 1.38"});
        rows.push_back({id,
                        "rms_on_" + n,
                        "um",
                        rms_of(on),
                        {},
                        {},
                        {},
                        "the thesis has the inverse-model observer beside it"});
    }
    return rows;
}

/// Figs. D.6 and D.7 (a frequency that the observer does not know), D.9 (at rest), D.10 and D.11 (tracking),
/// D.13 (switching on).
inline outcome harmonic_runs(const std::string& id) {
    using quadrant::analysis::hertz;
    outcome out;
    out.rows = tracking_rows(id);
    thesis::by_harmonics<2>::parameters wrong;
    wrong.at = {hertz(23.3), hertz(46.6)};
    const thesis::push mismatch{.sines = {{23.3, 65}, {40, 65}}};
    const auto off = thesis::pushed<thesis::nothing_observed>(mismatch),
               on = thesis::pushed<thesis::by_harmonics<2>>(mismatch, wrong);
    for (const double f : {23.3, 40.0}) {
        const std::string n = fmt::format("{:.0f}", std::floor(f));
        out.rows.push_back({id,
                            "mismatch_" + n + "Hz_off",
                            "um",
                            amplitude(off, f),
                            {},
                            {},
                            {},
                            "amplitude of the error, force of 65 N at 23.3 and 40 Hz"});
        out.rows.push_back({id,
                            "mismatch_" + n + "Hz_on",
                            "um",
                            amplitude(on, f),
                            {},
                            {},
                            {},
                            f < 30 ? "the observer knows it" : "the observer has 46.6 Hz instead"});
    }
    const thesis::push rest1{.harmonics = 1}, rest2{.harmonics = 2}, rest3{.harmonics = 3};
    out.pictures = {
        {"The harmonic observer comes on",
         "At rest, force scale 1.38; the observer starts at 0 s from nothing.",
         {panel{.x_label = "time [s]",
                .y_label = "error [um]",
                .lines = {switched_on<1>(rest1), switched_on<2>(rest2), switched_on<3>(rest3)}}}},
        {"A harmonic that the observer does not know",
         "Force at 23.3 and 40 Hz, observer for 23.3 and 46.6 Hz: the last fifth of a second.",
         {panel{.x_label = "time [s]",
                .y_label = "error [um]",
                .lines = {last_of("without", off, off.error, 0.2), last_of("with", on, on.error, 0.2)}}}}};
    return out;
}

/// Fig. D.12: the circle under the first harmonic alone, without and with the observer that knows it.
struct one_harmonic {
    using box = thesis::by_harmonics<1>;
    static box::parameters of(const thesis::axis& a) {
        box::parameters p;
        p.of = a;
        return p;
    }
};
inline outcome harmonic_circle(const std::string& id) {
    using thesis::configuration, thesis::gms_model, thesis::gms_plant, thesis::no_memory;
    const thesis::cut c;
    outcome out;
    panel drawn{.x_label = "", .y_label = "um", .lines = {}, .polar = true, .polar_zero = 30.0};
    const auto add = [&]<class Configuration>(const char* quantity, const char* name, Configuration*) {
        const auto found = thesis::mill<Configuration, gms_plant>(c, thesis::synthesized(c, 1));
        out.rows.push_back(
            {id,
             quantity,
             "um",
             found.diverged ? std::nullopt : std::optional(found.rms),
             {},
             {},
             {},
             "radial error on the circle of 30 mm at 100 mm/s, first harmonic; GMS fed forward"});
        line turn{.name = name, .x = {}, .y = {}};
        for (std::size_t k = found.radial.size() / 3 * 2; k < found.radial.size(); ++k)
            turn.x.push_back(found.angle[k]), turn.y.push_back(found.radial[k]);
        drawn.lines.push_back(std::move(turn));
    };
    add("circle_rms_off_1", "without",
        static_cast<configuration<gms_model, thesis::no_observer, no_memory>*>(nullptr));
    add("circle_rms_on_1", "with", static_cast<configuration<gms_model, one_harmonic, no_memory>*>(nullptr));
    out.pictures = {{"Radial error with one harmonic",
                     "Polar plot of one turn in um about the nominal circle of 30 mm; force scale 1.38.",
                     {std::move(drawn)}}};
    return out;
}

inline experiment harmonic_observer() {
    const std::string id = "thesis.harmonic_observer";
    return {"The harmonic force observer",
            "[Jamaludin2008] Appendix D, Figs. D.3 to D.13",
            "The observer that carries the cutter's harmonics as states, in the slot of the loop and by the "
            "transfer functions "
            "of the appendix. Poles: those of the harmonics shifted left by 200 1/s; where the thesis put them "
            "is not printed, "
            "and what lies between the harmonics depends on them. Forces as in Table 3.6 times 1.38.",
            0.10,
            {{id, [=] {
                  auto out = harmonic_sensitivity(id);
                  for (auto& more : {harmonic_runs(id), harmonic_circle(id)}) {
                      out.rows.insert(out.rows.end(), more.rows.begin(), more.rows.end());
                      out.pictures.insert(out.pictures.end(), more.pictures.begin(), more.pictures.end());
                  }
                  return out;
              }}}};
}

} // namespace quadrant_reproduce
