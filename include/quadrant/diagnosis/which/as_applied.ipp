// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> by_share(const axis_case& c, const candidate& from,
                                                        std::vector<const effect*> effects) {
    std::vector<candidate> out{from};
    while (!effects.empty()) {
        const effect* first = effects.front();
        candidate best = out.back();
        double least = std::numeric_limits<double>::infinity();
        for (const effect* e : effects) {
            auto with = out.back().effects;
            with.push_back(e);
            candidate m = c.models.with(with);
            if (!std::isfinite(m.total) || !(c.models.held_out_force(m) < least)) continue;
            least = c.models.held_out_force(m);
            first = e;
            best = std::move(m);
        }
        best.effects = out.back().effects;
        best.effects.push_back(first);
        std::erase(effects, first);
        out.push_back(std::move(best));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL const rival& heading(const std::vector<rival>& group) {
    const auto found = [](const rival& r) { return !own_number_ends_at_a_bound(r); };
    const rival* head = &group.front();
    for (const rival& r : group)
        if (r.same && (found(r) != found(*head) ? found(r) : r.weight > head->weight)) head = &r;
    return *head;
}

/// What claims as they are applied do not hold without the suspects: a number that may lie inside its tolerance
/// is calibration, and claims that do not take the gap of the machine file down explain nothing. Whether one
/// became a suspect so.
inline bool suspect_what_does_not_stand(const axis_case& c, std::vector<cause>& causes) {
    const bool explain = c.models.shrinks(c.applied(), c.models.given());
    bool any = false;
    for (std::size_t i = 0; i < c.claims; ++i) {
        const bool stands = explain && !c.models.is_calibration(c.applied(), c.best().effects[i]) &&
                            !may_be_inside_its_tolerance(c, causes[i].parameters);
        if (!stands) to_suspects({&causes[i], 1});
        any = any || !stands;
    }
    return any;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<std::vector<detail::rival>> rivals_by_weight(axis_case& c) {
    std::vector<std::vector<detail::rival>> out;
    std::size_t left = c.limits.most_causes;
    while (out.size() < c.best().effects.size()) {
        out.push_back(detail::rivals_of(c, out.size()));
        const detail::rival* heaviest = &detail::heading(out.back());
        if (left == 0 || heaviest == &out.back().front()) continue;
        auto way = c.models.path_to(heaviest->model);
        // Beside the other name something else was no longer needed, and the whole explains less.
        const bool leaves_no_more = way.back().effects.size() == c.best().effects.size() &&
                                    !(c.models.held_out_force(way.back()) > c.models.held_out_force(c.best()));
        const bool one_law = heaviest->of_one_speed && way.back().effects.size() == c.best().effects.size();
        if (!leaves_no_more && !one_law &&
            (!c.record.replayed() || way.back().effects.size() < c.best().effects.size()) &&
            c.worth(way.back()) + c.limits.margin < c.worth(c.best()))
            continue;
        --left;
        c.follow(std::move(way));
        out.clear();
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void put_as_applied(axis_case& c, std::vector<cause>& causes,
                                            std::vector<std::vector<detail::rival>>& rivals) {
    for (cause& x : causes)
        if (!x.with_suspects.empty()) x.parameters = std::exchange(x.with_suspects, {});
    std::vector<const effect*> claims, suspects;
    const auto effects = c.best().effects;
    for (std::size_t i = 0; i < causes.size(); ++i)
        (claimed(causes[i]) ? claims : suspects).push_back(effects[i]);
    auto way = detail::by_share(c, c.path.front(), claims);
    auto rest = detail::by_share(c, way.back(), suspects);
    way.insert(way.end(), std::make_move_iterator(rest.begin() + 1), std::make_move_iterator(rest.end()));
    c.path = std::move(way);
    c.claims = claims.size();

    std::vector<cause> ordered;
    std::vector<std::vector<detail::rival>> ordered_rivals;
    for (const effect* e : c.best().effects) {
        const auto i = static_cast<std::size_t>(std::find(effects.begin(), effects.end(), e) - effects.begin());
        ordered.push_back(std::move(causes[i]));
        ordered_rivals.push_back(std::move(rivals[i]));
    }
    causes = std::move(ordered);
    rivals = std::move(ordered_rivals);
    if (suspects.empty()) return;
    for (std::size_t i = 0; i < c.claims; ++i) {
        const effect& e = *c.best().effects[i];
        auto alone = estimates(c.applied(), e, c.record.score);
        detail::add_model_error(alone, e, c, detail::left_beside(c, i));
        detail::widen(alone, causes[i].parameters);
        causes[i].with_suspects = std::exchange(causes[i].parameters, std::move(alone));
    }
    if (detail::suspect_what_does_not_stand(c, causes)) put_as_applied(c, causes, rivals);
}

} // namespace quadrant::inline v0::diagnosis
