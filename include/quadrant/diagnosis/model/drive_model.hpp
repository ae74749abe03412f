// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../drive/position_loop.hpp"
#include "../../drive/position_servo.hpp"
#include "../machine/drive_description.hpp"

#include <memory>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// How what is measured behind a drive belongs to its row: read as the row begins, before or after the drive
/// takes a set-point that arrives just then, or the mean over the row, as drives filter what they report.
enum class tap_reading { before_set_point, after_set_point, row_mean };

/// When the registers of a drive were read for a row of the log, which no file can know.
struct reading_times {
    double age = 0; ///< of the position beside what the drive received and what was measured behind it [s]
    /// How long before what is measured behind the drive was read the drive took the set-point of its row,
    /// beside its delay: registers are read before or after the goal is written [s].
    double tap_lateness = 0;
    tap_reading tap = tap_reading::before_set_point; ///< of a drive with a velocity loop

    bool operator==(const reading_times&) const = default;
};

/// The set-points of one record that a drive acted on, when it lost some.
struct received_set_points {
    std::vector<double> values; ///< one a row
    double choices = 0;         ///< what it takes to say which were lost [nats], see lossy_commands
};

/// The drive of a plant model: the numbers that a fit may move, neutral where nothing is described. SI, in the
/// words of a linear axis.
struct drive_model {
    static constexpr double none = std::numeric_limits<double>::infinity();

    drive_kind kind = drive_kind::current;
    interpolation between = interpolation::hold;
    double set_point_period = 0; ///< [s]; 0: the sample period
    double delay = 0;            ///< [s]
    double loss = 0;             ///< probability of a set-point
    double clock_slip =
        0; ///< the drive's clock takes this share longer for a period than the controller's; signed
    /// In this part of the record the drive gives nothing [s]; not after it: always on. No file can know it.
    double off_from = 0, off_until = 0;
    double velocity_per_V = 1, velocity_gain = 0, velocity_integral = 0, velocity_filter_Hz = none;
    double force_limit = none; ///< [N]
    double position_gain = 0;  ///< [1/s]
    double velocity_feedforward = 0;
    double duty_gain = 0, minimum_duty = 0, maximum_duty = 1, rate_limit = none; ///< duty a [m]; [m/s]
    double supply = 1;                                                           ///< [V]
    double start_force = 0; ///< of the velocity loop's integral at the first row, which no file can know [N]

    reading_times read{};
    /// Null: every set-point as it was sent, or what `loss` does to it on average.
    std::shared_ptr<const received_set_points> received{};

    drive_model() = default;
    explicit drive_model(const drive_description& d)
        : kind(d.kind), between(d.between.value_or(interpolation::hold)),
          set_point_period(d.set_point_period_s.value_or(0)), delay(d.command_delay_s.value_or(0)),
          loss(d.set_point_loss.value_or(0)), clock_slip(d.clock_slip.value_or(0)),
          velocity_per_V(d.velocity_per_V.value_or(1)), velocity_gain(d.velocity_gain_N_s_per_m.value_or(0)),
          velocity_integral(d.velocity_integral_N_per_m.value_or(0)),
          velocity_filter_Hz(d.velocity_filter_Hz.value_or(none)), force_limit(d.force_limit_N.value_or(none)),
          position_gain(d.position_gain_per_s.value_or(0)),
          velocity_feedforward(d.velocity_feedforward.value_or(0)),
          duty_gain(d.position_gain_per_m.value_or(0)), minimum_duty(d.minimum_duty.value_or(0)),
          maximum_duty(d.maximum_duty.value_or(1)), rate_limit(d.setpoint_rate_limit_m_per_s.value_or(none)),
          supply(d.supply_V.value_or(1)) {}

    bool operator==(const drive_model&) const = default;
    /// Whether it is known which set-points were lost.
    bool losses_known() const { return received && loss > 0; }
    bool closes() const { return kind != drive_kind::current; }
    bool has_velocity_loop() const { return kind == drive_kind::velocity || kind == drive_kind::position; }
    /// Whether its registers are read one after another; other drives take all readings of a row at once.
    bool reads_in_turn() const { return kind == drive_kind::position_servo; }
    /// Whether the velocity loop remembers a force that no row shows.
    bool has_integral() const { return has_velocity_loop() && velocity_integral > 0; }

    position_loop<>::parameters position_loop_numbers() const {
        return {.gain = position_gain,
                .velocity_feedforward = velocity_feedforward,
                .velocity = {.gain = velocity_gain,
                             .integral = velocity_integral,
                             .filter_Hz = velocity_filter_Hz,
                             .limit = force_limit}};
    }
    position_servo<>::parameters servo_numbers() const {
        return {.gain = duty_gain, .minimum = minimum_duty, .maximum = maximum_duty, .rate = rate_limit};
    }
};

} // namespace quadrant::inline v0::diagnosis
