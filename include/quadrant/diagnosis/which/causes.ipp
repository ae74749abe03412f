// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Whether a number of the file was found only as far from it as is searched: another effect drives a fit that
/// far, too.
inline bool lies_beyond(const cause& found, const candidate& best) {
    return found.described && best.ends_at_a_bound(found.parameters.front().key);
}

/// Whether the scatter of what an effect adds reaches nothing. A number that moves by ratio never does.
inline bool may_be_absent(const candidate& best, const effect& e, const scoring& score) {
    const auto values = estimates(best, e, score);
    const auto by_ratio = [&](const parameter& p) { return p.key == values.front().key && p.logarithmic; };
    return std::none_of(best.fit.parameters.begin(), best.fit.parameters.end(), by_ratio) &&
           may_be_nothing(values);
}

/// Whether something else does as much as this cause. `of_laws`: the calibrated machine leaves no more than
/// laws of friction are wrong by.
inline bool is_no_claim(const axis_case& c, const effect& e, const cause& named, bool of_laws) {
    // An error of a law of friction is a force on the axis: it has no part in the command or the reading.
    const bool on_axis = e.joins != joint::command && e.joins != joint::reading;
    return (on_axis && (answers_between_rows(c.axis, c.log, c.record.period) || may_act_between_rows(c, e))) ||
           (of_laws && on_axis && may_be_friction(c, e)) || c.is_error_of_its_law(e) ||
           may_be_inside_its_tolerance(c, named.parameters) || drowns_in_the_rest(c, e) ||
           lies_beyond(named, c.best()) || late_velocity(c, named) > 0 ||
           repeats_with_the_motion(c.record, named) || outdoes_the_drive(c.record, c.best().fit.plant, named) ||
           is_lag_within_a_row(c, named) || rests_on_guessed_set_points(c, e) || cancelled_by(c, e) ||
           is_shadow_of_cogging(c, e) ||
           (!c.at_floor() &&
            (rings_beyond(c.record, named) || repeats_too_seldom(c.record, c.best().fit.plant, e.name))) ||
           std::any_of(e.ends_inside.begin(), e.ends_inside.end(),
                       [&](std::string_view key) { return !key.empty() && c.best().ends_at_a_bound(key); });
}

QUADRANT_DIAGNOSIS_DECL void to_suspects(std::span<cause> causes) {
    constexpr double guess = 0.4;
    for (cause& x : causes) {
        x.probability = std::min(x.probability, guess);
        x.group_probability = std::min(x.group_probability, guess);
    }
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<cause> plant_causes(const axis_case& c,
                                                        const std::vector<std::vector<detail::rival>>& rivals) {
    const auto& effects = c.best().effects;
    std::vector<cause> out;
    const bool of_laws = !effects.empty() && c.calibrated_within_its_laws();
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const effect& e = *effects[i];
        cause named;
        named.axis = c.axis.name;
        named.effect = e.name;
        named.exciting_motion = e.exciting_motion;
        named.parameters = estimates(c.best(), e, c.record.score);
        plant_model as_given = c.models.given().fit.plant, nothing_described;
        nothing_described.friction.contact.length = c.record.scale.give();
        for (const parameter& p : c.best().fit.parameters)
            if (p.key == named.parameters.front().key && p.of(as_given) != p.of(nothing_described))
                named.described = true;
        for (const auto& r : rivals[i]) {
            if (r.name == &e) {
                named.probability = r.weight;
                named.group_probability += r.weight;
            } else if (r.same && !r.unlikely) {
                named.confusable_with.emplace_back(r.name->name);
                named.group_probability += r.weight;
                auto values = estimates(r.model, *r.name, c.record.score);
                detail::add_model_error(values, *r.name, c, detail::left_beside(c, i));
                named.readings.push_back({std::string(r.name->name), std::move(values)});
            } else if (r.unlisted() && r.weight > 0.5) {
                named.better_form = r.name->name;
            }
        }
        const bool undetermined = detail::is_undetermined(named.parameters); // by its own scatter
        // Where another cause has a second reading, this one's values under that reading belong to its
        // interval.
        for (std::size_t j = 0; j < rivals.size(); ++j)
            for (const auto& r : rivals[j])
                if (j != i && r.same && !r.unlikely && r.name != effects[j])
                    detail::widen(named.parameters, estimates(r.model, e, c.record.score));
        const bool absent = !named.described && detail::may_be_absent(c.best(), e, c.record.score);
        // What is left beside a cause may have moved its values, unless the cause explains more.
        bool as_described = detail::is_as_described(named, e, as_given);
        const double left = detail::left_beside(c, i);
        detail::add_model_error(named.parameters, e, c, left);
        if (e.by_another_law > 1 || !(left < 1)) as_described = detail::is_as_described(named, e, as_given);
        // A suspect that is worth its place on held-out motion was there in one of eleven, however little spoke
        // for it (docs/trial.md).
        constexpr double least = 0.08;
        const auto excluded = detail::excluded_instead_of(c, i);
        if (excluded.probability > 0.5) named.better_excluded = excluded.name->name;
        const double known =
            (1 - detail::unknown(c, i)) * detail::against_others(c, rivals[i]) * (1 - excluded.probability);
        named.probability = std::max(least, named.probability * known);
        named.group_probability = std::max(named.probability, named.group_probability * known);
        if (undetermined || absent || as_described || detail::is_no_claim(c, e, named, of_laws))
            detail::to_suspects({&named, 1});
        out.push_back(std::move(named));
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
