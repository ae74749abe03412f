// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/harmonics.hpp"
#include "model.hpp"

namespace quadrant::inline v0::diagnosis::chain {

/// A table along the travel between whose places a control draws straight lines.
struct table_along {
    double from = 0, step = 1;
    std::vector<double> add{}; ///< to the asked position at each place

    double operator()(double x) const {
        const double at = std::clamp((x - from) / step, 0.0, static_cast<double>(add.size() - 1));
        const auto k = std::min(static_cast<std::size_t>(at), add.size() - 2);
        const double part = at - static_cast<double>(k);
        return (1 - part) * add[k] + part * add[k + 1];
    }
};

/// What is added to the asked position, and how far a metre that is asked goes.
struct position_compensation {
    bool step = false, table = false, scale = false;

    /// The table of the errors of an axis, sixteen places a turn where they repeat with it, 256 at most.
    static table_along table_of(const axis_description& axis, double low, double high) {
        const link_model m = described_gears(axis);
        const harmonics pitch(m.pitch_period, m.pitch, m.pitch_phase);
        const double a_turn = m.pitch.empty() ? (high - low) / 2 : m.pitch_period;
        const double places = std::clamp(std::ceil(16 * (high - low) / a_turn), 16.0, 256.0);
        table_along out{.from = low, .step = (high - low) / places, .add = {}};
        for (int k = 0; k <= static_cast<int>(places); ++k) {
            const double x = low + k * out.step;
            out.add.push_back(-(m.pitch.empty() ? 0 : pitch.at(x)) -
                              (m.smooth.empty() ? 0 : smooth_curve(m, x)));
        }
        return out;
    }
    /// Travel that the load makes for one that is asked, beside the described one.
    static double scale_of(const axis_description& described, const axis_description& axis) {
        const auto& was = described.transmission.travel_per_turn_m;
        const auto& is = axis.transmission.travel_per_turn_m;
        return was && is ? *is / *was : 1;
    }
};

/// Rms and peak of the difference that is left with a compensation of these numbers.
inline std::pair<double, double> left_with(const position_compensation& c, const axis_description& described,
                                           const axis_description& numbers, const position_link& l,
                                           std::size_t from) {
    const auto [low, high] = std::minmax_element(l.first.begin(), l.first.end());
    const auto behind = play_of(l.first, numbers.transmission.backlash_m.value_or(0)).offset;
    const table_along table = position_compensation::table_of(numbers, *low, *high);
    const double scale = position_compensation::scale_of(described, numbers);
    std::vector<double> left;
    double mean = 0;
    for (std::size_t k = from; k < l.rows(); ++k) {
        if (!l.left_out.empty() && l.left_out[k]) continue;
        double d = l.last[k] - l.first[k];
        if (c.scale) d -= (scale - 1) * l.first[k];
        if (c.step) d -= behind[k];
        if (c.table) d += table(l.first[k]);
        left.push_back(d);
        mean += d;
    }
    const auto n = static_cast<double>(std::max<std::size_t>(left.size(), 1));
    double square = 0, peak = 0;
    for (const double d : left) {
        square += (d - mean / n) * (d - mean / n) / n;
        peak = std::max(peak, std::abs(d - mean / n));
    }
    return {std::sqrt(square), peak};
}

/// The first row that counts: until the axis has gone a tenth of its travel, nobody knows at which side of a
/// play it stands.
inline std::size_t first_that_counts(const position_link& l) {
    std::size_t from = 0;
    for (double low = l.first[0], high = low; from < l.rows() && high - low < 0.1 * l.travel(); ++from) {
        low = std::min(low, l.first[from]);
        high = std::max(high, l.first[from]);
    }
    return from;
}

/// What a control is given for a compensation.
inline std::vector<key_value> settings_of(const position_compensation& c, const axis_description& corrected,
                                          const position_link& l) {
    std::vector<key_value> out;
    const auto [low, high] = std::minmax_element(l.first.begin(), l.first.end());
    if (c.step) out.push_back({"backlash_step_m", {*corrected.transmission.backlash_m}});
    if (c.scale) out.push_back({"travel_per_turn_m", {*corrected.transmission.travel_per_turn_m}});
    if (c.table) {
        const table_along t = position_compensation::table_of(corrected, *low, *high);
        key_value at{"table_at_m", {}};
        for (std::size_t k = 0; k < t.add.size(); ++k)
            at.values.push_back(t.from + static_cast<double>(k) * t.step);
        out.push_back(std::move(at));
        out.push_back({"table_add_m", t.add});
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL compensated_axis compensated_positions(
    const axis_description& axis, const axis_description& corrected, const axis_log& log, double period,
    const std::string& file, const std::vector<const axis_description*>& inside,
    const std::vector<const axis_description*>& at_ends, const std::vector<std::string>& effects) {
    compensated_axis out;
    out.name = axis.name;
    out.command_unit = axis.command_unit;
    const double count = std::max(axis.encoder.resolution_m, observed_count(log.position, log.position_step));
    const position_link l = log.motor.empty() ? asked_to(axis, log, period, log.position, count, true).readings
                                              : motor_to_scale(axis, log, period, file).readings;
    const std::size_t from = first_that_counts(l);
    const auto known = [](double x) { return estimate{x, x, x}; };
    out.forecast = out.positions_only = true;
    out.noise_m = l.noise();
    const auto now = left_with({}, axis, corrected, l, from);
    const double rms_now = now.first, peak_now = now.second;
    out.measured = {known(rms_now), known(peak_now), known(0), known(0)};

    const auto found = [&](std::string_view name) {
        return std::find(effects.begin(), effects.end(), name) != effects.end();
    };
    const auto add = [&](std::string name, std::vector<std::string> against, position_compensation c) {
        compensation out_of{.name = std::move(name), .effects = std::move(against)};
        out_of.settings = settings_of(c, corrected, l);
        const auto [rms_found, peak_found] = left_with(c, axis, corrected, l, from);
        estimate rms{rms_found, rms_found, rms_found}, peak{peak_found, peak_found, peak_found};
        for (const axis_description* a : inside) {
            const auto [r, p] = left_with(c, axis, *a, l, from);
            rms.high = std::max(rms.high, r);
            peak.high = std::max(peak.high, p);
        }
        double worst = rms.high;
        for (const axis_description* a : at_ends)
            worst = std::max(worst, left_with(c, axis, *a, l, from).first);
        out_of.after = {rms, peak, known(0), known(0)};
        const auto share = [&](double x) { return rms_now > 0 ? 1 - x / rms_now : 0; };
        out_of.gain = {share(rms.value), share(rms.high), share(rms.low)};
        out_of.gain_at_ends = share(worst);
        out_of.claimed = rms_now - rms.high > out.noise_m;
        out.compensations.push_back(std::move(out_of));
    };
    std::vector<std::string> of_table;
    for (const char* name : {"pitch_error", "travel_error"})
        if (found(name)) of_table.emplace_back(name);
    const position_compensation all{found("lost_motion"), !of_table.empty(), found("scale_error")};
    std::vector<std::string> every = of_table;
    if (all.table) add("table along the travel", of_table, {.table = true});
    if (all.step)
        add("step at each reversal", {"lost_motion"}, {.step = true}), every.emplace_back("lost_motion");
    if (all.scale) add("travel of a turn", {"scale_error"}, {.scale = true}), every.emplace_back("scale_error");
    if (out.compensations.size() > 1) add("together", every, all);
    return out;
}

} // namespace quadrant::inline v0::diagnosis::chain
