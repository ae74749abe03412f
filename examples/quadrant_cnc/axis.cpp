// SPDX-License-Identifier: BSL-1.0
// An axis of the virtual machine: drive and control law as the file says, each known to the other by its ports only.
#include "axis.hpp"

#include "control_side.hpp"
#include "drive_side.hpp"

namespace quadrant_cnc {

namespace {

class assembled final : public axis {
public:
    assembled(const axis_description& a, double period, std::uint64_t seed)
        : drive_(std::visit([&](const auto& d) { return make_drive(d, a.sensor, period, seed); }, a.drive)),
          control_(std::visit(make_control{a, period}, a.law)) {
        if (const auto* screw = std::get_if<ball_screw_description>(&a.drive)) {
            limit_ = std::min(screw->amplifier_A_per_V * a.command.limit_V,
                              screw->current_limit_A.value_or(unlimited));
        } else {
            const auto& motor = std::get<linear_motor_description>(a.drive);
            shown_ = motor.amplifier_A_per_V.value_or(1);
            limit_ = shown_ * std::min(a.command.limit_V, motor.drive_limit_V.value_or(unlimited));
        }
    }
    axis_sample step(const axis_motion<>& asked) noexcept override {
        const axis_measurement<> now = drive_->measured();
        axis_sample s{.reading = now.position.value(), .place = drive_->place()};
        const volts u = control_->step(asked, now);
        drive_->step(u);
        s.reference = control_->due();
        s.command = u.value();
        s.effort = shown_ * drive_->effort();
        s.limited = control_->limited() || drive_->limited();
        s.faulted = control_->faulted() || drive_->faulted();
        return s;
    }
    void settle(double at) noexcept override {
        drive_->settle(at);
        control_->settle(at);
    }
    std::size_t lead() const noexcept override { return control_->lead(); }
    double effort_limit() const noexcept override { return limit_; }

private:
    std::unique_ptr<drive_side> drive_;
    std::unique_ptr<control_side> control_;
    double limit_ = unlimited, shown_ = 1;
};

} // namespace

std::unique_ptr<axis> make_axis(const axis_description& a, double period, std::uint64_t seed) {
    return std::make_unique<assembled>(a, period, seed);
}

const char* effort_unit(const axis_description& a) {
    const auto* motor = std::get_if<linear_motor_description>(&a.drive);
    return motor && !motor->amplifier_A_per_V ? "V" : "A";
}

plant_of_axis plant_of(const axis_description& a) {
    if (const auto* d = std::get_if<ball_screw_description>(&a.drive))
        return {d->amplifier_A_per_V * d->torque_constant_Nm_per_A * pitch_per_radian(*d) / d->inertia_kg_m2,
                d->viscous_Nm_s_per_rad / d->inertia_kg_m2};
    const auto& m = std::get<linear_motor_description>(a.drive);
    return {m.force_constant_N_per_V / m.mass_kg, m.viscous_N_s_per_m / m.mass_kg};
}

} // namespace quadrant_cnc
