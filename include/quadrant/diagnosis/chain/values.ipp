// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL estimate with_interval(double value, double deviation, double count) {
    constexpr double t = 1.96 + 2.4 / (pieces - 1); // Student's factor, two terms
    const double half = std::hypot(t * deviation, best_law * value, count);
    return {value, value - half, value + half};
}

QUADRANT_DIAGNOSIS_DECL double described_value(const axis_description& axis, const std::string& key) {
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (k.name == key)
                if (const auto values = numbers_of(axis, k, *e); !values.empty()) return values[0];
    return 0;
}

QUADRANT_DIAGNOSIS_DECL bool inside_tolerance(const axis_description& axis, const parameter_estimate& p) {
    const machine_key* key = key_named(p.key);
    const double described = described_value(axis, p.key);
    if (!key || !key->tolerance || described == 0) return false;
    const double half = axis.tolerance.of(std::string(key->tolerance_name())) * std::abs(described);
    // A value that may as well be a described one is none that differs.
    return p.values[0].low <= described + half && p.values[0].high >= described - half;
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> term_values::of(term t) const {
    const double half_a_count = d_.readings.count() / 2;
    const double at_once = 1e-3 * d_.readings.period; // no row shows less
    const auto at = places(t);
    const link_model& m = f_.model;
    switch (t) {
    case term::play:
        return {{"transmission.backlash_m",
                 {with_interval(m.play + value(at[0]), deviation(at[0]), half_a_count)}}};
    case term::rate: {
        const double unit = d_.set_point_to_load(), found = std::max(m.rate + value(at[0]), 0.05 * m.rate);
        return {
            {"drive.setpoint_rate_limit_m_per_s", {with_interval(found / unit, deviation(at[0]) / unit, 0)}}};
    }
    case term::delay:
        return {{"drive.command_delay_s",
                 {with_interval(std::max(m.delay + value(at[0]), at_once), deviation(at[0]), 0)}}};
    case term::first_order: {
        const estimate lag = with_interval(std::max(m.lag + value(at[0]), at_once), deviation(at[0]), 0);
        return {{"drive.position_gain_per_s", {{1 / lag.value, 1 / lag.high, 1 / std::max(lag.low, at_once)}}}};
    }
    case term::scale:
        return scale(at[0]);
    case term::spring: {
        const double c = d_.described.compliance + value(at[0]);
        const estimate e = with_interval(c, deviation(at[0]), d_.readings.force_doubt * c);
        const double most = 1 / std::max(e.low, 1e-3 * std::abs(c));
        return {{"transmission.stiffness_N_per_m", {{1 / c, 1 / e.high, most}}}};
    }
    case term::motor_friction: {
        const double c = compliance(), level = m.motor_coulomb + value(at[0]) / c;
        return {{"transmission.motor_coulomb_N",
                 {with_interval(level, deviation(at[0]) / c, d_.readings.force_doubt * level)}}};
    }
    case term::pitch:
        return wave(at, "transmission.pitch_error_m", "transmission.pitch_period_m",
                    "transmission.pitch_phase_rad", m.pitch_period, true);
    case term::cyclic:
        return wave(at, "encoder.cyclic_m", "encoder.cyclic_period_m", "encoder.cyclic_phase_rad",
                    m.cyclic_period, false);
    case term::smooth:
        return smooth(at);
    case term::steps:
        return steps(at);
    default:
        return {};
    }
}

QUADRANT_DIAGNOSIS_DECL double term_values::compliance() const {
    const auto at = places(term::spring);
    return d_.described.compliance + (at.empty() ? 0 : value(at[0]));
}

QUADRANT_DIAGNOSIS_DECL std::vector<Eigen::Index> term_values::places(term t) const {
    std::vector<Eigen::Index> out;
    for (std::size_t j = 0; j < f_.of.size(); ++j)
        if (f_.of[j] == t) out.push_back(static_cast<Eigen::Index>(j));
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> term_values::scale(Eigen::Index j) const {
    const double turn = axis_.transmission.travel_per_turn_m.value_or(1);
    const double error = deviation(j) * turn, found = turn * (1 + value(j));
    const double half = 2.05 * std::hypot(error, 0.01 * value(j) * turn);
    std::vector<parameter_estimate> out{
        {"transmission.travel_per_turn_m", {{found, found - half, found + half}}}};
    if (!d_.motor_turns) {
        const double counted = axis_.transmission.counted_per_turn_m.value_or(turn);
        out.push_back({"transmission.counted_per_turn_m", {{counted, counted, counted}}});
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> term_values::wave(const std::vector<Eigen::Index>& at,
                                                                          const char* size, const char* period,
                                                                          const char* phase, double p,
                                                                          bool described) const {
    parameter_estimate sizes{.key = size, .values = {}}, phases{.key = phase, .values = {}};
    const double half_a_count = d_.readings.count() / 2;
    for (std::size_t i = 0; i + 1 < at.size(); i += 2) {
        double a = value(at[i]), b = value(at[i + 1]);
        const std::size_t j = i / 2;
        if (described && j < d_.described.pitch.size()) {
            const double turned = j < d_.described.pitch_phase.size() ? d_.described.pitch_phase[j] : 0;
            a += d_.described.pitch[j] * std::cos(turned);
            b += d_.described.pitch[j] * std::sin(turned);
        }
        const double s = std::hypot(a, b), e = std::hypot(deviation(at[i]), deviation(at[i + 1]));
        sizes.values.push_back(with_interval(s, e, half_a_count / 2));
        const double angle = std::atan2(b, a), error = std::min(std::numbers::pi, 2.05 * e / s);
        phases.values.push_back({angle, angle - error, angle + error});
    }
    const double error = p * p / (2 * std::numbers::pi * d_.readings.travel()) *
                         (sizes.values[0].high - sizes.values[0].low) / std::max(sizes.values[0].value, 1e-300);
    return {sizes, {period, {{p, p - error, p + error}}}, phases};
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate>
term_values::smooth(const std::vector<Eigen::Index>& at) const {
    if (!d_.described.smooth.empty()) return {}; // a curve beside another one has no key
    parameter_estimate out{.key = "transmission.travel_error_m", .values = {}};
    for (Eigen::Index j : at)
        out.values.push_back(with_interval(value(j), deviation(j), d_.readings.count() / 4));
    const double from = d_.readings.middle() - d_.readings.travel() / 2, to = from + d_.readings.travel();
    return {out,
            {"transmission.travel_error_from_m", {{from, from, from}}},
            {"transmission.travel_error_to_m", {{to, to, to}}}};
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate>
term_values::steps(const std::vector<Eigen::Index>& at) const {
    parameter_estimate sizes{.key = "missed_step_m", .values = {}}, times{.key = "missed_step_s", .values = {}};
    for (std::size_t i = 0; i < at.size(); ++i) {
        sizes.values.push_back(with_interval(value(at[i]), deviation(at[i]), d_.readings.count() / 2));
        const double t = static_cast<double>(f_.model.steps[i]) * d_.readings.period;
        times.values.push_back({t, t - 2 * d_.readings.period, t + 2 * d_.readings.period});
    }
    return {sizes, times};
}

} // namespace quadrant::inline v0::diagnosis::chain
