// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../summary.hpp"

#include <quadrant/diagnosis/circle/result.hpp>

/// A ball-bar diagnosis in the words of a machine-tool engineer.
namespace quadrant_gap::circle {

using namespace quadrant::diagnosis;

inline std::string micrometres(double metres) { return fmt::format("{} µm", number(1e6 * metres)); }

/// A value in the unit in which it is read.
struct shown_unit {
    double factor;
    std::string_view unit;
};
inline shown_unit shown(std::string_view unit) {
    if (unit == "m") return {1e6, "µm"};
    if (unit == "s") return {1e3, "ms"};
    if (unit == "s^2") return {1e6, "µm per m/s²"};
    return {1e6, "µm/m"}; // rad, m/m
}
inline std::string value_text(const circle_error& e) {
    const auto [factor, unit] = shown(e.unit);
    const double half = factor * (e.value.high - e.value.low) / 2;
    const int decimals = std::clamp(half > 0 ? -int(std::floor(std::log10(half / 2))) : 2, 0, 4);
    return fmt::format("{} {} ({} to {})", fixed(factor * e.value.value, decimals), unit,
                       fixed(factor * e.value.low, decimals), fixed(factor * e.value.high, decimals));
}
inline std::string limit_text(const circle_error& e) {
    const auto [factor, unit] = shown(e.unit);
    return fmt::format("{} {}", number(factor * e.limit), unit);
}
inline std::string label(const circle_error& e) {
    return spaced(e.name) + (e.axis.empty() ? "" : " " + e.axis);
}
/// "squareness or servo mismatch" where the runs do not say which.
inline std::string claim(const circle_error& e) {
    std::vector<std::string> names{label(e)};
    for (const std::string& other : e.together_with) names.push_back(spaced(other));
    return listed(names, "or");
}
inline std::string direction(const circle_run& r) {
    return r.counterclockwise ? "counterclockwise" : "clockwise";
}

inline std::vector<const circle_error*> with(const circle_result& r, circle_verdict v) {
    std::vector<const circle_error*> out;
    for (const circle_error& e : r.errors)
        if (e.verdict == v) out.push_back(&e);
    return out;
}

inline double largest_circular_error(const circle_result& r) {
    double most = 0;
    for (const circle_run_result& k : r.runs) most = std::max(most, k.circular_error);
    return most;
}

inline std::string sentence(const circle_result& r) {
    const auto found = with(r, circle_verdict::found);
    const std::string size =
        fmt::format("The circular error is up to {} in {} run{}", micrometres(largest_circular_error(r)),
                    r.runs.size(), r.runs.size() == 1 ? "" : "s");
    if (found.empty()) return size + "; no error of the list is above its detection limit.";
    std::vector<std::string> first;
    double share = 0;
    for (const circle_error* e : found)
        if (first.size() < 3 && share < 0.8) first.push_back(claim(*e)), share += e->share;
    return fmt::format("{}: {} make{} {} of it, each taken alone.", size, listed(first),
                       first.size() == 1 ? "s" : "", percent(share));
}

/// One line for all errors of a verdict.
inline std::string below_text(const circle_result& r) {
    std::vector<std::string> items;
    for (const circle_error* e : with(r, circle_verdict::below_limit))
        items.push_back(fmt::format("{} ({})", label(*e), limit_text(*e)));
    return listed(items);
}
inline std::vector<std::string> inseparable_text(const circle_result& r) {
    std::vector<std::string> lines;
    for (const circle_error* e : with(r, circle_verdict::not_separable)) {
        std::vector<std::string> others;
        for (const std::string& o : e->together_with) others.push_back(spaced(o));
        lines.push_back(fmt::format("{} cannot be distinguished from {}: {}.", capital(label(*e)),
                                    listed(others), e->needs));
    }
    return lines;
}
inline std::vector<std::string> invisible_text(const circle_result& r) {
    std::vector<std::string> lines;
    for (const circle_error* e : with(r, circle_verdict::not_visible))
        lines.push_back(fmt::format("{}: {}.", capital(label(*e)), e->needs));
    return lines;
}
/// What is said of one found error below its number.
inline std::vector<std::string> remarks(const circle_error& e) {
    std::vector<std::string> lines{"Positive: " + e.sign + "."};
    if (!e.reading.empty()) lines.push_back(capital(e.reading) + ".");
    if (e.name == "reversal_spikes")
        for (const circle_detail& d : e.details)
            lines.push_back(
                fmt::format("{}: {}, {} wide.", d.what, micrometres(d.size.value), quantity(d.width_s, "s")));
    if (!e.effects.empty()) lines.push_back("In a machine file: " + named(e.effects, "or") + ".");
    return lines;
}

inline std::string summary(const circle_result& r, bool verbose) {
    std::string text = wrapped(sentence(r), 0) + "\n";
    text += fmt::format("  {:<18}{:>10}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "run", "feed", "radius", "G", "max",
                        "min", "left");
    for (const circle_run_result& k : r.runs)
        text += fmt::format("  {:<18}{:>5} mm/s{:>9} mm", direction(k.run), number(1e3 * k.run.feed),
                            number(1e3 * k.run.radius)) +
                fmt::format("{:>9} um{:>9} um{:>9} um{:>9} um\n", number(1e6 * k.circular_error),
                            number(1e6 * k.radial_max), number(1e6 * k.radial_min), number(1e6 * k.remaining));
    const auto found = with(r, circle_verdict::found);
    if (!found.empty())
        text += "\n  " + padded("error", 30) + padded("value (95 %)", 42) + padded("alone", 12) + "share\n";
    for (const circle_error* e : found) {
        text += "  " + padded(label(*e), 30) + padded(value_text(*e), 42) +
                padded(micrometres(e->circularity), 12) + percent(e->share) + "\n";
        if (!e->together_with.empty()) text += wrapped("or " + claim(*e).substr(label(*e).size() + 4), 4);
        if (verbose)
            for (const std::string& line : remarks(*e)) text += wrapped(line, 4);
    }
    text += "\n";
    if (const std::string below = below_text(r); !below.empty())
        text += wrapped("Not above what these runs would show: " + below + ".", 0);
    for (const std::string& line : inseparable_text(r)) text += wrapped(line, 0);
    if (const auto hidden = with(r, circle_verdict::not_visible); verbose)
        for (const std::string& line : invisible_text(r)) text += wrapped(line, 2);
    for (const std::string& note : r.notes) text += wrapped("Note: " + note, 0);
    return text;
}

} // namespace quadrant_gap::circle
