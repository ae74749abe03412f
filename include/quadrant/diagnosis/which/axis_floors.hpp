// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_models.hpp"
#include "chance.hpp"
#include "like_machines.hpp"

namespace quadrant::inline v0::diagnosis {

/// How little a model may leave before nothing is left to explain: noise, what machines inside the owner's
/// tolerances differ by, what a law of friction is wrong by; and whether one more effect earns its place above
/// that.
class axis_floors : public axis_models {
public:
    /// Whether every number of a cause that the owner has a tolerance for ends inside it, and an angle is as
    /// described: that is calibration.
    bool is_calibration(const candidate& c, const effect* e) const;

    /// White noise of the position as a model sees it [m].
    double noise(const candidate& c) const;

    /// Mean square that a model leaves in a channel above what that sees of the noise [m^2]; chance may make it
    /// negative.
    static double left_in(const std::vector<double>& ms, const channel& c, double sigma);
    /// Structure that a model leaves in one channel: log-score of its blocks above twice the rms of what it
    /// sees of noise and half a count.
    double structure(const std::vector<double>& ms, const channel& c, double sigma) const;
    /// In all channels: of a model that leaves noise alone it is below rules.structure.
    double structure(const candidate& c, double sigma) const;
    /// Whether a channel holds so little above the noise that nobody would call it a gap: small beside what
    /// machines inside the owner's tolerances leave there, which is the channel's entry in the `cloud`.
    bool immaterial(const std::vector<double>& ms, const channel& c, double sigma, double cloud) const;
    bool immaterial(const candidate& c) const;
    /// Whether no channel holds more above the noise than machines inside the owner's tolerances differ by
    /// there.
    static bool within_tolerances(const std::vector<std::vector<double>>& ms, const scoring& score,
                                  const std::vector<double>& cloud, double sigma);
    /// Whether every channel is at the floor: noise, or nothing that would matter. `cloud()`: of the record
    /// that these mean squares are of, asked for where something is left.
    template <class Cloud>
    bool settled(const std::vector<std::vector<double>>& ms, const scoring& score, double sigma,
                 const Cloud& cloud) const {
        for (std::size_t i = 0; i < ms.size(); ++i)
            if (structure(ms[i], score.channels[i], sigma) >= rules_.structure &&
                !immaterial(ms[i], score.channels[i], sigma, cloud()[i]))
                return false;
        return true;
    }

    /// The residual force that noise and rounding alone leave of a model [N]: the larger, the heavier it is.
    double floor_force(const candidate& c) const;
    double floor_force(double mass, double noise) const;
    /// The same beside held_out_force_of_described_mass().
    double floor_force_of_described_mass(const candidate& c) const;

    /// Nothing is left to explain, neither in pulses nor as a slow force below the encoder's count.
    bool at_noise(const candidate& c) const;

    /// The same on this record.
    bool settled(const std::vector<std::vector<double>>& ms, double sigma) const;
    bool settled(const candidate& c) const { return settled(c.fit.ms, noise(c)); }

    /// What a model leaves is mostly noise. Tolerances excuse what the described machine leaves, not what
    /// causes do.
    bool near_floor(const candidate& c) const { return held_out_force(c) < rules_.near_floor * floor_force(c); }
    /// The same, or what the laws of its friction and of its causes may be wrong by.
    bool near_its_laws(const candidate& c) const;

    /// How far apart machines are that the owner calls the same, see cloud_of_like_machines(). Only what sticks
    /// out of that cloud matters to him (docs/formats.md, `tolerance`).
    const std::vector<double>& tolerance_cloud() const;
    /// The same on another record, on which the calibrated machine begins like this.
    std::vector<double> tolerance_cloud(const axis_record& r, const plant_model& calibrated) const;

    /// One more effect earns its place: on held-out motion, by more than a hair, and in newtons.
    bool pays(const candidate& more, const candidate& less) const;
    /// Less is left above the noise of the reading: force on held-out motion, by more than a hair; or, while
    /// that does not grow, half of the innovations of one channel. A drag is small beside the peaks of every
    /// reversal, but not in its own band.
    bool shrinks(const candidate& more, const candidate& less) const;

    /// Whether the path of a loop closed on this model is further off than paths of machines inside the owner's
    /// tolerances differ by (one standard deviation), or what was measured behind the drive is, its noise taken
    /// off (two). Of a calibrated machine without a cause: it, or the described one.
    bool differs_from_like_machines(const candidate& c) const;

protected:
    using axis_models::axis_models;

    /// Whether an angle that has no tolerance is another one than in the file, by more than an unstated one.
    static bool is_another_angle(const key_value& found, const key_value& described);
    /// Whether every harmonic of a wave ends inside its tolerance, and no other was found.
    bool is_calibration_of_wave(plant_model& fitted, const effect& e) const;

    /// Friction that the laws of a model give at most times: its levels, and what grows with the transmitted
    /// force [N].
    double friction_level(const plant_model& p) const;
    /// Whether half of what stands above the noise in a channel goes.
    bool shrinks_in(std::size_t channel, const candidate& more, const candidate& less) const;
    /// The same in one of what was measured behind the drive.
    bool shrinks_behind_drive(const candidate& more, const candidate& less) const;
    /// Whether the residual force falls in three of four segments. A transient that no name explains, such as a
    /// start, may hold most of the residual and hide what the rest of the record shows.
    bool shrinks_in_most_segments(const candidate& more, const candidate& less) const;

    mutable std::vector<double> cloud_{};           ///< found when it is asked for
    mutable std::vector<double> cloud_of_fitted_{}; ///< likewise
    mutable std::optional<force_floors> floors_{};  ///< likewise
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "axis_floors.ipp"
#endif
