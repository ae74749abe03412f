// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/rules.hpp"
#include "../fit/scoring.hpp"
#include "../which/chance.hpp"
#include "start.hpp"

#include <optional>

namespace quadrant::diagnosis::chain {

/// One term of the best model, and what speaks for it.
struct finding {
    term what;
    double probability = 0;       ///< of this name
    double group_probability = 0; ///< of it or one that this record does not tell from it
    std::vector<term> same{};     ///< those
    double before = 0, after = 0; ///< what is left without it and with it, on top of the findings before it [m]
};

/// What was found between two readings.
struct answer {
    fitted given;                  ///< as described
    fitted best;                   ///< with every finding
    std::vector<fitted> path;      ///< from `given` on, with one finding more each
    std::vector<finding> findings; ///< the first takes most off
    bool at_floor = false;         ///< nothing is left beside noise and rounding
};

/// Finds the terms of a link: greedy, with every earlier term tried again, as the search among the causes of a
/// force.
class seeker {
public:
    seeker(const readings& r, link_model described, std::vector<term> excluded, const rules& limits)
        : r_(r), described_(std::move(described)), limits_(limits) {
        suspects_ = suspects_of(r.of());
        std::erase_if(suspects_,
                      [&](term t) { return std::find(excluded.begin(), excluded.end(), t) != excluded.end(); });
    }

    answer find() const {
        answer out;
        out.given = fit_columns(r_, described_);
        const fitted best = from_several(out.given);
        out.best = best;
        out.at_floor = best.held_out < limits_.near_floor * r_.noise();
        order(out);
        for (finding& f : out.findings) weigh(out, f);
        return out;
    }

private:
    /// `best` with each term that it lacks and that pays, the best first.
    std::vector<fitted> with_each(const fitted& best) const {
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
    /// One way from each of the best first terms: two that look alike alone (a lag and a play at one speed)
    /// lead to different ends.
    fitted from_several(const fitted& given) const {
        constexpr std::size_t ways = 3, most = 7;
        fitted best = given;
        auto first = with_each(given);
        first.resize(std::min(first.size(), ways), given);
        for (fitted way : first) {
            while (way.model.freed.size() < most) {
                auto next = with_each(way);
                if (next.empty()) break;
                way = pruned(std::move(next.front()));
            }
            if (value(way) > value(best)) best = std::move(way);
        }
        return best;
    }
    static double energy(const fitted& f) { return f.held_out * f.held_out; }
    double floor() const { return r_.noise() * r_.noise(); }
    /// Its score, with the odds of its names.
    static double value(const fitted& f) {
        double out = f.score;
        for (term t : f.model.freed) out += score_temperature * std::log(odds(t)) - 1;
        return out;
    }
    /// How common a term is before any record is seen.
    static double odds(term t) {
        const effect* e = effect_named(name_of(t));
        return e ? e->prior.odds : 0.3;
    }
    /// Whether a term pays: by its score, by what it takes off, and by at least half a count.
    bool pays(const fitted& with, const fitted& without, term t) const {
        const double half = half_range(with, t);
        const double off = (energy(without) - energy(with)) / std::max(energy(without) - floor(), 1e-300);
        return value(with) > value(without) + limits_.margin && off > limits_.least_shrink &&
               half > r_.of().count() / 2;
    }
    /// Half of what a term moves the last reading by, from end to end [m].
    double half_range(const fitted& f, term t) const {
        if (t == term::play) return f.model.play / 2;
        if (t == term::delay || t == term::first_order) return f.model.lag * r_.speed();
        const auto part = f.part(t);
        return (part.maxCoeff() - part.minCoeff()) / 2;
    }
    /// With jumps looked for again beside all other terms: some stood in for what was found later.
    fitted with_steps_again(fitted best) const {
        if (!best.model.has(term::steps) || best.model.freed.size() < 2) return best;
        return with_steps(r_, without_term(r_, best, term::steps, described_), limits_.margin);
    }
    fitted pruned(fitted best) const {
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
    /// The findings by what each takes off, the largest first.
    void order(answer& out) const {
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
    /// A model with one term of the best, its values that are no columns as found.
    fitted joined(const fitted& from, const fitted& best, term t) const {
        link_model m = from.model;
        m.freed.push_back(t);
        if (t == term::play) m.play = best.model.play;
        if (t == term::delay || t == term::first_order) m.how = best.model.how, m.lag = best.model.lag;
        if (t == term::pitch)
            m.pitch_period = best.model.pitch_period, m.pitch_harmonics = best.model.pitch_harmonics;
        if (t == term::cyclic) m.cyclic_period = best.model.cyclic_period;
        if (t == term::steps) m.steps = best.model.steps;
        return fit_columns(r_, m);
    }
    void weigh(const answer& out, finding& f) const {
        const fitted without = without_term(r_, out.best, f.what, described_);
        const double explained = std::max(energy(without) - energy(out.best), 1e-300);
        const double left = out.at_floor ? 0 : std::max(0.0, energy(out.best) - floor());
        double sum = 1, same = 1; // weights beside that of the name itself
        sum += std::exp(std::clamp((value(without) - value(out.best)) / score_temperature, -50.0, 50.0));
        for (term u : suspects_) {
            if (out.best.model.has(u)) continue;
            const fitted rival = with_term(r_, without, u, limits_.margin);
            if (!rival.model.has(u)) continue;
            double weight =
                std::exp(std::clamp((value(rival) - value(out.best)) / score_temperature, -50.0, 50.0));
            const bool alike = energy(rival) - energy(out.best) < law_error * law_error * explained + left;
            if (alike && pays(rival, without, u))
                weight = std::max(weight, std::min(1.0, odds(u) / odds(f.what)) * 0.5);
            sum += weight;
            if (weight > 0.01 && pays(rival, without, u) && !name_of(u).empty()) {
                f.same.push_back(u);
                same += weight;
            }
        }
        const double known = 1 - detail::by_chance(suspects_.size(), std::sqrt(left / explained));
        f.probability = known / sum;
        f.group_probability = known * same / sum;
    }

    const readings& r_;
    link_model described_;
    rules limits_;
    std::vector<term> suspects_;
};

} // namespace quadrant::diagnosis::chain
