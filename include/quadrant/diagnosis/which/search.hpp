// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "tried_models.hpp"

namespace quadrant::inline v0::diagnosis {

/// One axis under diagnosis: the record, the described machine and the models tried so far.
class search : public tried_models {
public:
    search(const axis_record& record, const axis_description& axis, exclusions excluded, const rules& r,
           progress tell)
        : tried_models(record, axis, std::move(excluded), r, std::move(tell)) {}

    /// Adds the effect that predicts held-out motion best, a few ways abreast, until nothing pays; where no
    /// single effect pays on the calibrated machine and something is left, two at once. Returns the calibrated
    /// machine and the models with one cause more each.
    std::vector<candidate> run() const;

    /// The calibrated machine and the models with one cause of `best` more each, the cause that matters most
    /// first. What is no longer needed beside the others is left out.
    std::vector<candidate> path_to(const candidate& best) const;
    /// Whether run() ended because the time was up.
    bool cut() const { return cut_; }

    /// Of `known` and the models that were tried and score at least `least`, the one that is worth the most, by
    /// more than the margin if it is another one.
    template <class Worth>
    candidate most_worth(const candidate& known, double least, const Worth& worth) const {
        const candidate* best = &known;
        double most = worth(known) + rules_.margin;
        for (const candidate& c : tried_)
            if (std::isfinite(c.total) && c.total > least && !same(c, known) && pays(c, calibrated_) &&
                (!has_all(c, known) || explains_the_rest(c, known)))
                if (const double w = worth(c); w > most) {
                    most = w;
                    best = &c;
                }
        return *best;
    }
    /// The most that a model is worth that was tried and has none of these effects, nor one that holds one of
    /// them. Free forms, and models that score below `least`, are left out.
    template <class Worth>
    double best_without(const std::vector<const effect*>& names, double least, const Worth& worth) const {
        const auto has_one = [&](const candidate& c) {
            return std::any_of(names.begin(), names.end(), [&](const effect* e) {
                return std::any_of(c.effects.begin(), c.effects.end(), [&](const effect* in) {
                    return in == e || in->holds == e->name || in->box.empty();
                });
            });
        };
        double out = worth(calibrated_);
        for (const candidate& c : tried_)
            if (!has_one(c) && std::isfinite(c.total) && c.total > least) out = std::max(out, worth(c));
        return out;
    }

    /// The machine with the one effect that comes nearest to the record, or as calibrated.
    plant_model nearest() const {
        const candidate* best = &calibrated_;
        const auto single = with_each(calibrated_);
        for (const candidate& c : single)
            if (c.total > best->total) best = &c;
        return best->fit.plant;
    }

private:
    /// The score of a model, less what each of its names must bring.
    double worth(const candidate& c) const {
        return c.total - rules_.margin * static_cast<double>(c.effects.size());
    }
    /// Whether what a model leaves needs no further cause of another kind: nothing that would matter. Behind
    /// the loops of a drive the readings are compared with a path that a delay inside its tolerance moves by
    /// more than a force does; what causes leave there is not excused by it.
    bool enough(const candidate& c) const {
        return near_floor(c) && (record_.replayed() ? structure(c, noise(c)) < rules_.structure : settled(c));
    }
    /// Whether `step` is worth its name where `best` leaves what machines inside the tolerances differ by: it
    /// takes four fifths of the structure, as a cause does and a law that is a little wrong does not.
    bool explains_the_rest(const candidate& step, const candidate& best) const;
    /// The suspects whose number is beyond its tolerance: where nothing that would matter is left, such a
    /// number alone may still be missing.
    std::vector<const effect*> beyond_tolerance(const candidate& c) const {
        std::vector<const effect*> out = suspects();
        std::erase_if(out, [&](const effect* e) { return has(c, e) || !is_beyond_tolerance(c, *e); });
        return out;
    }
    void fit_to_the_end(candidate& best) const;
    /// Two at once of the best single effects: what two do to the force may cancel, and then neither pays
    /// alone. `single`: sorted.
    std::vector<candidate> in_pairs(std::vector<candidate> single) const;
    /// Where freeing a number of the machine file does better although it stays inside the tolerance, the fit
    /// of `best` stopped short (a play or a contact makes its score rough): it goes on from there. True: it got
    /// better.
    bool calibrate_again(candidate& best, const std::vector<candidate>& next) const;
    /// The same from the described numbers, where causes leave structure: the numbers at which the last name
    /// began had bent to what it explains. True: it got better.
    bool begin_as_described(candidate& best) const;
    /// Fits `best` again from the numbers of this plant. True: it got better, and what was tried beside it is
    /// forgotten where it had gained.
    bool fits_better_from(const plant_model& begun, candidate& best) const;
    /// Where `step`, which has one effect more, only led the other numbers to a better place, the effect takes
    /// nothing off: `best` goes on from those numbers without it, and what was tried beside it and may have
    /// stopped short of the step is forgotten. True: it got better.
    bool goes_on_without(candidate& best, const candidate& step) const;
    /// A wrong scale of the command changes every force at once, and several names together correct what it
    /// makes. Where it does alone as much as the first of the names of `best`, it is followed without that one
    /// to as many names. Returns the better one; the other is a model that was tried, and counts against it.
    candidate by_the_scale(const candidate& best) const;
    /// The calibrated machine with two and more of the everyday effects: one alone may take what two of them
    /// make. And the best `single` effect with each of them: beside it one may do what two do without it.
    std::vector<candidate> everyday(const candidate& single) const;
    /// The best of these that pays, after sorting them; null: none does.
    const candidate* paying(std::vector<candidate>& next, const candidate& best) const;

    mutable bool cut_ = false;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "search.ipp"
#endif
