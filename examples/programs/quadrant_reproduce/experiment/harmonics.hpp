// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "harmonics_cases.hpp"

namespace quadrant_reproduce {

/// Rows of Tables 5.1 to 5.3, and the errors as a picture, one panel for each number of harmonics.
template <class Slot>
outcome harmonics_case(const std::string& id, const std::string& title, const std::vector<int>& harmonics,
                       bool tracking, const std::string& note) {
    outcome out;
    picture errors{title, "The last fifth of a second, without and with.", {}};
    double less = 0; // in all, of the rms
    bool diverged = false;
    for (const int h : harmonics) {
        const thesis::push p{.harmonics = h, .tracking = tracking};
        const auto off = thesis::pushed<thesis::nothing_observed>(p);
        const auto on = thesis::pushed<Slot>(p);
        const std::string n = std::to_string(h);
        out.rows.push_back({id, "rms_off_" + n, "um", rms_of(off), {}, {}, {}, note});
        out.rows.push_back(
            {id, "rms_on_" + n, "um", rms_of(on), {}, {}, {}, on.diverged ? thesis::diverged_note : ""});
        less += 1 - on.rms / off.rms, diverged = diverged || on.diverged || off.diverged;
        if (h == 15 && !tracking) {
            out.rows.push_back(
                {id, "first_harmonic_off", "um", off.first, {}, {}, {}, "amplitude of the error at 23.3 Hz"});
            out.rows.push_back(
                {id, "first_harmonic_on", "um", on.first, {}, {}, {}, "amplitude of the error at 23.3 Hz"});
        }
        errors.panels.push_back(
            panel{.x_label = h == harmonics.back() ? "time [s]" : "",
                  .y_label = n + (h == 1 ? " harmonic [um]" : " harmonics [um]"),
                  .lines = {last_of("without", off, off.error, 0.2), last_of("with", on, on.error, 0.2)}});
    }
    out.rows.push_back({id,
                        "mean_reduction",
                        "%",
                        diverged ? std::nullopt : std::optional(100 * less / double(harmonics.size())),
                        {},
                        {},
                        {},
                        diverged ? thesis::diverged_note : "of the rms, mean over the numbers of harmonics"});
    out.pictures = {std::move(errors)};
    return out;
}

inline experiment harmonics() {
    using namespace thesis;
    const std::string scale =
        "the thesis does not print the scale of its forces: rms goes with it, the reduction does not";
    const std::string id = "thesis.harmonics.";
    return {
        "Observers against the cutter's harmonics",
        "[Jamaludin2008] sections 5.2 and 5.3, section 5.4.2, Appendix C, Tables 5.1 to 5.3, Figs. 5.4 to "
        "5.16, 5.23 and 5.24",
        "The y axis pushed by the first 1, 2, 3 and 15 harmonics of Table 3.6 times 1.38: at rest on the "
        "linear plant, where "
        "pre-sliding friction would hold the table, and along the sinusoid of 30 mm at 100 mm/s on GMS "
        "friction. "
        "Against it the inverse model (Table 5.1), the Ferraris estimator of eq. (5.6) (Tables 5.2 and 5.3) "
        "and the "
        "reduced-order observer of Appendix C, each behind the Q of 90 Hz. On a plant without friction "
        "Appendix C and "
        "eq. (5.6) are the same estimator, as the thesis says. Its measured errors without observer grow by "
        "half from one "
        "harmonic to three, ours by a sixth: other amplitudes or a resonance near 70 Hz.",
        0.10,
        {{id + "observer",
          [=] {
              return harmonics_case<by_inverse_model>(id + "observer",
                                                      "The inverse-model observer against 1 to 15 harmonics",
                                                      {1, 2, 3, 15}, false, scale);
          }},
         {id + "circle", [=] { return harmonics_circle(id + "circle"); }},
         {id + "ferraris",
          [=] {
              auto out = harmonics_case<by_ferraris>(id + "ferraris",
                                                     "The Ferraris estimator against 1 to 15 harmonics",
                                                     {1, 2, 3, 15}, false, scale);
              auto more = ferraris_estimate(id + "ferraris");
              out.rows.push_back(more.rows.front());
              out.pictures.push_back(more.pictures.front());
              return out;
          }},
         {id + "ferraris_tracking",
          [=] {
              return harmonics_case<by_ferraris>(
                  id + "ferraris_tracking", "The Ferraris estimator while tracking", {1, 3, 15}, true, scale);
          }},
         {id + "memory.x", [=] { return harmonics_memory(id + "memory.x", x); }},
         {id + "memory.y", [=] { return harmonics_memory(id + "memory.y", y); }},
         {id + "reduced_order", [=] {
              return harmonics_case<by_reduced_order>(
                  id + "reduced_order", "The reduced-order observer while tracking", {1, 3, 15}, true, scale);
          }}}};
}

} // namespace quadrant_reproduce
