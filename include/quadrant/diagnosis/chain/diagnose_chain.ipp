// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL void join(axis_result& result, std::vector<cause>& causes, diagnosis_result& out,
                                  outcome&& o, const char* view) {
    result.verdict = std::max(result.verdict, o.verdict);
    for (place& p : o.places) {
        if (p.view == "block" && std::string_view(view) != "block") {
            if (p.block.empty()) continue;
            p.basis.clear();
            p.view = view;
        }
        result.where.push_back(std::move(p));
    }
    for (auto& p : o.calibrated) result.calibrated.push_back(std::move(p));
    for (cause& c : o.causes) causes.push_back(std::move(c));
    for (const std::string& note : o.notes) out.notes.push_back(text_of(note, result.kind));
    if (o.verdict > verdict::explained)
        out.remaining_structure +=
            (out.remaining_structure.empty() ? "" : "; ") + text_of(o.structure, result.kind);
    out.share_unexplained = std::max(out.share_unexplained, o.share_left);
}

QUADRANT_DIAGNOSIS_DECL outcome link_or_refusal(const described_link& d, const axis_description& axis,
                                                const std::string& file,
                                                const std::vector<std::string>& excluded, const rules& limits) {
    try {
        return diagnose_link(d, axis, excluded, limits);
    } catch (const std::length_error& e) {
        throw bad_input(file, fmt::format("axis {}: {}", axis.name, e.what()));
    }
}

/// What turns a beam at each reversal, in words; empty: nothing does. A play is that of the second end: where
/// the first stays behind, only the link with its ends exchanged shows it.
inline std::string told_by_reversals(const described_link& d, const outcome& o, const axis_description& axis,
                                     const axis_log& log, const std::vector<std::string>& excluded,
                                     const rules& limits) {
    const auto play_in = [](const outcome& of) {
        for (const cause& c : of.causes)
            if (c.effect == "lost_motion" && c.probability >= 0.5) return c.parameters[0].values[0].value;
        return 0.0;
    };
    const auto words = [&](const std::string& behind, const std::string& ahead, double play) {
        return fmt::format("axis {}: after each reversal {} stays {:.3g} um behind {}: the friction of the "
                           "ends turns the beam, or a joint of it is loose.",
                           axis.name, behind, 1e6 * play, ahead);
    };
    if (const double play = play_in(o); play > 0) return words(d.to, d.from, play);
    if (o.verdict <= verdict::explained || d.described.play > 0) return {};
    described_link exchanged = d;
    std::swap(exchanged.readings.first, exchanged.readings.last);
    std::swap(exchanged.readings.first_count, exchanged.readings.last_count);
    if (!says_enough(readings(exchanged.readings))) return {};
    const double play = play_in(diagnose_link(exchanged, axis, excluded, limits));
    if (play == 0) return {};
    return words(d.from, d.to, play) +
           fmt::format(R"( It is lost motion of the second end: write "ends": ["{}", "{}"].)", log.turn->second,
                       log.turn->first);
}

QUADRANT_DIAGNOSIS_DECL axis_result diagnose_positions(diagnosis_result& out, std::vector<cause>& causes,
                                                       const axis_description& axis, const axis_log& log,
                                                       double period, const std::string& file,
                                                       const std::vector<std::string>& excluded,
                                                       const rules& limits) {
    axis_result result;
    result.name = axis.name;
    result.kind = axis.kind;
    result.positions_only = true;
    result.evaluated_on = "held-out pieces of " + file;
    std::vector<described_link> links;
    const double count = std::max(axis.encoder.resolution_m, observed_count(log.position, log.position_step));
    if (!log.motor.empty()) {
        if (log.has_reference) {
            auto motor = motor_to_scale(axis, log, period, file).readings;
            links.push_back(asked_to(axis, log, period, motor.first, motor.first_count, false));
        }
        links.push_back(motor_to_scale(axis, log, period, file));
    } else {
        links.push_back(asked_to(axis, log, period, log.position, count, true));
    }
    double largest = -1;
    for (const described_link& d : links) {
        outcome o = link_or_refusal(d, axis, file, excluded, limits);
        if (links.size() > 1)
            for (place& p : o.places)
                if (p.view == "block") p.finding += fmt::format(" (between {} and {})", d.from, d.to);
        if (o.gap.position_rms_m > largest || o.verdict > result.verdict) {
            largest = std::max(largest, o.gap.position_rms_m);
            result.gap = o.gap;
            result.gap_after = o.gap_after;
            result.signals.residual_before = o.difference;
            result.signals.residual_after = o.left;
        }
        if (log.turn)
            if (auto told = told_by_reversals(d, o, axis, log, excluded, limits); !told.empty())
                o.notes.push_back(std::move(told));
        join(result, causes, out, std::move(o), "block");
    }
    if (links.size() > 1) // the shares are of two gaps
        for (place& p : result.where) p.share = {p.share.value / 2, p.share.low / 2, p.share.high / 2};
    std::stable_sort(result.where.begin(), result.where.end(), [](const place& a, const place& b) {
        return a.block.empty() != b.block.empty() ? b.block.empty() : a.share.value > b.share.value;
    });
    auto& s = result.signals;
    s.position = log.position;
    s.reference = log.has_reference ? log.reference : scaled(log.motor, links.back().to_load);
    s.velocity = derivative(zero_phase(s.position, 0.06 / period, period), period);
    for (std::size_t k = 0; k < s.position.size(); ++k) s.t.push_back(static_cast<double>(k) * period);
    return result;
}

QUADRANT_DIAGNOSIS_DECL two_encoders diagnose_transmission(const axis_description& axis, const axis_log& log,
                                                           double period, const std::string& file,
                                                           const std::vector<std::string>& excluded,
                                                           const rules& limits) {
    two_encoders out;
    auto d = motor_to_scale(axis, log, period, file);
    give_force(d, axis, log);
    if (!says_enough(readings(d.readings))) {
        out.notes.push_back(
            fmt::format("axis {}: the force changes its sign too often to identify which side of the "
                        "transmission is in contact: "
                        "the direction of the motion is taken for it, and nothing is said of the stiffness.",
                        axis.name));
        d = motor_to_scale(axis, log, period, file);
    }
    out.found = link_or_refusal(d, axis, file, excluded, limits);
    out.carried = log;
    out.motor_coulomb = axis.transmission.motor_coulomb_N.value_or(0);
    for (const cause& c : out.found.causes)
        if (c.effect == "motor_friction" && c.probability >= 0.5)
            out.motor_coulomb = c.parameters[0].values[0].value;
    if (out.found.unnamed_motor_coulomb) out.motor_coulomb = *out.found.unnamed_motor_coulomb;
    const auto& mass = axis.transmission.motor_mass_kg;
    if (!mass) {
        out.notes.push_back(
            fmt::format("axis {}: transmission.{} is not described: taken for nothing; the stiffness that "
                        "is found is too high by the share of the motor.",
                        axis.name, key_of("motor_mass_kg", axis.kind)));
        return out;
    }
    if (out.found.elastic.empty()) return out;
    out.motor_share = std::min(1.0, *mass / axis.plant.mass_kg);
    out.carry(out.carried, axis, out.found.elastic);
    return out;
}

QUADRANT_DIAGNOSIS_DECL axis_log carried_too(const two_encoders& found, const axis_description& axis,
                                             const axis_log& log, double period, const std::string& file) {
    axis_log out = log;
    if (found.motor_share == 0 || log.motor.empty()) return out;
    auto d = motor_to_scale(axis, log, period, file);
    give_force(d, axis, log);
    const readings r(d.readings);
    // The zeros and moments of the readings are this log's own.
    if (says_enough(r)) found.carry(out, axis, apart(r, fit_columns(r, found.found.best)));
    return out;
}

} // namespace quadrant::inline v0::diagnosis::chain
