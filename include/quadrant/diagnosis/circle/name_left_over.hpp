// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "names.hpp"
#include "stick_slip.hpp"

/// What is found beside the joint fit, as errors with a name.
namespace quadrant::inline v0::diagnosis::detail {

/// The patterns are first order: within 1 % of the loops that were tried. A spike's height depends on its
/// shape: 15 %.
inline circle_number interval_of(double value, double standard_error, double relative = 0.01) {
    const double reach = std::hypot(1.96 * standard_error, relative * value);
    return {value, value - reach, value + reach};
}

inline std::string where(const circle_run& r) {
    return fmt::format("feed {:.4g} mm/s, radius {:.4g} mm", 1e3 * r.feed, 1e3 * r.radius);
}

/// A found one into its error: size, size in each run, and whether it is the same in all of them.
inline void take_periodic_into(circle_error& e, const periodic_error& p, const std::vector<circle_run>& runs) {
    const bool in_time = e.name == "vibration";
    if (in_time && p.axis < 12) e.axis = p.axis == 10 ? "x" : "y";
    e.verdict = circle_verdict::found, e.period = p.period;
    for (std::size_t j = 0; j < runs.size(); ++j) {
        const auto size = interval_of(p.amplitude[j], p.error[j]);
        e.details.push_back({where(runs[j]) + (runs[j].counterclockwise ? ", counterclockwise" : ", clockwise"),
                             runs[j].feed, runs[j].radius, size});
        if (size.value > e.value.value) e.value = size;
    }
    e.circularity = 2 * e.value.value;
    if (in_time) {
        e.reading = fmt::format("{:.4g} Hz at every feed", p.period);
        return;
    }
    const bool fixed = p.common > 0.8, many = runs.size() > 1;
    e.reading = fmt::format("period {:.4g} mm along the axis, {}", 1e3 * p.period,
                            !many   ? "one run only: whether it follows the feed is not known"
                            : fixed ? "the same in all runs: an encoder's or a screw's"
                                    : "differs between the runs: a force such as cogging, or an encoder's seen "
                                      "through its own loop");
    if (!fixed || !many) return;
    std::erase(e.effects, "cogging"), std::erase(e.effects, "force_ripple");
}

inline std::vector<circle_error> name_periodic(const std::vector<circle_run>& runs,
                                               const std::vector<periodic_error>& found,
                                               const std::array<double, 3>& limits,
                                               const std::vector<std::string>& excluded) {
    std::vector<circle_error> out;
    for (std::size_t k = 0; k < 3; ++k) {
        circle_error e = named_error(k < 2 ? "cyclic_error" : "vibration",
                                     k == 0   ? "x"
                                     : k == 1 ? "y"
                                              : "",
                                     "m", excluded);
        e.limit = limits[k];
        const auto p = std::find_if(found.begin(), found.end(), [&](const periodic_error& f) {
            return k < 2 ? f.axis == int(k) : f.axis >= 10;
        });
        if (p != found.end()) take_periodic_into(e, *p, runs);
        out.push_back(std::move(e));
    }
    return out;
}

inline std::vector<circle_error> name_stick_slip(const std::vector<circle_run>& runs, const residuals& left,
                                                 double floor, const std::vector<std::string>& excluded) {
    std::vector<circle_error> out;
    double slowest = HUGE_VAL;
    for (const circle_run& r : runs) slowest = std::min(slowest, r.feed);
    for (const int axis : {0, 1}) {
        circle_error e = named_error("stick_slip", axis == 0 ? "x" : "y", "m", excluded);
        double swings = 0, elsewhere = 0;
        for (std::size_t j = 0; j < runs.size(); ++j) {
            const auto s = stick_slip_of(runs[j], left[j], axis);
            const bool slow = runs[j].feed < 1.05 * slowest;
            e.limit = std::max(e.limit, slow ? std::max(s.threshold, floor) : 0);
            if (slow)
                swings = std::max(swings, s.swings);
            else if (s.height > 0.5 * s.threshold)
                elsewhere = std::max(elsewhere, s.swings);
            if (slow && s.height > e.value.value) e.value = interval_of(s.height, s.error);
        }
        const bool found = swings >= 6 && e.value.value > e.limit && elsewhere < 0.5 * swings;
        if (found) {
            e.verdict = circle_verdict::found, e.circularity = e.value.value;
            e.reading = fmt::format("{:.0f} jumps after a reversal at {:.3g} mm/s", swings, 1e3 * slowest);
        } else {
            e.value = {};
        }
        out.push_back(std::move(e));
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
