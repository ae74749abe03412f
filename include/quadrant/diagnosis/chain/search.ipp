// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL seeker::seeker(const readings& r, link_model described, std::vector<term> excluded,
                                       const rules& limits)
    : r_(r), described_(std::move(described)), limits_(limits), suspects_(suspects_of(r.of())),
      excluded_(std::move(excluded)) {}

QUADRANT_DIAGNOSIS_DECL double left_along(const readings& r, const fitted& f) {
    constexpr std::size_t bins = 60;
    struct bin {
        double n = 0, sum = 0, square = 0;
    };
    std::vector<bin> all(bins);
    const auto where = places(r, false);
    for (std::size_t i = 0; i < where.size(); ++i) {
        const double u = std::clamp((r.along(where[i]) + 1) / 2, 0.0, 1.0);
        bin& b = all[std::min(bins - 1, static_cast<std::size_t>(u * bins))];
        const double e = f.left[static_cast<Eigen::Index>(i)];
        b.n += 1, b.sum += e, b.square += e * e;
    }
    double energy = 0;
    for (const bin& b : all)
        if (b.n > 1) energy += b.sum * b.sum / b.n - (b.square - b.sum * b.sum / b.n) / (b.n - 1);
    return std::max(0.0, energy / static_cast<double>(where.size()));
}

QUADRANT_DIAGNOSIS_DECL answer seeker::find() const {
    answer out;
    out.given = fit_columns(r_, described_);
    const fitted best = from_several(out.given);
    out.best = best;
    out.at_floor = best.held_out < near_rounding * r_.noise();
    order(out);
    for (finding& f : out.findings) weigh(out, f);
    out.named = out.claimed = best;
    for (const finding& f : out.findings) {
        const bool excluded = std::find(excluded_.begin(), excluded_.end(), f.what) != excluded_.end();
        if (is_nameless(f.what, r_.of().asked) || excluded)
            out.named = without_term(r_, out.named, f.what, described_);
        if (!is_claim(f)) out.claimed = without_term(r_, out.claimed, f.what, described_);
    }
    if (!possible(r_, out.claimed)) out.claimed = best; // a claim that needs a suspect to make sense
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<fitted> seeker::with_each(const fitted& best) const {
    std::vector<fitted> out;
    for (term t : suspects_) {
        if (best.model.has(t)) continue;
        fitted tried = with_term(r_, best, t, limits_.margin);
        if (tried.model.has(t) && pays(tried, best, t)) out.push_back(std::move(tried));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const fitted& a, const fitted& b) { return value(a) > value(b); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL fitted seeker::from_several(const fitted& given) const {
    constexpr std::size_t ways = 3, beside_each = 2;
    fitted best = given;
    auto first = with_each(given);
    first.resize(std::min(first.size(), ways), given);
    for (const fitted& way : first) {
        if (value(way) > value(best)) best = way;
        auto second = with_each(way);
        second.resize(std::min(second.size(), beside_each), given);
        for (fitted& next : second)
            if (fitted end = to_the_end(way, std::move(next)); value(end) > value(best)) best = std::move(end);
    }
    return best;
}

QUADRANT_DIAGNOSIS_DECL fitted seeker::to_the_end(fitted way, fitted next) const {
    constexpr std::size_t most = 7;
    for (;;) {
        fitted on = pruned(std::move(next));
        if (!(value(on) > value(way))) return way; // one term came for another, and would go for it again
        way = std::move(on);
        if (way.model.freed.size() >= most) return way;
        auto more = with_each(way);
        if (more.empty()) return way;
        next = std::move(more.front());
    }
}

QUADRANT_DIAGNOSIS_DECL double seeker::value(const fitted& f) {
    double out = f.score;
    for (term t : f.model.freed) out += score_temperature * std::log(odds(t)) - 1;
    return out;
}

QUADRANT_DIAGNOSIS_DECL double seeker::odds(term t) {
    const effect* e = effect_named(name_of(t));
    return e ? e->prior.odds : 0.3;
}

QUADRANT_DIAGNOSIS_DECL bool seeker::pays(const fitted& with, const fitted& without, term t) const {
    const double half = half_range(with, t);
    const double off = (energy(without) - energy(with)) / std::max(energy(without) - floor(), 1e-300);
    return value(with) > value(without) + limits_.margin && off > limits_.least_shrink &&
           half > r_.of().count() / 2;
}

QUADRANT_DIAGNOSIS_DECL double seeker::half_range(const fitted& f, term t) const {
    if (t == term::play) return f.model.play / 2;
    if (of_lateness(t)) {
        double late = f.model.late(t);
        for (std::size_t j = 0; j < f.of.size(); ++j)
            if (f.of[j] == t) late += f.values[static_cast<Eigen::Index>(j)];
        return std::abs(late - described_.late(t)) * r_.speed();
    }
    if (t == term::rate) { // how far what is asked runs away
        const auto free = r_.first();
        const auto held = at_most_as_fast(free, f.model.rate * r_.of().period);
        double most = 0;
        for (std::size_t k = 0; k < held.size(); ++k) most = std::max(most, std::abs(free[k] - held[k]));
        return most;
    }
    const auto part = f.part(t);
    if (t == term::motor_friction) { // beside a play its level is no column: it decides the side in contact
        double compliance = f.model.compliance;
        for (std::size_t j = 0; j < f.of.size(); ++j)
            if (f.of[j] == term::spring) compliance += f.values[static_cast<Eigen::Index>(j)];
        return (part.maxCoeff() - part.minCoeff()) / 2 +
               compliance * std::abs(f.model.motor_coulomb - described_.motor_coulomb);
    }
    return (part.maxCoeff() - part.minCoeff()) / 2;
}

QUADRANT_DIAGNOSIS_DECL fitted seeker::with_steps_again(fitted best) const {
    if (!best.model.has(term::steps) || best.model.freed.size() < 2) return best;
    return with_steps(r_, without_term(r_, best, term::steps, described_), limits_.margin);
}

QUADRANT_DIAGNOSIS_DECL fitted seeker::pruned(fitted best) const {
    best = with_steps_again(std::move(best));
    for (bool again = true; again && best.model.freed.size() > 1;) {
        again = false;
        for (term t : best.model.freed) {
            fitted less = without_term(r_, best, t, described_);
            if (pays(best, less, t)) continue;
            best = std::move(less);
            again = true;
            break;
        }
    }
    return best;
}

QUADRANT_DIAGNOSIS_DECL void seeker::order(answer& out) const {
    out.path = {out.given};
    std::vector<term> waiting = out.best.model.freed;
    fitted now = out.given;
    while (!waiting.empty()) {
        std::optional<fitted> next;
        term first = waiting.front();
        for (term t : waiting) {
            fitted tried = joined(now, out.best, t);
            if (!next || tried.held_out < next->held_out) next = std::move(tried), first = t;
        }
        out.findings.push_back({.what = first, .before = now.held_out, .after = next->held_out});
        now = *std::move(next);
        out.path.push_back(now);
        std::erase(waiting, first);
    }
}

QUADRANT_DIAGNOSIS_DECL fitted seeker::joined(const fitted& from, const fitted& best, term t) const {
    link_model m = from.model;
    m.freed.push_back(t);
    if (t == term::play) m.play = best.model.play;
    if (of_lateness(t)) m.late(t) = best.model.late(t);
    if (t == term::rate) m.rate = best.model.rate;
    if (t == term::pitch)
        m.pitch_period = best.model.pitch_period, m.pitch_harmonics = best.model.pitch_harmonics;
    if (t == term::cyclic) m.cyclic_period = best.model.cyclic_period;
    if (t == term::motor_friction) m.motor_coulomb = best.model.motor_coulomb;
    if (t == term::steps) m.steps = best.model.steps;
    return fit_columns(r_, m);
}

QUADRANT_DIAGNOSIS_DECL double seeker::largest_of_place(const fitted& f) {
    double out = 0;
    for (term t : f.model.freed) {
        if (!of_place(t)) continue;
        const auto part = f.part(t);
        out = std::max(out, (part.array() - part.mean()).square().mean());
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void seeker::weigh(const answer& out, finding& f) const {
    const fitted without = without_term(r_, out.best, f.what, described_);
    const double explained = std::max(energy(without) - energy(out.best), 1e-300);
    const double left = out.at_floor ? 0 : std::max(0.0, energy(out.best) - floor());
    double sum = 1, same = 1; // weights beside that of the name itself
    sum += std::exp(std::clamp((value(without) - value(out.best)) / score_temperature, -50.0, 50.0));
    for (term u : suspects_) {
        if (out.best.model.has(u)) continue;
        const fitted rival = with_term(r_, without, u, limits_.margin);
        if (!rival.model.has(u)) continue;
        double weight = std::exp(std::clamp((value(rival) - value(out.best)) / score_temperature, -50.0, 50.0));
        const bool alike = energy(rival) - energy(out.best) < law_error * law_error * explained + left;
        if (alike && pays(rival, without, u))
            weight = std::max(weight, std::min(1.0, odds(u) / odds(f.what)) * 0.5);
        sum += weight;
        const bool may_be = std::find(excluded_.begin(), excluded_.end(), u) == excluded_.end();
        if (weight > 0.01 && may_be && pays(rival, without, u) && !name_of(u).empty()) {
            f.same.push_back(u);
            same += weight;
        }
    }
    double known = 1 - detail::by_chance(suspects_.size(), std::sqrt(left / explained));
    // What is left along the travel is a curve that none of these names stands for.
    const double along = left_along(r_, out.best);
    if (of_place(f.what) && !out.at_floor && along > law_error * law_error * explained && along > left / 2)
        known = std::min(known, 0.45);
    // Nor is any curve known to more than five per cent of another one that lies under it.
    if (of_place(f.what) && explained < law_error * law_error * largest_of_place(out.best))
        known = std::min(known, 0.45);
    // A wrong ratio is wrong everywhere. A large one that leaves more than any law does is how a follower looks
    // that does not keep up.
    const auto ratio = std::find(out.best.of.begin(), out.best.of.end(), term::scale);
    if (f.what == term::scale && r_.of().asked && left > law_error * law_error * explained &&
        std::abs(out.best.values[ratio - out.best.of.begin()]) > tolerance_description::unstated)
        known = std::min(known, 0.45);
    // A limit of the speed lets go between two rows, and what it is wrong by in that moment stays: a step, and
    // a share of the travel, that is small beside what the limit takes off.
    if (f.what == term::steps || f.what == term::scale)
        for (const finding& limit : out.findings)
            if (limit.what == term::rate &&
                explained < law_error * law_error * (square(limit.before) - square(limit.after)))
                known = std::min(known, 0.45);
    // Two waves so near each other that one beats with the other over the travel: which of them is there, or
    // whether one stands for what the other leaves, neither says.
    const bool wave = f.what == term::pitch || f.what == term::cyclic;
    const link_model& m = out.best.model;
    if (wave && m.has(term::pitch) && m.has(term::cyclic) && is_fraction(r_, m.cyclic_period, r_.of().turn))
        known = std::min(known, 0.45);
    f.probability = known / sum;
    f.group_probability = known * same / sum;
}

} // namespace quadrant::inline v0::diagnosis::chain
