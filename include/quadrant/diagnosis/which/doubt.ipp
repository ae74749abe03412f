// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::detail {

/// The names of the best model but for one.
inline std::vector<const effect*> others_of(const axis_case& c, const effect* own) {
    std::vector<const effect*> out = c.best().effects;
    std::erase(out, own);
    return out;
}

QUADRANT_DIAGNOSIS_DECL double left_beside(const axis_case& c, std::size_t which) {
    return c.excused ? 0 : between(c.models.held_out_force(c.best()), c.floor_force()) / explained_by(c, which);
}

QUADRANT_DIAGNOSIS_DECL double doubtful_beside(const axis_case& c, double explained) {
    const double left = between(c.models.held_out_force(c.best()), c.floor_force());
    if (c.excused && left < explained) return 0;
    const double all = between(c.models.held_out_force(c.path.front()), c.models.held_out_force(c.best()));
    return std::hypot(left, all > explained ? law_error * between(all, explained) : 0) / explained;
}

/// The same, with the segment set apart that holds most of what is left: what happens once speaks against no
/// name that explains the rest of the record.
inline double doubtful_beside_odd_segment(const axis_case& c, std::size_t which) {
    const auto odd = c.models.odd_segment(c.best());
    if (!odd) return std::numeric_limits<double>::infinity();
    const auto force = [&](const candidate& m) { return c.models.held_out_force_beside(m, *odd); };
    const double after = force(c.best()), explained = between(least_before(c, which, force), after),
                 all = between(force(c.path.front()), after);
    return std::hypot(between(after, c.floor_force()),
                      all > explained ? law_error * between(all, explained) : 0) /
           explained;
}

QUADRANT_DIAGNOSIS_DECL double beside_path(const axis_record& r, const plant_model& plant) {
    std::vector<double> e;
    predictor on_the_model = r.observer;
    on_the_model.closed = r.velocity[0];
    on_the_model.run(plant, e);
    double sum = 0, rows = 0;
    for (std::size_t k = r.score.skip; k < r.position.size(); ++k)
        if (r.counts(k)) {
            sum += square(e[k]);
            ++rows;
        }
    return rows > 0 ? sum / rows : 0;
}

QUADRANT_DIAGNOSIS_DECL double left_of_paths(const axis_case& c, std::size_t which) {
    const auto others = others_of(c, c.best().effects[which]);
    const plant_model with = c.best().fit.plant,
                      without = others.empty() ? c.models.plant_without(c.best(), *c.best().effects[which])
                                               : c.models.with(others).fit.plant;
    double left = beside_path(c.record, with), before = beside_path(c.record, without);
    if (c.tested_apart()) {
        left += beside_path(*c.second, restarted(with, *c.second));
        before += beside_path(*c.second, restarted(without, *c.second));
    }
    return std::sqrt(left) / between(std::sqrt(before), std::sqrt(left));
}

QUADRANT_DIAGNOSIS_DECL double left_behind_drive(const axis_case& c, std::size_t which) {
    const auto others = others_of(c, c.best().effects[which]);
    const auto& channels = c.record.score.channels;
    double out = std::numeric_limits<double>::infinity();
    if (std::none_of(channels.begin(), channels.end(), [](const channel& x) { return x.of_tap; })) return out;
    const candidate without = others.empty() ? c.path.front() : c.models.with(others);
    for (std::size_t i = 0; i < channels.size(); ++i) {
        if (!channels[i].of_tap) continue;
        const auto above_noise = [&](const candidate& m) {
            return std::max(0.0, axis_floors::left_in(m.fit.ms[i], channels[i], c.noise));
        };
        const double before = above_noise(without), after = above_noise(c.best());
        if (before > after) out = std::min(out, std::sqrt(after / (before - after)));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double left_of_readings(const axis_case& c, std::size_t which) {
    return std::min(left_of_paths(c, which), left_behind_drive(c, which));
}

QUADRANT_DIAGNOSIS_DECL std::size_t names_as_likely(const axis_case& c, const effect& e) {
    double all = 0;
    const auto suspects = c.models.suspects();
    for (const effect* s : suspects) all += s->prior.odds;
    return std::min(suspects.size(), static_cast<std::size_t>(std::ceil(all / e.prior.odds)));
}

/// The best model without one of its causes, to be judged on the hold-out log. Fitted again, its other causes
/// may hold the axis fast where it moves: a model that leaves more of the forces along the motion than the
/// others with the numbers that they have only predicts what it corrects.
inline candidate without_standing(const axis_case& c, std::size_t which) {
    const effect* own = c.best().effects[which];
    const auto others = others_of(c, own);
    candidate again = c.models.with(others);
    if (others.empty() || c.record.observer.led || c.axis.drive.closes() || !shows_along_motion(c.best()))
        return again;
    candidate kept{.effects = others}; // a model of its own: what is known of the other is not true of it
    kept.fit.plant = c.models.plant_without(c.best(), *own);
    const auto left = c.left_along_motion(std::array{again.fit.plant, kept.fit.plant});
    return left[0] > left[1] ? kept : again;
}

QUADRANT_DIAGNOSIS_DECL double unknown(const axis_case& c, std::size_t which) {
    const std::size_t names = names_as_likely(c, *c.best().effects[which]);
    if (!c.tested_apart()) {
        if (c.record.closed()) return by_chance(names, left_of_readings(c, which));
        const double out = by_chance(names, doubtful_beside(c, explained_by(c, which)));
        // Nothing is below what chance does at the noise.
        return out > by_chance(names, 0)
                   ? std::min(out, by_chance(names, doubtful_beside_odd_segment(c, which)))
                   : out;
    }
    const auto before = c.second_log(without_standing(c, which)), after = c.second_log(c.best());
    const double gain = std::clamp((after.score - before.score) / score_temperature, -50.0, 0.0);
    const auto with_gain = [&](double out) { return 1 / (1 + (1 - out) / out * std::exp(gain)); };
    // What predicts another motion worse than the machine file does is no cause of both. A force hardly moves
    // the path of a stiff loop: there a hair says nothing.
    constexpr double doubt = 0.6;
    if (c.axis.drive.takes_position() && c.log.drive &&
        beside_path(*c.second, restarted(c.best().fit.plant, *c.second)) >
            square(1 + law_error) * beside_path(*c.second, restarted(c.models.given().fit.plant, *c.second)))
        return doubt;
    if (c.record.closed()) return with_gain(by_chance(names, c.excused ? 0 : left_of_readings(c, which)));
    const double machine = c.second_log(c.path.front()).force; // calibrated, without any cause
    const double here = explained_by(c, which), there = between(std::min(before.force, machine), after.force);
    double out = by_chance(names, doubtful_beside(c, std::max(here, there)));
    if (!c.settled_on_second) // the motion there may show it less, but not nothing of it beside an open gap
        out = std::max(out, by_chance(names, between(after.force, c.floor_force()) / std::sqrt(here * there)));
    return with_gain(out);
}

QUADRANT_DIAGNOSIS_DECL double against_others(const axis_case& c, const std::vector<rival>& names) {
    std::vector<const effect*> same;
    for (const rival& r : names)
        if (r.same || &r == &names.front()) same.push_back(r.name);
    const auto others = others_of(c, names.front().name);
    std::optional<taken_gap> gap;
    if (!c.settled && !c.record.closed()) gap.emplace(c, c.models.with(others));
    const double own = c.worth(c.best());
    const auto worth = [&](const candidate& m) {
        // Of a path that no further name improves enough, a model with more names says nothing; of forces, each
        // further name is worth its place only beyond the margin.
        const double more =
            std::max(0.0, static_cast<double>(m.effects.size()) - static_cast<double>(c.best().effects.size()));
        if (c.record.closed() && more > 0) return -std::numeric_limits<double>::infinity();
        const double out = c.worth(m) - c.limits.margin * more;
        const bool matters = gap && out > own - 5 * score_temperature;
        const bool may_be = out > own - 5 * score_temperature && ignores_the_command(c, m);
        return may_be || (matters && !gap->is_taken_by(m)) ? -std::numeric_limits<double>::infinity() : out;
    };
    return 1 / (1 + std::exp((c.models.best_without(same, c.least_score(), worth) - c.worth(c.best())) /
                             score_temperature));
}

QUADRANT_DIAGNOSIS_DECL excluded_rival excluded_instead_of(const axis_case& c, std::size_t which) {
    constexpr double owner_errs = 0.05;
    const effect* own = c.best().effects[which];
    const auto others = others_of(c, own);
    std::vector<candidate> models = c.models.with_excluded(c.path.front());
    if (!others.empty()) {
        const auto& beside = c.models.with_excluded(c.models.with(others));
        models.insert(models.end(), beside.begin(), beside.end());
    }
    std::erase_if(models, [&](const candidate& m) { return contains(m, c.best(), *own); });
    const auto score = [&](const candidate& m) {
        return m.total + (c.tested_apart() ? c.second_log(m).score : 0);
    };
    const double named = score(c.best());
    excluded_rival out;
    for (const candidate& m : models) {
        // That two names are wrong at once is as rare as an owner who errs.
        const double more =
            static_cast<double>(m.effects.size()) - static_cast<double>(c.best().effects.size());
        const double gain = score(m) - named - c.limits.margin * more;
        const double odds = owner_errs * std::exp(std::min(50.0, gain / score_temperature));
        if (odds / (1 + odds) > out.probability) out = {m.effects.back(), odds / (1 + odds)};
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL bool may_be_inside_its_tolerance(const axis_case& c,
                                                         const std::vector<parameter_estimate>& found) {
    if (!c.axis.drive.closes() || c.record.closed() || found.empty() ||
        !found.front().key.starts_with("drive."))
        return false;
    for (const parameter& p : c.path.front().fit.parameters)
        if (p.key == found.front().key && p.spread > 0) {
            const estimate& e = found.front().values.front();
            return e.low <= p.high && e.high >= p.low;
        }
    return false;
}

QUADRANT_DIAGNOSIS_DECL bool may_be_friction(const axis_case& c, const effect& e) {
    if (e.of_described_friction) return true; // it is that law
    const auto left = [&](const plant_model& p) {
        candidate m;
        m.fit.plant = p;
        return square(rms(beside_friction(c.record, c.models.residual(m))));
    };
    const double with = left(c.best().fit.plant), without = left(c.models.plant_without(c.best(), e));
    const double noise = std::min(with, square(c.floor_force()));
    const channel& band = c.record.score.channels.front();
    const double samples = band.nu * static_cast<double>(band.segment_of_block.size());
    const bool surely_there = 0.5 * samples * std::log(without / with) > c.limits.margin;
    return !(surely_there && without - with > 0.5 * (without - noise));
}

QUADRANT_DIAGNOSIS_DECL bool drowns_in_the_rest(const axis_case& c, const effect& e) {
    if (c.record.replayed() || !c.calibrated_within_tolerances()) return false;
    const std::array plants{c.best().fit.plant, c.models.plant_without(c.best(), e)};
    std::array<std::vector<double>, 2> innovation;
    c.record.observer.run(plants, innovation);
    auto &left = innovation[0], &does = innovation[1];
    for (std::size_t k = 0; k < does.size(); ++k) does[k] -= left[k];
    return std::all_of(c.record.score.channels.begin(), c.record.score.channels.end(),
                       [&](const channel& band) { return rms(seen(does, band)) < 2 * rms(seen(left, band)); });
}

QUADRANT_DIAGNOSIS_DECL const effect* cancelled_by(const axis_case& c, const effect& e) {
    const auto force_of = [&](const effect& of) {
        const plant_model without = c.models.plant_without(c.best(), of);
        std::vector<double> out;
        for (const double q : c.record.position)
            out.push_back(c.best().fit.plant.static_force(q) - without.static_force(q));
        return out;
    };
    const std::vector<double> own = force_of(e);
    if (!(rms(own) > 0)) return nullptr; // most causes are no force over the position
    for (const effect* other : c.best().effects) {
        if (other == &e) continue;
        std::vector<double> both = force_of(*other);
        const double least = std::min(rms(own), rms(both));
        for (std::size_t k = 0; k < both.size(); ++k) both[k] += own[k];
        if (rms(both) < least) return other;
    }
    return nullptr;
}

} // namespace quadrant::inline v0::diagnosis::detail
