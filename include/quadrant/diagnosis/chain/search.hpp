// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/effect_list.hpp"
#include "../effect/rules.hpp"
#include "../fit/scoring.hpp"
#include "../which/chance.hpp"
#include "start.hpp"

#include <optional>

namespace quadrant::inline v0::diagnosis::chain {

/// One term of the best model, and what speaks for it.
struct finding {
    term what;
    double probability = 0;       ///< of this name
    double group_probability = 0; ///< of it or one that this record does not distinguish from it
    std::vector<term> same{};     ///< those
    double before = 0, after = 0; ///< what is left without it and with it, on top of the findings before it [m]
};

/// Whether it is blamed, as a cause is.
inline bool is_claim(const finding& f) { return f.group_probability >= 0.5; }

/// Whether no name stands for a term: a drift, or two readings of two moments.
inline bool is_nameless(term t, bool asked) { return t == term::drift || (t == term::delay && !asked); }

/// What was found between two readings.
struct answer {
    fitted given;                  ///< as described
    fitted best;                   ///< with every finding
    fitted named;                  ///< with those that a name stands for which may be said
    fitted claimed;                ///< with those alone that are claimed, as `apply` writes them
    std::vector<fitted> path;      ///< from `given` on, with one finding more each
    std::vector<finding> findings; ///< the first takes most off
    bool at_floor = false;         ///< nothing is left beside noise and rounding
};

/// Energy of what a model leaves that is a function of the place: means of bins along the travel, less what the
/// scatter in a bin makes [m^2].
QUADRANT_DIAGNOSIS_DECL double left_along(const readings& r, const fitted& f);

/// Times noise and rounding: from there on what is left of a difference of two readings is a gap.
inline constexpr double near_rounding = 1.5;

/// Finds the terms of a link: greedy, with every earlier term tried again, as the search among the causes of a
/// force.
class seeker {
public:
    /// `excluded`: terms that the owner says cannot be. They join a model like the others, so that no other
    /// term stands for them, and are never a rival by name.
    seeker(const readings& r, link_model described, std::vector<term> excluded, const rules& limits);

    answer find() const;

private:
    /// `best` with each term that it lacks and that pays, the best first.
    std::vector<fitted> with_each(const fitted& best) const;
    /// Ways from the best first terms, and from the best two beside each: what looks alike alone (a lag and a
    /// play at one speed, a delay and a lag beside a slow follower) leads to different ends.
    fitted from_several(const fitted& given) const;
    /// From `way` to `next`, a model with one term more, and on, as long as it pays.
    fitted to_the_end(fitted way, fitted next) const;
    static double energy(const fitted& f) { return f.held_out * f.held_out; }
    double floor() const { return r_.noise() * r_.noise(); }
    /// Its score, with the odds of its names.
    static double value(const fitted& f);
    /// How common a term is before any record is seen.
    static double odds(term t);
    /// Whether a term pays: by its score, by what it takes off, and by at least half a count.
    bool pays(const fitted& with, const fitted& without, term t) const;
    /// Half of what a term moves the last reading by, from end to end [m].
    double half_range(const fitted& f, term t) const;
    /// With jumps looked for again beside all other terms: some stood in for what was found later.
    fitted with_steps_again(fitted best) const;
    fitted pruned(fitted best) const;
    /// The findings by what each takes off, the largest first.
    void order(answer& out) const;
    /// A model with one term of the best, its values that are no columns as found.
    fitted joined(const fitted& from, const fitted& best, term t) const;
    void weigh(const answer& out, finding& f) const;
    /// Whether a term is a function of the place alone.
    static bool of_place(term t) {
        return t == term::smooth || t == term::cyclic || t == term::scale || t == term::pitch;
    }
    /// Energy of the largest term of that kind in a model [m^2].
    static double largest_of_place(const fitted& f);

    const readings& r_;
    link_model described_;
    rules limits_;
    std::vector<term> suspects_, excluded_;
};

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "search.ipp"
#endif
