// SPDX-License-Identifier: BSL-1.0
// An axis of the virtual machine: drive and control law as the file says, each known to the other by its ports
// only.
#include "axis.hpp"

#include "acceleration_loop.hpp"
#include "cutting_load.hpp"
#include "drive_side.hpp"

#include <quadrant/diagnosis/where/controller_box.hpp>

namespace quadrant_cnc {

namespace {

class assembled final : public axis {
public:
    assembled(const axis_description& a, double period, std::uint64_t seed)
        : drive_(std::visit([&](const auto& d) { return make_drive(d, a.sensor, period, seed); }, a.drive)),
          control_(quadrant::diagnosis::made(a.law,
                                             {.limit_V = a.command.limit_V,
                                              .dac_bits = a.command.dac_bits,
                                              .dac_range_V = a.command.dac_range_V},
                                             period)),
          inner_(make_acceleration_loop(a, period, control_->lead())), load_(make_load(a, period)) {
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
        const drive_side::sample& drive = drive_->now();
        axis_sample s{.reading = drive.measured.position.value(),
                      .velocity = drive.measured.velocity.value(),
                      .place = drive.place};
        s.command = control_->step(asked, drive.measured);
        if (inner_) s.command = (*inner_)(s.command, asked, drive.measured);
        drive_->step(volts::from_value(s.command), load_ ? load_->next() : 0);
        s.reference = control_->due();
        s.effort = shown_ * drive.effort;
        s.limited = control_->limited() || (inner_ && inner_->limited()) || drive.limited;
        s.faulted = control_->faulted() || drive.faulted;
        return s;
    }
    void settle(double at) noexcept override {
        drive_->settle(at);
        control_->settle({.reference = at, .measured = at});
        if (inner_) inner_->rest();
    }
    void cut(bool in_the_cut) noexcept override {
        if (load_) load_->engage(in_the_cut);
    }
    std::size_t lead() const noexcept override { return control_->lead(); }
    double effort_limit() const noexcept override { return limit_; }

private:
    std::unique_ptr<drive_side> drive_;
    std::unique_ptr<quadrant::diagnosis::running_controller> control_;
    std::optional<acceleration_loop> inner_;
    std::unique_ptr<cutting_load> load_;
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

} // namespace quadrant_cnc
