// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/rules.hpp"
#include "../log/signals.hpp"
#include "candidate.hpp"

#include <array>
#include <numeric>
#include <optional>
#include <span>

namespace quadrant::inline v0::diagnosis {

namespace detail {
/// The way in which the tap is read with which this machine, its `own` numbers fitted, gives least otherwise:
/// by the median over the rows, which an effect in a part of them moves little, below `band_Hz`.
QUADRANT_DIAGNOSIS_DECL tap_reading best_tap(const fitter& fit, const driven_motion& drive,
                                             plant_model described, const std::vector<parameter>& own,
                                             double band_Hz);
} // namespace detail

/// The described machine on the record of one axis, calibrated inside the owner's tolerance; and what a model
/// leaves of that record.
class axis_models {
public:
    const candidate& given() const { return given_; } ///< the machine file as it stands
    /// Its values moved inside the owner's tolerance.
    const candidate& calibrated() const { return calibrated_; }

    /// Residual force of a model on the record it was fitted to [N].
    std::vector<double> residual(const candidate& c) const;
    /// The same with every segment predicted by parameters that were fitted without it.
    std::vector<double> held_out_residual(const candidate& c) const;
    /// Its rms [N].
    double held_out_force(const candidate& c) const;

    /// The same as the described mass would feel it. What models leave are accelerations: each times its own
    /// mass, the lighter of two would leave less of the same.
    double held_out_force_of_described_mass(const candidate& c) const;

    /// The segment that holds more than half of what a model leaves, among four or more: something happened in
    /// it that the rest of the record does not show. None: there is no such segment.
    std::optional<std::size_t> odd_segment(const candidate& c) const;
    /// held_out_force() of all segments but this one.
    double held_out_force_beside(const candidate& c, std::size_t segment) const;

    /// Rms of the residual force of a model with the numbers of one of its effects back as described, all
    /// others kept [N].
    double force_without(const candidate& whole, const effect& e) const;
    /// What one of the effects of a model does to its residual force [N].
    std::vector<double> does(const candidate& whole, const effect& e) const;
    /// A model with the numbers of one of its effects back as described, all others kept.
    plant_model plant_without(const candidate& whole, const effect& e) const;

    static bool has(const candidate& c, const effect* e);
    static bool same(const candidate& a, const candidate& b);
    static bool has_all(const candidate& c, const candidate& of);
    /// The same names but for one, which is another law that holds the one in its place as a part.
    static bool holds(const candidate& more, const candidate& less);

protected:
    axis_models(const axis_record& record, const axis_description& axis, const rules& r);
    axis_models(const axis_models&) = default;

    /// Whether a number of a model is one of the description that its tolerance lets move, and none of a name.
    bool is_calibrated(const parameter& p) const;
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
    static double mean_of(const std::vector<double>& x);
    static constexpr std::size_t least_segments = 4; ///< of which one may be set apart
    /// Energy of the residual force on held-out motion in each segment [N^2, times rows].
    std::vector<double> energy_by_segment(const candidate& c) const;

    const axis_record& record_;
    const axis_description& axis_;
    rules rules_;
    candidate given_;
    mutable candidate calibrated_; ///< a step of the search may show where its fit stopped short
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "axis_models.ipp"
#endif
