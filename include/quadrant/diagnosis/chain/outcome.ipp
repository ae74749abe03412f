// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../which/cause_values.hpp"

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL std::vector<double> apart(const readings& r, const fitted& f) {
    const auto& l = r.of();
    const auto velocity = derivative(zero_phase(l.first, 0.06 / l.period, l.period), l.period);
    std::vector<double> out(l.rows());
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = l.last[k] - l.first[k];
        for (std::size_t j = 0; j < f.of.size(); ++j)
            if (!f.of[j]) out[k] -= f.values[static_cast<Eigen::Index>(j)] * (j == 0 ? 1 : velocity[k]);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void give_signals(outcome& out, const readings& r, const fitted& f) {
    const std::size_t n = r.of().rows();
    out.difference.assign(n, 0.0);
    out.left.assign(n, 0.0);
    double mean = 0;
    for (std::size_t k : r.rows())
        mean += (r.of().last[k] - r.of().first[k]) / static_cast<double>(r.rows().size());
    for (std::size_t i = 0; i < r.rows().size(); ++i) {
        const std::size_t k = r.rows()[i];
        out.difference[k] = r.of().last[k] - r.of().first[k] - mean;
        out.left[k] = f.left[static_cast<Eigen::Index>(i)];
    }
}

QUADRANT_DIAGNOSIS_DECL cause cause_of(const described_link& d, const answer& a, const axis_description& axis,
                                       const finding& f) {
    cause c;
    c.axis = axis.name;
    c.effect = name_of(f.what);
    c.probability = f.probability;
    c.group_probability = f.group_probability;
    c.parameters = term_values(d, is_claim(f) ? a.claimed : a.best, axis).of(f.what);
    if (is_claim(f) && !std::all_of(a.findings.begin(), a.findings.end(), is_claim))
        detail::widen(c.parameters, c.with_suspects = term_values(d, a.best, axis).of(f.what));
    c.described = !c.parameters.empty() && described_value(axis, c.parameters[0].key) != 0;
    for (term t : f.same) c.confusable_with.emplace_back(name_of(t));
    c.gap_before_position_rms_m = {f.before, f.before, f.before};
    c.gap_after_position_rms_m = {f.after, f.after, f.after};
    const double shrink = f.before > 0 ? 1 - f.after / f.before : 0;
    c.shrink = {shrink, shrink, shrink};
    if (const effect* e = effect_named(c.effect)) c.exciting_motion = e->exciting_motion;
    return c;
}

QUADRANT_DIAGNOSIS_DECL std::string note_without_name(const described_link& d, const answer& a,
                                                      const axis_description& axis, term what) {
    if (what != term::drift)
        return fmt::format("axis {}: {} is read {:.3g} ms later than {}.", axis.name, d.to,
                           1e3 * a.best.model.delay, d.from);
    const auto part = a.best.part(what);
    return fmt::format(
        "axis {}: the difference of {} and {} drifts by {:.3g} um over the record: warmth, or something "
        "that is in no list.",
        axis.name, d.to, d.from, 1e6 * (part.maxCoeff() - part.minCoeff()));
}

QUADRANT_DIAGNOSIS_DECL described_link calibrated_link(const readings& r, const described_link& d,
                                                       const axis_description& axis, const rules& limits,
                                                       std::vector<parameter_estimate>& moved) {
    std::vector<term> waiting;
    const link_model& given = d.described;
    if (given.play > 0) waiting.push_back(term::play);
    if (given.compliance > 0 && !d.readings.force.empty()) waiting.push_back(term::spring);
    if (given.motor_coulomb > 0 && !d.readings.force.empty()) waiting.push_back(term::motor_friction);
    if (given.rate > 0) waiting.push_back(term::rate);
    if (given.delay > 0) waiting.push_back(term::delay);
    if (given.lag > 0) waiting.push_back(term::first_order);
    described_link out = d;
    while (!waiting.empty()) {
        link_model m = out.described;
        m.freed = waiting;
        const fitted f = settled(r, fit_columns(r, m));
        std::vector<term> held; // those that end at a bound: the others are fitted beside them
        std::vector<parameter_estimate> found;
        for (const term t : waiting) {
            parameter_estimate p = term_values(out, f, axis).of(t)[0];
            const machine_key* key = key_named(p.key);
            const double described = described_value(axis, p.key);
            const double part =
                key && key->tolerance ? axis.tolerance.of(std::string(key->tolerance_name())) : 0;
            const auto inside = [&](double v) {
                return std::clamp(v, (1 - part) * described, (1 + part) * described);
            };
            estimate& e = p.values[0];
            const double value = inside(e.value);
            if (value != e.value) held.push_back(t), p.on_bound = true;
            e = {value, inside(e.low), inside(e.high)};
            if (value != described) found.push_back(p);
            if (t == term::play) out.described.play = value;
            if (t == term::spring) out.described.compliance = 1 / value;
            if (t == term::motor_friction) out.described.motor_coulomb = value;
            if (t == term::rate) out.described.rate = value * out.set_point_to_load();
            if (t == term::delay) out.described.delay = value;
            if (t == term::first_order) out.described.lag = 1 / value;
        }
        if (held.empty() || held.size() == waiting.size()) {
            moved.insert(moved.end(), found.begin(), found.end());
            break;
        }
        for (const parameter_estimate& p : found)
            for (const term t : held)
                if (p.key == term_values(out, f, axis).of(t)[0].key) moved.push_back(p);
        std::erase_if(waiting, [&](term t) { return std::find(held.begin(), held.end(), t) != held.end(); });
    }
    if (fit_columns(r, out.described).score > fit_columns(r, given).score + limits.margin) return out;
    moved.clear();
    return d;
}

/// What the findings of a link come to, beside what is in the outcome.
struct told_findings {
    bool all_claimed = true;   ///< every cause
    bool without_name = false; ///< something was found that has no name, or an excluded one
    double unnamed = 0;        ///< its share of the difference
};

/// Share of the difference that a finding takes off; `whole`: its mean square.
inline double share_of(const finding& f, double whole) {
    return std::clamp((f.before * f.before - f.after * f.after) / whole, 0.0, 1.0);
}

/// The findings as causes, calibrated numbers, notes and places.
inline told_findings tell_findings(outcome& out, const readings& r, const described_link& d, const answer& a,
                                   const axis_description& axis, const std::vector<term>& left_out,
                                   double whole) {
    told_findings told;
    for (const finding& f : a.findings) {
        if (std::find(left_out.begin(), left_out.end(), f.what) != left_out.end()) {
            told.without_name = true;
            told.unnamed += share_of(f, whole);
            if (f.what == term::motor_friction && f.probability >= 0.5)
                out.unnamed_motor_coulomb = term_values(d, a.best, axis).of(f.what)[0].values[0].value;
            out.notes.push_back(
                fmt::format("axis {}: {}, which the machine file excludes, explains what lies between "
                            "{} and {} best: check excluded_effects.",
                            axis.name, effect_named(name_of(f.what))->label, d.from, d.to));
            continue;
        }
        if (is_nameless(f.what, d.readings.asked)) {
            told.without_name |= f.what == term::drift;
            out.notes.push_back(note_without_name(d, a, axis, f.what));
            continue;
        }
        cause c = cause_of(d, a, axis, f);
        if (!c.parameters.empty() && inside_tolerance(axis, c.parameters[0])) {
            std::erase_if(out.calibrated,
                          [&](const parameter_estimate& p) { return p.key == c.parameters[0].key; });
            out.calibrated.push_back(c.parameters[0]);
            continue;
        }
        const effect* e = effect_named(c.effect);
        const double share = share_of(f, whole);
        out.places.push_back({"block",
                              std::string(e->box),
                              std::string(e->label) + " takes this share off",
                              {share, share, share},
                              "causes"});
        if (f.what == term::play) {
            const auto more = places_of_reversals(r, a.best, share);
            out.places.insert(out.places.end(), more.begin(), more.end());
        }
        told.all_claimed &= claimed(c);
        // A claimed number is written as it is found, from wherever calibration had taken it.
        if (claimed(c))
            std::erase_if(out.calibrated, [&](const parameter_estimate& p) { return gives(c, p.key); });
        out.causes.push_back(std::move(c));
    }
    return told;
}

/// What a link's outcome comes to in one word.
inline verdict verdict_of(const outcome& out, bool at_floor, bool all_claimed) {
    const bool claims = std::any_of(out.causes.begin(), out.causes.end(), claimed);
    return at_floor ? out.causes.empty()
                          ? (out.calibrated.empty() ? verdict::no_gap : verdict::within_tolerance)
                      : all_claimed ? verdict::explained
                                    : verdict::partly_explained
           : claims ? verdict::partly_explained
                    : verdict::unexplained;
}

QUADRANT_DIAGNOSIS_DECL outcome diagnose_link(const described_link& as_described, const axis_description& axis,
                                              const std::vector<std::string>& excluded, const rules& limits) {
    std::vector<term> left_out;
    for (term t : all_terms)
        if (std::find(excluded.begin(), excluded.end(), name_of(t)) != excluded.end() && !name_of(t).empty())
            left_out.push_back(t);
    const readings r(as_described.readings);
    if (!says_enough(r))
        throw std::length_error(fmt::format("{} rows that count; a comparison of two positions needs {}",
                                            r.rows().size(), 4 * pieces));
    outcome out;
    described_link d = calibrated_link(r, as_described, axis, limits, out.calibrated);
    answer a = seeker(r, d.described, left_out, limits).find();
    // A number that went to the end of its tolerance may have done the work of a cause that was found after it.
    const auto stops = [](const parameter_estimate& p) { return p.on_bound; };
    if (!a.findings.empty() && std::any_of(out.calibrated.begin(), out.calibrated.end(), stops)) {
        answer other = seeker(r, as_described.described, left_out, limits).find();
        if (other.best.score > a.best.score && other.findings.size() <= a.findings.size()) {
            a = std::move(other), d = as_described;
            out.calibrated.clear();
        }
    }
    const fitted given = fit_columns(r, as_described.described);
    out.gap = {.position_rms_m = given.rms, .position_peak_m = given.left.cwiseAbs().maxCoeff()};
    out.gap_after = {.position_rms_m = a.named.held_out, .position_peak_m = a.named.left.cwiseAbs().maxCoeff()};
    out.gap.noise_floor_position_rms_m = out.gap_after.noise_floor_position_rms_m = r.noise();
    const double whole = std::max(a.given.held_out * a.given.held_out, 1e-300);
    const told_findings told = tell_findings(out, r, d, a, axis, left_out, whole);
    // What the force is known to moves the wind-up by as much.
    const double doubt = std::hypot(d.readings.force_doubt, best_law) *
                         term_values(d, a.best, axis).compliance() *
                         (d.readings.force.empty() ? 0 : rms(d.readings.force));
    const double floor = r.noise() * r.noise(), after = a.best.held_out * a.best.held_out;
    const bool at_floor =
        !told.without_name &&
        (a.at_floor || after - floor < law_error * law_error * (whole - floor) + doubt * doubt);
    double unnamed = told.unnamed;
    for (const finding& f : a.findings)
        if (f.what == term::drift) unnamed += share_of(f, whole);
    out.share_left = at_floor ? 0 : std::clamp(unnamed + (after - floor) / whole, 0.0, 1.0);
    const double rest = std::clamp(unnamed + after / whole, 0.0, 1.0);
    out.places.push_back({"block",
                          "",
                          at_floor ? "noise and rounding of the two readings"
                                   : fmt::format("between {} and {}: no cause says which", d.from, d.to),
                          {rest, rest, rest},
                          "replay"});
    out.verdict = verdict_of(out, at_floor, told.all_claimed);
    out.structure = fmt::format("axis {}: {:.3g} um rms between {} and {} (floor {:.3g} um)", axis.name,
                                1e6 * a.named.held_out, d.from, d.to, 1e6 * r.noise());
    give_signals(out, r, a.named);
    out.play = a.best.model.play;
    out.compliance = term_values(d, a.best, axis).compliance();
    const link_model& m = out.best = a.best.model;
    const bool moves = m.play > 0 || out.compliance > 0 || !m.pitch.empty() || !m.smooth.empty() ||
                       m.has(term::pitch) || m.has(term::smooth);
    if (moves && !d.readings.force.empty()) out.elastic = apart(r, a.best);
    return out;
}

} // namespace quadrant::inline v0::diagnosis::chain
