// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/on_all_cores.hpp"
#include "../text/progress.hpp"
#include "axis_floors.hpp"
#include "first_look.hpp"
#include "promising.hpp"

#include <atomic>
#include <deque>
#include <thread>

namespace quadrant::inline v0::diagnosis {

/// Fits of models that have one effect more than another, side by side: a first look at all of them, the most
/// promising to the end. Remembers what was fitted, and tells how far it is.
class model_fits : public axis_floors {
public:
    /// Whether the time is up (rules.until).
    bool over() const { return rules_.now() >= rules_.until; }

protected:
    model_fits(const axis_record& record, const axis_description& axis, const rules& r, progress tell)
        : axis_floors(record, axis, r), tell_(std::move(tell)) {}

    /// Moves the numbers of a model to those of another plant, where the fit goes on.
    static void begin_at(candidate& c, plant_model known);
    /// By which factor a short record may have more looks and finalists than a long one.
    std::size_t effort() const;
    /// From each start.
    int steps_of_a_look() const {
        return rules_.first_look * static_cast<int>(std::min<std::size_t>(effort(), 4));
    }
    /// How many models a round fits to the end, at most, of those that a first look found.
    std::size_t most_fitted() const { return rules_.finalists * effort(); }
    /// A model with the numbers of the machine file as they are described. Where calibration stops at the end
    /// of a tolerance, it bent to what a missing effect does, and a fit that begins there may stay there:
    /// beside a drive's loops that of the number itself.
    static candidate as_described(candidate c);
    static candidate joined(const candidate& from, const effect* added);
    /// The calibrated machine and this effect alone, where that was tried and pays; else null.
    const candidate* alone(const effect& e) const;
    /// What happens to a model whose turn comes when the time is up.
    enum class when_late { go_on, leave_out };
    /// Where a first look at one more effect begins.
    enum class begins_at { every_start, where_alone };
    /// A first look at each of these: `from` and the effect that it names last.
    void sketch_each(const candidate& from, const std::vector<std::size_t>& which,
                     std::vector<candidate>& models, when_late how,
                     begins_at start = begins_at::every_start) const;
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
    /// Of the sketches behind the first `fitted` those fitted to the end that come near the best already, and
    /// beside a drive's loops those of a number at whose tolerance calibration stops.
    void finish_near(const std::vector<std::size_t>& which, std::size_t fitted, const candidate& from,
                     std::vector<candidate>& models) const;
    /// Whether a number of a model ends at the upper end of its search short of where one of the model's parts
    /// found it. How far a number is searched follows from the force that is left where it is added; beside a
    /// cause that had taken most of its force, that says too little.
    static bool ends_short_of(const candidate& c, const candidate& part);
    /// A model that scores worse than one of its parts stopped short, or whose search ended short of what that
    /// part found: it is fitted again with what the part lacks, from the part's numbers. All of these are
    /// sketched one after the other and fitted side by side. `from`: where their own fits began.
    void mend_from_parts(std::vector<candidate>& models, const std::vector<std::size_t>& which,
                         const candidate& from) const;

    /// Whether calibration stops at the end of the tolerance of the number that this effect frees: the number
    /// is beyond it.
    static bool is_beyond_tolerance(const candidate& c, const effect& e);
    /// Where a number beyond its tolerance brings less than half beside another cause of what it brings alone,
    /// the fit stopped short: friction that sticks lets no small step of it do better. It is fitted again from
    /// where it was found alone; the best few of these side by side.
    void mend_from_alone(std::vector<candidate>& models, const std::vector<std::size_t>& which,
                         const candidate& from) const;
    const candidate* tried(const candidate& from, const effect* added) const;
    std::string describe(const candidate& c) const;

    /// CPU of fitting a model to the end and testing it, in first looks (measured on the practice logs).
    static constexpr double looks_of_a_fit = 3;

    mutable progress tell_;
    mutable double looks_ = 0, looks_of_a_round_ = 1; ///< done of this part of the work
    mutable std::optional<double> rounds_{};          ///< of it, at most
    mutable std::deque<candidate> tried_;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "model_fits.ipp"
#endif
