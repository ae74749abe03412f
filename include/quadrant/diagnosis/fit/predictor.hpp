// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "../model/as_reading.hpp"
#include "../model/driven_motion.hpp"
#include "../model/sample_loss.hpp"
#include "led_motion.hpp"
#include "pass.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// The passes to use: those of this translation unit's instruction set; in a program that has more of them,
/// those of the best set that the processor has.
QUADRANT_DIAGNOSIS_DECL const pass_table& passes();

/// Second difference of a reading around each row, without what a plant's encoder adds to it, over the square
/// of the period [m/s^2]; 0 at both ends.
QUADRANT_DIAGNOSIS_DECL std::vector<double> acceleration_of(const plant_model& plant,
                                                            std::span<const double> position, double period);

/// The plant inside an observer: driven by the logged command, corrected by the logged position, evaluated on
/// what the correction had to be. One pass, no drift of the double integrator, and a right model leaves only
/// the encoder's
/// rounding: the innovation
///   e[k] = y[k] - reading(x(t_k));  x += L1 e, v += L2 e;  then one period of the plant
/// with both observer poles at z = exp(-2 pi corner T): L1 = 1 - z^2, L2 = (1 - z)^2 / T [Franklin1998] ch. 8.
/// A constant force error d shows as e = d T^2 / (M (1 - z)^2), which is d / (M (2 pi corner)^2) when T is
/// short.
struct predictor {
    /// e'[k] = e[k] - e[k-1] + pole e'[k-1]: makes a drift of independent steps a signal of one size.
    static void take_drift_out(std::vector<double>& e, double pole);

    /// Plants in the lanes of one number, at most.
    static constexpr std::size_t in_a_group = 8;
    /// Plants in one pass: two groups that take turns. One alone waits most of its time for its own last step.
    static constexpr std::size_t abreast = 2 * in_a_group;
    double period;    ///< T [s]
    double corner_Hz; ///< lower: more sensitive to slow forces; higher: friction's sign is surer at creep
    std::span<const double> position, command;
    std::span<const double> other_acceleration{}; ///< of the axis that may be coupled [m/s^2]; empty: none
    double resolution = 0;                        ///< step of the position [m]
    std::size_t substeps = 1;                     ///< of a period, see substeps_of()
    const driven_motion* drive =
        nullptr; ///< of a drive with loops of its own; null: `command` is the actuator's
    /// Null: the plant is corrected by the readings. Else it is led along this motion, and the innovations are
    /// those that the forces which this motion does not need would make of a free mass. An observer lets a
    /// model stand, or creep behind a stiff damping, where a light machine moves slowly under forces that the
    /// model
    /// does not have: the corrections carry it, and little shows in them. No state of a led plant takes part.
    std::shared_ptr<const led_motion> led{};
    /// None: a drive's law is replayed on the logged motion. Else its loops are closed on the plant, which
    /// nothing corrects, and which starts at this velocity [m/s]: the innovations are what is between its path
    /// and the logged one. For a drive that takes positions, where nothing drifts: a force that acts for long
    /// shows in full, and the friction holds what it holds on the machine.
    std::optional<double> closed{};
    double drift_pole =
        1; ///< of the filter that takes the drift of a drive's integral out, see drift_pole_of(); 1: none

    /// Innovations; lost commands are found, and counted, by what they leave in them. Returns the information
    /// cost [nats] of choosing the lost samples from the log, 0 without lost commands. When `acceleration` is
    /// given, also the second difference of the model's positions around each row, over the square of the
    /// period [m/s^2].
    double run(const plant_model& plant, std::vector<double>& innovation,
               std::vector<double>* acceleration = nullptr) const;
    /// The same for several plants, some at a time side by side: a third of the time and less. One list of
    /// innovations a plant, of accelerations where they are asked for, and of choices likewise. Plants with the
    /// same joints share lanes, which all pay for what one of them has.
    void run(std::span<const plant_model> plants, std::span<std::vector<double>> innovation,
             std::span<std::vector<double>> acceleration = {}, std::span<double> choices = {}) const;

    /// What the forces on each plant leave when it is led along a motion, in units of the command times the
    /// described force constant [N]; 0 where that motion does not count. At most `abreast` plants.
    void forces_beside(const led_motion& by, std::span<const plant_model> plants, std::span<const double> u,
                       std::span<std::vector<double>> left) const;

    /// Rows of the innovations: those of the position, and behind them, where something was measured behind the
    /// drive, what the drive gives otherwise.
    std::size_t rows() const { return position.size() * (drive && drive->tapped() ? 2 : 1); }

    /// What this drive gives otherwise than was measured behind it, at the rows, as what it says of the reading
    /// of the position [m].
    std::vector<double> beside_tap(const drive_model& d, std::vector<double> beside) const;

    /// Both poles of the observer.
    double pole() const { return std::exp(-2 * std::numbers::pi * corner_Hz * period); }

    /// The commands that the drive acted on when it lost some, as the innovations of `plant` without a loss
    /// show it.
    lossy_commands commands_with_loss(const plant_model& plant, const std::vector<double>& innovation,
                                      const loss_assumption& a) const;
    /// The same of the set-points of a drive with loops of its own: a lost one repeats the one before. `plant`
    /// loses none. What a lost set-point does is looked up in the model, at the largest steps of this record.
    lossy_commands set_points_with_loss(const plant_model& plant, const std::vector<double>& innovation,
                                        const loss_assumption& a) const;
    /// The set-points that the drive of this plant received of those of this record.
    std::shared_ptr<const received_set_points> received(const plant_model& plant) const;

private:
    /// Which joints of a plant take time, one bit each, those that take most first.
    unsigned joints_of(const plant_model& p) const;
    /// How a pass is corrected: the position that leads it, its gains, and how much heavier the plants are.
    struct guidance {
        const double* position;
        double to_position, to_velocity, heavier;
    };
    /// Innovations of a free mass on which these forces act, and the accelerations that say the same.
    void pass_led(std::span<const plant_model> plants, std::span<const double> u,
                  std::span<std::vector<double>> innovation, std::vector<double>* acceleration) const;
    /// The logged path beside that of each plant with its drive's loops closed on it; accelerations as where
    /// the readings correct it.
    void pass_closed(std::span<const plant_model> plants, std::span<const double> u,
                     std::span<std::vector<double>> innovation, std::vector<double>* acceleration) const;
    std::size_t whole_periods(double delay) const;
    double l1() const { return 1 - pole() * pole(); }
    double l2() const { return (1 - pole()) * (1 - pole()) / period; }

    /// Innovations after one volt too much in one period, on a free axis, until the observer has forgotten it.
    std::vector<double> loss_response(const plant_model& plant) const;

    /// The same record with other set-points.
    predictor on(const driven_motion& other) const {
        predictor out = *this;
        out.drive = &other;
        return out;
    }

    /// The command of each plant's actuator, and its innovations behind the drive. Plants with one drive share
    /// its replay.
    void drive_each(std::span<const plant_model> plants, std::array<std::vector<double>, abreast>& own,
                    std::array<const double*, abreast>& command_of,
                    std::span<std::vector<double>> innovation) const;

    /// Several plants side by side in the lanes of one number.
    void pass(std::span<const plant_model> plants, std::span<const double> u,
              std::span<std::vector<double>> innovation, std::vector<double>* acceleration) const;
    void pass(std::span<const plant_model> plants, std::span<const double> u,
              std::span<std::vector<double>> innovation, std::vector<double>* acceleration,
              const guidance& by) const;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "closed_pass.ipp"
#    include "led_motion.ipp"
#    include "lost_set_points.ipp"
#    include "predictor.ipp"
#endif
