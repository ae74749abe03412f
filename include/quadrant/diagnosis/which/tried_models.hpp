// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/exclusions.hpp"
#include "model_fits.hpp"

#include <deque>
#include <set>

namespace quadrant::inline v0::diagnosis {

/// The models of an axis that are tried: with one of the suspects more, with one less, with one exchanged for
/// another. A set that was tried is looked up; a few rules fit it again from other numbers and keep the better.
class tried_models : public model_fits {
public:
    /// `from` with each of the suspects that it lacks, the most promising after a first look fitted to the end,
    /// the others scored as they stand. What was tried is kept: the same set of effects is not fitted twice.
    std::vector<candidate> with_each(const candidate& from) const { return with_each(from, suspects()); }
    std::vector<candidate> with_each(const candidate& from, const std::vector<const effect*>& among) const;
    /// Suspects that the search did not come to before the time was up.
    const std::set<const effect*>& missed() const { return missed_; }
    /// What is tried from here on is `part` of the work: at most so many rounds, each of which adds every
    /// suspect to one model. None: nobody knows how many, and each is half of what is left.
    void begins(const progress& part, std::optional<double> rounds = {}) const;
    candidate with(const candidate& from, const effect* added) const;
    /// `from` with each of these added, the most promising fitted to the end, `most` of those that were not met
    /// before.
    std::vector<candidate> with_these(const candidate& from, const std::vector<const effect*>& added,
                                      std::size_t most = std::numeric_limits<std::size_t>::max()) const;
    /// The described machine with these effects, fitted one after the other. One that cannot be identified
    /// without the others comes after them; one that cannot be identified at all adds nothing.
    candidate with(const std::vector<const effect*>& effects) const;

    /// A model with one of its effects taken off. The fit begins at the numbers of the others; where the same
    /// names were fitted before, the better of the two is kept.
    candidate without(const candidate& whole, const effect* own) const;
    /// The same for each of these effects, fitted side by side.
    std::vector<candidate> without_each(const candidate& whole, const std::vector<const effect*>& each) const;
    /// A model with one of its effects exchanged for each of these other names of the same force; the others
    /// keep their numbers where the fits begin. Where the same names were fitted before, the better of the
    /// two is kept.
    std::vector<candidate> exchanged(const candidate& whole, const effect* own,
                                     const std::vector<const effect*>& added) const;

    /// What another search of the same record tried, but for models with names that are excluded here.
    void take_over(const tried_models& other);

    std::vector<const effect*> suspects() const;

    /// `from` with each of the effects that the owner excludes, and would be suspects otherwise: they are never
    /// named, but what explains the record far better than a name speaks against the name.
    const std::vector<candidate>& with_excluded(const candidate& from) const;

    /// The forms without a name that compete. Along a motion a force that follows the command takes the command
    /// itself away, and would explain every record.
    std::vector<const effect*> forms() const;

    /// The suspects to exchange a cause for that was found on top of `before`; with rules.near_rivals those
    /// only that gained something there, as far as they were tried.
    std::vector<const effect*> relatives(const candidate& before) const;

protected:
    /// A wave of which only every n-th harmonic matters repeats n times in its period. Fitted again with the
    /// shorter one, it has as many harmonics there: what it could not follow is no second cause.
    void mend_in_lowest_terms(std::vector<candidate>& models, const std::vector<std::size_t>& which) const;

    tried_models(const axis_record& record, const axis_description& axis, exclusions excluded, const rules& r,
                 progress tell)
        : model_fits(record, axis, r, std::move(tell)), excluded_(std::move(excluded)) {}

    /// Whether an effect can act on this axis at all.
    bool possible(const effect& e) const;
    /// Whether a drive with loops of its own leaves this effect a place: what holds, limits or delays a command
    /// is its own, and box `drive`; only a limit of the motor's voltage or force behind a measured duty is not.
    bool beside_drive(const effect& e) const;
    /// A model with one of its effects taken off, not fitted again: the others keep their numbers, and what the
    /// effect had moved in the machine file is as described.
    candidate taken_off(const candidate& whole, const effect* own) const;
    exclusions excluded_;
    mutable std::set<const effect*> missed_{};
    /// A model with one effect less that was fitted from the numbers of another one.
    struct shorter {
        std::shared_ptr<std::optional<double>> of; ///< of that one: what copies of it share
        const effect* own;
        candidate model;
    };
    mutable std::vector<shorter> shorter_{};
    /// What with_excluded() found on top of a model.
    struct beside_excluded {
        candidate from;
        std::vector<candidate> models;
    };
    mutable std::deque<beside_excluded> excluded_models_{}; ///< does not move what it holds
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "tried_models.ipp"
#endif
