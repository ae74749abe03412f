// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cutting.hpp"

#include <algorithm>
#include <array>

namespace quadrant_reproduce {

/// Smallest and largest figure over what a source does not print, and what it prints.
struct figure_band {
    std::string name;
    double low, high;
    std::optional<double> printed;
};
inline picture band_picture(const std::string& title, const std::string& caption,
                            const std::vector<figure_band>& all, const std::string& label) {
    std::string order;
    panel drawn{.x_label = "", .y_label = label, .lines = {}, .log_y = true};
    line printed{.name = "printed", .x = {}, .y = {}, .drawn = line::style::points};
    line ours{.name = "ours, from lowest to highest", .x = {}, .y = {}};
    line ends{.name = "ours, lowest and highest", .x = {}, .y = {}, .drawn = line::style::points};
    for (std::size_t k = 0; k < all.size(); ++k) {
        const double at = static_cast<double>(k + 1);
        for (const double y : {all[k].low, all[k].high}) ours.x.push_back(at), ours.y.push_back(y);
        for (const double y : {all[k].low, all[k].high}) ends.x.push_back(at), ends.y.push_back(y);
        ours.x.push_back(at), ours.y.push_back(std::numeric_limits<double>::quiet_NaN());
        if (all[k].printed) printed.x.push_back(at), printed.y.push_back(*all[k].printed);
        order += (order.empty() ? "" : ", ") + std::to_string(k + 1) + " " + all[k].name;
    }
    drawn.x_range = std::pair{0.5, static_cast<double>(all.size()) + 0.5};
    drawn.lines = {std::move(ours), std::move(ends), std::move(printed)};
    drawn.x_label = "case";
    return {title, caption + " Cases: " + order + ".", {std::move(drawn)}};
}
inline void band_rows(outcome& out, const std::string& id, const std::string& quantity, const figure_band& b) {
    const auto note = [&]() -> std::string {
        if (!b.printed) return "";
        return *b.printed < b.low    ? "the printed figure lies below the band"
               : *b.printed > b.high ? "the printed figure lies above the band"
                                     : "the printed figure lies in the band";
    };
    out.rows.push_back({id, quantity + "_low", "um", b.low, {}, {}, {}, note()});
    out.rows.push_back({id, quantity + "_high", "um", b.high, {}, {}, {}, ""});
}

/// Glitches at 100 mm/s over the C that nobody prints, in plant and model alike.
template <class Compensation>
figure_band glitch_band(const thesis::axis& a, const std::string& name, std::optional<double> printed) {
    figure_band out{name, HUGE_VAL, 0, printed};
    for (const double C : {1e-3, 1.0, 1e2, 1e3, 1e4}) { // N/s
        thesis::axis other = a;
        other.C = C / a.C.value() * a.C;
        const auto found = thesis::run<Compensation>(other, {.substeps = 20});
        if (found.diverged) continue;
        out.low = std::min(out.low, found.glitch), out.high = std::max(out.high, found.glitch);
    }
    return out;
}
inline outcome attraction_bands(const std::string& id) {
    using namespace thesis;
    // Printed: Table 4.2; its x column is the measured one and is left out.
    const std::array all{
        glitch_band<no_friction_model>(x, "x none", {}), glitch_band<static_curve>(x, "x static", {}),
        glitch_band<gms_model>(x, "x GMS", {}),          glitch_band<no_friction_model>(y, "y none", 31),
        glitch_band<static_curve>(y, "y static", 8.3),   glitch_band<gms_model>(y, "y GMS", 1.2)};
    outcome out;
    const std::array names{"x_none", "x_static", "x_gms", "y_none", "y_static", "y_gms"};
    for (std::size_t k = 0; k < all.size(); ++k) band_rows(out, id, names[k], all[k]);
    out.pictures = {
        band_picture("Glitches over the unknown C",
                     "Largest tracking error behind a reversal at 100 mm/s; C from 0.001 to 10 000 N/s.",
                     {all.begin(), all.end()}, "glitch [um]")};
    return out;
}

/// Radial errors over the scale of the forces: 2/8000 N, which makes the 100 N of the plot, to 1.38 times
/// 2/6053 N, which the figures of the reference use.
template <class Configuration> figure_band force_band(const std::string& name, double printed) {
    figure_band out{name, HUGE_VAL, 0, printed};
    for (const double scale : {2.0 / 8000, 0.5 * (2.0 / 8000 + 1.38 * 2 / 6053), 1.38 * 2 / 6053}) {
        thesis::cut c{.cycle = thesis::exact_cycle};
        c.force = scale / thesis::milling_harmonics::scale.value();
        const auto found = thesis::mill<Configuration>(c);
        if (found.diverged) continue;
        out.low = std::min(out.low, found.rms), out.high = std::max(out.high, found.rms);
    }
    return out;
}
inline outcome force_bands(const std::string& id) {
    using namespace thesis;
    // Printed: Table 5.4, measured.
    const std::array all{force_band<uncompensated>("(i)", 7.68), force_band<compensated>("(ii)", 4.43),
                         force_band<learning>("(iii)", 1.09)};
    outcome out;
    const std::array names{"i", "ii", "iii"};
    for (std::size_t k = 0; k < all.size(); ++k) band_rows(out, id, names[k], all[k]);
    out.pictures = {
        band_picture("Radial errors over the unknown scale of the forces",
                     "Rms on the circle of 30 mm at 100 mm/s; memory of 85.859 periods, weights [2, -1].",
                     {all.begin(), all.end()}, "radial error, rms [um]")};
    return out;
}

inline experiment bands() {
    const std::string c = "thesis.bands.attraction", f = "thesis.bands.force";
    return {"What is not printed, as bands",
            "[Jamaludin2008] Tables 4.2 and 5.4",
            "The thesis prints neither the constant C of its GMS model nor the scale of its forces. Here both "
            "run over "
            "what fits its pictures; where a printed figure lies outside of the band, the unknown number is "
            "not the "
            "reason for the distance.",
            0.10,
            {{c, [=] { return attraction_bands(c); }}, {f, [=] { return force_bands(f); }}}};
}

} // namespace quadrant_reproduce
