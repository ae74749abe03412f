// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/log.hpp"
#include "../log/signals.hpp"
#include "command_noise.hpp"
#include "drive_noise.hpp"
#include "fit.hpp"
#include "gap_rows.hpp"
#include "residual_force.hpp"
#include "scales.hpp"

namespace quadrant::inline v0::diagnosis {

/// One axis of one log, made ready for the fits: motion segments, score, smoothed motion.
struct axis_record {
    double period = 0;
    std::span<const double> reference{}, position{}, command{};
    std::vector<double> velocity{}, acceleration{}; ///< zero-phase, at the corner of `scale` [m/s], [m/s^2]
    std::vector<std::size_t> segment{};             ///< motion segment of every row
    std::size_t segments = 0;
    std::vector<unsigned char>
        left_out{};          ///< of every row: 1 where the residual force says nothing; empty: none
    double bandwidth_Hz = 0; ///< of the residual force
    double resolution = 0;   ///< step of the position, at least the rounding of its column [m]
    record_scales scale{};   ///< what is long, fast and strong here
    /// Force that a drive's replay makes of one wrong reading, see reaction_to_reading() [N/m]; empty: the
    /// command is logged.
    std::vector<double> reaction{};
    double command_noise =
        0; ///< white noise of a measured command, as it stands in the residual force: rms [N]
    /// Where something was measured behind the drive: when it and the position were read here, as the described
    /// drive has it best, see driven_motion::timing().
    reading_times read{};
    std::optional<tap_reading> tap{}; ///< how it was read; none: the described machine, calibrated, decides
    predictor observer;
    scoring score{};

    /// Whether the residual force says something in a row.
    bool counts(std::size_t row) const { return left_out.empty() || !left_out[row]; }
    /// Whether the force is what a drive's replay makes of the logged motion. Its gains have tolerances in one
    /// ratio,
    /// which a fit bends together to what a missing effect does: such a record is searched from the described
    /// numbers, too, with more looks where it is short, and its hold-out log has a say in the search. For
    /// logged
    /// commands these did not prove better: on records whose rest has no name they lost names that are known.
    bool replayed() const { return observer.drive != nullptr; }
    /// Whether the force that the velocity loop of such a drive gives was measured.
    bool taps_force(const drive_model& d) const {
        return observer.drive && observer.drive->tapped() && d.kind != drive_kind::position_servo;
    }
    /// Whether the drive's loops are closed on the model, so that its path is judged.
    bool closed() const { return observer.closed.has_value(); }
    /// The noise of a measured command in forces up to this frequency [N].
    double command_noise_below(double band_Hz) const {
        if (command_noise == 0) return 0;
        return command_noise * white_noise_below(band_Hz, period) / white_noise_below(bandwidth_Hz, period);
    }
};

/// Rows where one motion ends and the next begins: the velocity of the reference changes sign, starts or stops.
/// Segments are at least five blocks long and at most thirty; they, not samples, are left out and resampled,
/// because the samples inside one motion say the same thing again and again.
QUADRANT_DIAGNOSIS_DECL std::vector<std::size_t> motion_segments(std::span<const double> motion, double period,
                                                                 const record_scales& scale);

/// The same of a record: with what the replay of its drive makes of that noise, and the noise of a measured
/// command.
QUADRANT_DIAGNOSIS_DECL double force_floor(const axis_record& r, double mass, double sigma);

/// White noise of the position in the innovations of a model, robust against what the model does not explain;
/// not below the rounding of `resolution` [m].
QUADRANT_DIAGNOSIS_DECL double position_noise(const std::vector<double>& innovation, const scoring& s,
                                              double resolution);

/// How finely a period is simulated: the springs of a described contact turn by a tenth of a radian at most in
/// a sub-step, in ten at most. A contact of one spring, which stands for what no record shows, needs none.
QUADRANT_DIAGNOSIS_DECL std::size_t substeps_of(const plant_model& described, double period);

/// residual_force() of a model on a record. Where something was measured behind the drive, what this drive
/// would have made otherwise is part of it, unless only what lies behind the drive is asked for.
QUADRANT_DIAGNOSIS_DECL std::vector<double> residual_of(const axis_record& r, const plant_model& plant,
                                                        std::span<const double> model_acceleration,
                                                        bool behind_drive = false);

/// Rms of a residual force over the rows that say something.
QUADRANT_DIAGNOSIS_DECL double rms_judged(const axis_record& r, const std::vector<double>& residual);

/// The smoothed motion of a record for plants to be led along. It counts where the axis surely moves, by three
/// counts within the response of the observer, and where the record says something.
QUADRANT_DIAGNOSIS_DECL std::shared_ptr<const led_motion> motion_to_lead(const axis_record& r,
                                                                         const plant_model& described);

/// `scale`: of this log, or of the one that it is compared with.
QUADRANT_DIAGNOSIS_DECL axis_record prepare(const axis_log& log, double period, double resolution,
                                            const record_scales& scale);

/// How models are held to a record: corrected by its readings, led along its motion, or with the drive's loops
/// closed on them and nothing but their path compared.
enum class held_by { readings, motion, loop };

/// Whether a plant forgets its velocity by its own damping before the corrections of the readings end.
inline bool forgets_within_the_response(const plant_model& p, const axis_record& r) {
    return p.friction.viscous_slope * r.scale.response() > p.moving_mass();
}

/// Rows after which a signal has forgotten itself, for its mean square: sum of the squared correlation of its
/// rows, up to where they are opposite for the first time.
QUADRANT_DIAGNOSIS_DECL double rows_of_memory(std::span<const double> e);

/// How far a drive's loop is moved by what no law of the described friction is right to [m].
QUADRANT_DIAGNOSIS_DECL double path_of_law_error(const axis_record& r, const plant_model& described);

/// One channel for the path of a closed loop: in blocks of five memories of what the described machine or the
/// nearest model leaves, the shorter one, at most a fifth of the record, each worth as many readings as it has
/// memories. What a corrected model leaves repeats itself from channel to channel; this does not, and counts in
/// full.
QUADRANT_DIAGNOSIS_DECL void judge_path(axis_record& r, const plant_model& described,
                                        const plant_model& nearest);

/// Judges a record that models are led along beside what the known ones leave: the floor of each channel is
/// what half of the blocks stay below with the model that leaves least in it. The model that leaves least of
/// the forces in all may leave more in a channel than another one, whose gain there would not count. Where
/// forces act that no name explains, a quiet block is one that they happen to miss; without the floor it would
/// count as much as a loud one, and a fit would polish it at the expense of the rest. Without a known model
/// nothing changes.
QUADRANT_DIAGNOSIS_DECL void judge_beside_what_is_left(axis_record& r, std::span<const plant_model> known);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "record.ipp"
#endif
