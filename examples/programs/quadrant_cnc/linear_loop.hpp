// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "acceleration_loop.hpp"
#include "drive_side.hpp"

#include <quadrant/analysis/impulse_test.hpp>
#include <quadrant/diagnosis/where/controller_box.hpp>

/// Axes of the virtual machine as an analysis takes them.
namespace quadrant_cnc {

/// The axis without what has no frequency response: friction but the viscous one, play, steps and noise of the
/// sensors, limits, converter, and the friction that its law feeds forward.
inline axis_description linear_part(axis_description a) {
    if (auto* on_screw = std::get_if<ball_screw_description>(&a.drive)) {
        for (friction_side* side : {&on_screw->forward, &on_screw->backward}) side->static_Nm = side->coulomb_Nm = 0;
        on_screw->backlash_m = 0;
        on_screw->current_limit_A.reset();
    } else {
        auto& motor = std::get<linear_motor_description>(a.drive);
        motor.coulomb_N = 0;
        motor.static_N.reset();
        motor.stribeck_velocity_m_per_s.reset();
        motor.drive_limit_V.reset();
    }
    a.sensor.resolution_m = a.sensor.noise_m = a.sensor.tachometer_noise_m_per_s = 0;
    a.sensor.accelerometer_noise_m_per_s2 = 0;
    a.command = {.limit_V = unlimited, .dac_bits = {}, .dac_range_V = {}};
    if (a.law.values.contains("friction.scale")) a.law.set("friction.scale", 0);
    return a;
}

/// Which position of an axis is looked at.
enum class seen { at_table, by_encoder };

/// One axis in closed loop, whatever its drive and its law (quadrant::analysis::running_loop).
class axis_loop {
public:
    axis_loop(const axis_description& a, double period, std::uint64_t seed, seen where = seen::at_table)
        : drive_(std::visit([&](const auto& d) { return make_drive(d, a.sensor, period, seed); }, a.drive)),
          control_(quadrant::diagnosis::made(a.law,
                                             {.limit_V = a.command.limit_V,
                                              .dac_bits = a.command.dac_bits,
                                              .dac_range_V = a.command.dac_range_V},
                                             period)),
          inner_(make_acceleration_loop(a, period, control_->lead())), where_(where) {}

    void rest() {
        drive_->settle(0);
        control_->settle({.reference = 0, .measured = 0});
        if (inner_) inner_->rest();
    }
    std::size_t lead() const { return control_->lead(); }
    quadrant::analysis::loop_sample step(const axis_motion<>& asked, double push) {
        const axis_measurement<> now = drive_->now().measured;
        const double place = where_ == seen::at_table ? drive_->now().place : now.position.value(),
                     of_law = control_->step(asked, now);
        const double command = (inner_ ? (*inner_)(of_law, asked, now) : of_law) + push;
        drive_->step(volts::from_value(command), 0);
        return {command, place, control_->due()};
    }
    bool limited() const {
        return control_->limited() || (inner_ && inner_->limited()) || drive_->now().limited;
    }

private:
    std::unique_ptr<drive_side> drive_;
    std::unique_ptr<quadrant::diagnosis::running_controller> control_;
    std::optional<acceleration_loop> inner_;
    seen where_;
};

} // namespace quadrant_cnc
