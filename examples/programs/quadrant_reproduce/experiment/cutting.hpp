// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../milling_table.hpp"
#include "../row.hpp"

#include <complex>

namespace quadrant_reproduce {

inline const char* const stopped_note = "unstable: stopped by the divergence guard; no figure";

/// The figure of a run, or the reason why there is none.
inline row radial_row(const std::string& id, const std::string& quantity, const thesis::circle_result& found,
                      const std::string& note = "") {
    if (found.diverged) return {id, quantity, "um", {}, {}, {}, {}, stopped_note};
    return {id, quantity, "um", found.rms, {}, {}, {}, note};
}

/// Amplitudes of the radial error up to 400 Hz, under a Hann window over all turns that count, one line for
/// each of theirs.
inline line radial_spectrum(const std::string& name, const std::vector<double>& radial) {
    line out{.name = name, .x = {}, .y = {}};
    const std::size_t n = radial.size();
    const double length = static_cast<double>(n) * thesis::period.value();
    std::vector<double> windowed(n);
    for (std::size_t k = 0; k < n; ++k) {
        const double turn = 2 * thesis::pi_ * static_cast<double>(k) / static_cast<double>(n);
        windowed[k] = radial[k] * (1 - std::cos(turn)) * 2 / static_cast<double>(n);
    }
    for (int i = 1; i <= 400 * length; ++i) {
        const auto step = std::polar(1.0, -2 * thesis::pi_ * i / static_cast<double>(n));
        std::complex<double> turned = 1, sum = 0;
        for (const double each : windowed) {
            sum += each * turned;
            turned *= step;
        }
        out.x.push_back(i / length);
        out.y.push_back(std::abs(sum));
    }
    return out;
}

inline std::vector<picture> radial_pictures(const std::string& name, const thesis::circle_result& found) {
    if (found.diverged) return {};
    line last_turn{.name = name, .x = {}, .y = {}};
    for (std::size_t k = found.radial.size() / 3 * 2; k < found.radial.size(); ++k) {
        last_turn.x.push_back(found.angle[k]);
        last_turn.y.push_back(found.radial[k]);
    }
    return {
        {"Radial error while cutting",
         "Polar plot of one turn in um about the nominal circle of 30 mm, 15 harmonics, force scale 1.38; x "
         "reverses at 0 and 180 degrees, y at 90 and 270.",
         {panel{.x_label = "",
                .y_label = "um",
                .lines = {std::move(last_turn)},
                .polar = true,
                .polar_zero = 60.0}}},
        {"Spectrum of the radial error while cutting",
         "Amplitudes of three turns under a Hann window. The radius turns with the circle, so that a harmonic "
         "i of the "
         "cutter stands at i 23.294 Hz plus and minus the 0.53 Hz of the circle.",
         {panel{.x_label = "frequency [Hz]",
                .y_label = "amplitude [um]",
                .lines = {radial_spectrum(name, found.radial)},
                .log_y = true,
                .y_range = std::pair{1e-4, 20.0}}}}};
}

template <class Configuration>
outcome cutting_case(const std::string& which, const std::string& name, std::optional<double> reference,
                     const std::string& note) {
    const std::string id = "thesis.cutting." + which;
    const auto found = thesis::mill<Configuration>();
    outcome out{{radial_row(id, "radial_rms", found, note)}, radial_pictures(name, found)};
    // Reference: shared/reference/thesis.md, "Repetitive control".
    out.rows[0].reference_computation = reference;
    if constexpr (std::same_as<Configuration, thesis::learning>) {
        out.rows.push_back(radial_row(id, "radial_rms_first_order",
                                      thesis::mill<Configuration>({.weights = thesis::first_order}),
                                      "weights [1]; the reference computation's 0.7 um"));
        out.rows.push_back(radial_row(id, "radial_rms_exact_cycle",
                                      thesis::mill<Configuration>({.cycle = thesis::exact_cycle}),
                                      "weights [2, -1], cycle of 85.859 periods by interpolation"));
        out.rows.push_back(radial_row(
            id, "radial_rms_first_order_exact_cycle",
            thesis::mill<Configuration>({.cycle = thesis::exact_cycle, .weights = thesis::first_order})));
    }
    // The circle of the real cut, with the same synthesized forces: its own (Table 5.6) are not published.
    thesis::cut slow{.radius = 0.025, .feed = 0.005, .turns = 2};
    out.rows.push_back(radial_row(id, "radial_rms_25mm_5mm_s", thesis::mill<Configuration>(slow),
                                  "the circle of the real cut, forces synthesized as before"));
    if constexpr (std::same_as<Configuration, thesis::learning>) {
        slow.weights = thesis::first_order;
        out.rows.push_back(
            radial_row(id, "radial_rms_first_order_25mm_5mm_s", thesis::mill<Configuration>(slow)));
    }
    return out;
}

inline experiment cutting() {
    using namespace thesis;
    return {
        "Cutting along a circle",
        "[Jamaludin2008] Table 5.4",
        "Both axes on GMS friction along a circle of 30 mm at 100 mm/s, pushed by the 15 harmonics of eq. "
        "(3.10) times 1.38. (i) cascade and inverse-model feedforward; (ii) and disturbance observer and "
        "GMS friction feedforward; (iii) and repetitive memory of order 2, weights [2, -1], 85 periods, which "
        "is 1 % short. Rms over three turns after the first, of the axes, not of their encoders. Radius and "
        "feed are our reading: with 25 mm at 5 mm/s, the circle of the real cut, (i) to (iii) do not reproduce "
        "the reference computation. There the memory repeats, a cycle later and twice as large, what friction "
        "does at each reversal; weights [1] leave about half of it. Plant sub-steps of 50 us; with 10 us "
        "(i) and (ii) are the same to 0.1 %, (iii) to 6 %. In (iii) last places count: three orders of summing "
        "the filters of the memory give 0.24 to 0.25 um at the exact cycle, 1.6 to 2.1 um on the slow circle.",
        0.10,
        {{"thesis.cutting.i",
          [] {
              return cutting_case<uncompensated>("i", "(i) none", 11.4,
                                                 "the force scale of the thesis is not printed");
          }},
         {"thesis.cutting.ii",
          [] { return cutting_case<compensated>("ii", "(ii) observer and GMS", 4.4, ""); }},
         {"thesis.cutting.iii", [] {
              return cutting_case<thesis::learning>("iii", "(iii) and repetitive", std::nullopt,
                                                    "the reference computation gives a range, 0.3 to 0.7 um: "
                                                    "that between weights [2, -1] and [1]");
          }}}};
}

} // namespace quadrant_reproduce
