// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/exclusions.hpp"
#include "../effect/rules.hpp"
#include "../text/on_all_cores.hpp"
#include "candidate.hpp"
#include "chance.hpp"

#include <atomic>
#include <deque>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <thread>

namespace quadrant::inline v0::diagnosis {

/// One axis under diagnosis: the record, the described machine and the models tried so far.
class search {
public:
    search(const axis_record& record, const axis_description& axis, exclusions excluded, rules r,
           progress tell);

    const candidate& given() const { return given_; } ///< the machine file as it stands
    /// Its values moved inside the owner's tolerance.
    const candidate& calibrated() const { return calibrated_; }

    /// Residual force of a model on the record it was fitted to [N].
    std::vector<double> residual(const candidate& c) const;
    /// The same with every segment predicted by parameters that were fitted without it.
    std::vector<double> held_out_residual(const candidate& c) const;
    /// Its rms [N].
    double held_out_force(const candidate& c) const;

    /// The segment that holds more than half of what a model leaves, among four or more: something happened in
    /// it that the rest of the record does not show. None: there is no such segment.
    std::optional<std::size_t> odd_segment(const candidate& c) const;
    /// held_out_force() of all segments but this one.
    double held_out_force_beside(const candidate& c, std::size_t segment) const;

    /// Rms of the residual force of a model with the numbers of one of its effects back as described, all
    /// others kept [N].
    double force_without(const candidate& whole, const effect& e) const;
    /// Rms of what one of the effects of a model does to its residual force [N].
    double force_of(const candidate& whole, const effect& e) const;
    /// A model with the numbers of one of its effects back as described, all others kept.
    plant_model plant_without(const candidate& whole, const effect& e) const;

    /// `from` with each of the suspects that it lacks, the most promising after a first look fitted to the end,
    /// the others scored as they stand. What was tried is kept: the same set of effects is not fitted twice.
    std::vector<candidate> with_each(const candidate& from) const { return with_each(from, suspects()); }
    std::vector<candidate> with_each(const candidate& from, const std::vector<const effect*>& among) const;
    /// Whether the time is up (rules.until).
    bool over() const { return rules_.now() >= rules_.until; }
    /// Whether run() ended because the time was up.
    bool cut() const { return cut_; }
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

    /// Whether a cause is a number of the machine file that ends inside the owner's tolerance: that is
    /// calibration.
    bool is_calibration(const candidate& c, const effect* e) const;

    std::vector<const effect*> suspects() const;

    /// `from` with each of the effects that the owner excludes, and would be suspects otherwise: they are never
    /// named, but what explains the record far better than a name speaks against the name.
    std::vector<candidate> with_excluded(const candidate& from) const;

    /// The forms without a name that compete. Along a motion a force that follows the command takes the command
    /// itself away, and would explain every record.
    std::vector<const effect*> forms() const;

    /// The suspects to exchange a cause for that was found on top of `before`; with rules.near_rivals those
    /// only that gained something there, as far as they were tried.
    std::vector<const effect*> relatives(const candidate& before) const;

    /// White noise of the position as a model sees it [m].
    double noise(const candidate& c) const;

    /// Structure that a model leaves in one channel: log-score of its blocks above twice the rms of what it
    /// sees of noise and half a count.
    double structure(const std::vector<double>& ms, const channel& c, double sigma) const;
    /// In all channels: of a model that leaves noise alone it is below rules.structure.
    double structure(const candidate& c, double sigma) const;
    /// Whether a channel holds so little above the noise that nobody would call it a gap: small beside what
    /// machines inside the owner's tolerances leave there.
    bool immaterial(const std::vector<double>& ms, const channel& c, double sigma, std::size_t i) const;
    /// Whether no channel holds more above the noise than machines inside the owner's tolerances differ by
    /// there.
    bool within_tolerances(const std::vector<std::vector<double>>& ms, const scoring& score,
                           double sigma) const;
    bool immaterial(const candidate& c) const;
    /// Whether every channel is at the floor: noise, or nothing that would matter. Of a model on this record
    /// or, with its mean squares there, on another.
    bool settled(const std::vector<std::vector<double>>& ms, const scoring& score, double sigma) const;

    /// The residual force that noise and rounding alone leave [N].
    double floor_force(const candidate& c) const { return floor_force(noise(c)); }
    double floor_force(double noise) const;

    /// Nothing is left to explain, neither in pulses nor as a slow force below the encoder's count.
    bool at_noise(const candidate& c) const;

    bool settled(const candidate& c) const { return settled(c.fit.ms, record_.score, noise(c)); }

    /// What a model leaves is mostly noise. Tolerances excuse what the described machine leaves, not what
    /// causes do.
    bool near_floor(const candidate& c) const { return held_out_force(c) < rules_.near_floor * floor_force(c); }
    /// The same, or what the laws of its friction and of its causes may be wrong by.
    bool near_its_laws(const candidate& c) const;

    /// How far apart machines are that the owner calls the same: mean square, by channel, of the innovations by
    /// which a machine drawn from inside the tolerances differs from the calibrated one on this motion; 19 of
    /// 20 differ less [m^2]. Only what sticks out of that cloud matters to him (docs/formats.md, `tolerance`).
    const std::vector<double>& tolerance_cloud() const;

    /// Adds the effect that predicts held-out motion best, a few ways abreast, until nothing pays; where no
    /// single effect pays on the calibrated machine and something is left, two at once. Returns the calibrated
    /// machine and the models with one cause more each.
    std::vector<candidate> run() const;

    /// The calibrated machine and the models with one cause of `best` more each, the cause that matters most
    /// first. What is no longer needed beside the others is left out.
    std::vector<candidate> path_to(const candidate& best) const;

    /// Of `known` and the models that were tried and score at least `least`, the one that is worth the most, by
    /// more than the margin if it is another one.
    template <class Worth>
    candidate most_worth(const candidate& known, double least, const Worth& worth) const {
        const candidate* best = &known;
        double most = worth(known) + rules_.margin;
        for (const candidate& c : tried_)
            if (std::isfinite(c.total) && c.total > least && !same(c, known) && pays(c, calibrated_))
                if (const double w = worth(c); w > most) {
                    most = w;
                    best = &c;
                }
        return *best;
    }
    /// The most that a model is worth that was tried and has none of these effects, nor one that holds one of
    /// them. Forms without a name hold too much to count, and so little does a model whose score is below
    /// `least`.
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
    plant_model nearest() const;

    /// One more effect earns its place: on held-out motion, by more than a hair, and in newtons.
    bool pays(const candidate& more, const candidate& less) const;
    /// Less is left above the noise of the reading: force on held-out motion, by more than a hair; or, while
    /// that does not grow, half of the innovations of one channel. A drag is small beside the peaks of every
    /// reversal, but not in its own band.
    bool shrinks(const candidate& more, const candidate& less) const;

    /// The path of a loop closed on this model is off by more than those of machines inside the owner's
    /// tolerances are from one another, in one standard deviation. Of a calibrated machine without a cause: it,
    /// or the described one.
    bool differs_from_like_machines(const candidate& c) const;

    static bool has(const candidate& c, const effect* e);
    static bool same(const candidate& a, const candidate& b);
    static bool has_all(const candidate& c, const candidate& of);
    /// The same names but for one, which is another law that holds the one in its place as a part.
    static bool holds(const candidate& more, const candidate& less);

private:
    /// Whether an effect can act on this axis at all.
    bool possible(const effect& e) const;
    /// Whether a number is a gain of velocity loops inside the drive. The force that moves an axis along its
    /// path does not depend on them; only a replay of the logged motion with another gain differs, by far more
    /// than two machines would.
    bool is_of_feedback(const parameter& p) const;
    /// Mean square of a channel above what it sees of the noise [m^2].
    static double left_in(const std::vector<double>& ms, const channel& c, double sigma);
    /// Friction that the laws of a model give at most times: its levels, and what grows with the transmitted
    /// force [N].
    double friction_level(const plant_model& p) const;
    /// Whether a drive with loops of its own leaves this effect a place: what holds, limits or delays a command
    /// is its own, and box `drive`; only a limit of the motor's voltage or force behind a measured duty is not.
    bool beside_drive(const effect& e) const;
    /// Moves the numbers of a model to those of another plant, where the fit goes on.
    static void begin_at(candidate& c, plant_model known);
    /// How many times the looks and finalists of a long record this one affords.
    std::size_t effort() const;
    /// How many models a round fits to the end, at most, of those that a first look found.
    std::size_t most_fitted() const { return rules_.finalists * effort(); }
    /// A model with the numbers of the machine file as they are described. Where calibration stops at the end
    /// of a tolerance, it bent to what a missing effect does, and a fit that begins there may stay there.
    static candidate as_described(candidate c);
    /// Where freeing a number of the machine file does better although it stays inside the tolerance, the fit
    /// of `best` stopped short (a play or a contact makes its score rough): it goes on from there. True: it got
    /// better.
    bool calibrate_again(candidate& best, const std::vector<candidate>& next) const;
    /// Where `step`, which has one effect more, only led the other numbers to a better place, the effect takes
    /// nothing off: `best` goes on from those numbers without it, and what was tried beside it and may have
    /// stopped short of the step is forgotten. True: it got better.
    bool goes_on_without(candidate& best, const candidate& step) const;
    /// use(i, residual force of plant i), one after the other.
    template <class Use>
    void residuals(const std::vector<plant_model>& plants, const Use& use, bool behind_drive = false) const {
        std::array<std::vector<double>, predictor::abreast> e, a;
        for (std::size_t first = 0; first < plants.size(); first += predictor::abreast) {
            const std::size_t n = std::min(plants.size() - first, predictor::abreast);
            record_.observer.run(std::span(plants).subspan(first, n), e, a);
            for (std::size_t i = 0; i < n; ++i)
                use(first + i, residual_of(record_, plants[first + i], a[i], behind_drive));
        }
    }
    /// Residual force without what a drive made otherwise than measured: what effects of the mechanics look at.
    std::vector<double> residual_behind_drive(const candidate& c) const;
    static double square(double x) { return x * x; }
    static double mean_of(const std::vector<double>& x);
    /// The calibrated machine with two and more of the everyday effects: one alone may take what two of them
    /// make.
    std::vector<candidate> everyday() const;
    static constexpr std::size_t least_segments = 4; ///< of which one may be set apart
    /// Energy of the residual force on held-out motion in each segment [N^2, times rows].
    std::vector<double> energy_by_segment(const candidate& c) const;
    /// Whether the residual force falls in three of four segments. A transient that no name explains, such as a
    /// start, may hold most of the residual and hide what the rest of the record shows.
    bool shrinks_in_most_segments(const candidate& more, const candidate& less) const;
    /// A model with one of its effects taken off, not fitted again: the others keep their numbers, and what the
    /// effect had moved in the machine file is as described.
    candidate taken_off(const candidate& whole, const effect* own) const;
    /// Whether a number of a model is one of the description that its tolerance lets move, and none of a name.
    bool is_calibrated(const parameter& p) const;
    /// The best of these that pays, after sorting them; null: none does.
    const candidate* paying(std::vector<candidate>& next, const candidate& best) const;
    static candidate joined(const candidate& from, const effect* added);
    /// The fit of the calibrated machine and this effect alone, where that pays. Beside another cause the same
    /// numbers are a good start: Newton's step from the machine file's may be stopped by friction that sticks.
    const fit_result* found_alone(const effect& e) const;
    /// What happens to a model whose turn comes when the time is up.
    enum class when_late { go_on, leave_out };
    /// A first look at each of these: `from` and the effect that it names last.
    void sketch_each(const candidate& from, const std::vector<std::size_t>& which,
                     std::vector<candidate>& models, when_late how) const;
    /// Of these sketches the most promising fitted to the end, the others scored as they stand; sorted by
    /// promise.
    void finish_best(std::vector<std::size_t>& which, std::size_t most, std::vector<candidate>& models,
                     when_late how) const;
    /// use(a few of these), on all cores. The same few whatever the number of cores, so that the result is the
    /// same.
    template <class Use>
    void in_groups(std::span<const std::size_t> which, std::size_t size, const Use& use) const {
        on_all_cores((which.size() + size - 1) / size, rules_.threads, [&](std::size_t group) {
            const std::size_t first = group * size;
            use(which.subspan(first, std::min(size, which.size() - first)));
        });
    }
    /// The same, with what it does of a round: `each` of its looks for every model.
    template <class Use>
    void in_groups(std::span<const std::size_t> which, std::size_t size, const Use& use, double each,
                   const std::vector<candidate>& models) const {
        const auto caller = std::this_thread::get_id();
        const double before = looks_;
        std::atomic<std::size_t> done = 0;
        in_groups(which, size, [&](std::span<const std::size_t> some) {
            use(some);
            const std::size_t all = done += some.size();
            if (std::this_thread::get_id() != caller) return;
            looks_ = before + each * static_cast<double>(all);
            says("trying " + names_of(some, models));
        });
        looks_ = before + each * static_cast<double>(which.size());
    }
    void says(const std::string& line) const;
    /// What is added in each of these.
    static std::string names_of(std::span<const std::size_t> some, const std::vector<candidate>& models);
    /// Of the sketches behind the first `fitted` those fitted to the end that come near the best already.
    void finish_near(const std::vector<std::size_t>& which, std::size_t fitted, const candidate& from,
                     std::vector<candidate>& models) const;
    /// A model that scores worse than one of its parts stopped short: it is fitted again with what that part
    /// lacks, from the part's numbers; all of these side by side. `from`: where their own fits began.
    void mend_from_parts(std::vector<candidate>& models, const std::vector<std::size_t>& which,
                         const candidate& from) const;
    const candidate* tried(const candidate& from, const effect* added) const;
    std::string describe(const candidate& c) const;

    const axis_record& record_;
    const axis_description& axis_;
    exclusions excluded_;
    rules rules_;
    mutable progress tell_;
    mutable double looks_ = 0, looks_of_a_round_ = 1; ///< done of this part of the work
    mutable std::optional<double> rounds_{};          ///< of it, at most
    candidate given_;
    mutable candidate calibrated_; ///< a step of the search may show where its fit stopped short
    mutable std::deque<candidate> tried_;
    /// A model with one effect less that was fitted from the numbers of another one.
    struct shorter {
        std::shared_ptr<std::optional<double>> of; ///< of that one: what copies of it share
        const effect* own;
        candidate model;
    };
    mutable std::vector<shorter> shorter_{};
    mutable std::set<const effect*> missed_{};
    mutable bool cut_ = false;
    mutable std::vector<double> cloud_{};            ///< found when it is asked for
    mutable std::optional<double> floor_of_noise_{}; ///< residual force of a white noise of 1 m [N], likewise
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "search.ipp"
#endif
