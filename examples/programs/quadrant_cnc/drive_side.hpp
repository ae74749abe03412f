// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/feed_drive.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <memory>
#include <numbers>

namespace quadrant_cnc {

using namespace quadrant;
using volts = quantity_of<signal::voltage>;

/// The machine's side of an axis, whatever its drive.
class drive_side {
public:
    /// What a drive shows at the beginning of a period, and what it did in the period before.
    struct sample {
        axis_measurement<> measured{};
        double place = 0;  ///< of the table [m]
        double effort = 0; ///< current [A], or command of the motor [V]
        bool limited = false, faulted = false;
    };

    virtual ~drive_side() = default;
    virtual void step(volts command, double push_N) noexcept = 0; ///< push: on the table, from outside
    virtual void settle(double at) noexcept = 0;
    const sample& now() const noexcept { return now_; }

protected:
    sample now_{};
};

template <class Boxes> class drive_of final : public drive_side {
public:
    drive_of(const typename Boxes::parameters& p, double period)
        : drive_{.box = {p, duration::from_value(period)}} {}
    void step(volts command, double push_N) noexcept override {
        drive_(command, in_si(push_N));
        look();
    }
    void settle(double at) noexcept override {
        drive_.settle(in_si(at));
        look();
    }

private:
    void look() noexcept {
        now_ = {drive_.measured(), drive_.wire.place.value(), drive_.wire.effort.value(), drive_.limited(),
                drive_.faulted()};
    }
    feed_drive<Boxes> drive_;
};

template <class Parameters> void add_sensors(Parameters& p, const sensor_description& s, std::uint64_t seed) {
    p.encoder_step = in_si(s.resolution_m);
    p.encoder_noise = in_si(s.noise_m);
    p.tachometer_noise = in_si(s.tachometer_noise_m_per_s);
    p.accelerometer_noise = in_si(s.accelerometer_noise_m_per_s2);
    p.scale_on_table = !s.on_motor;
    p.seed = seed;
}

using lead_error = proportional<signal::position, signal::position>;
using screw_boxes = feed_drive_boxes<ball_screw_drive<>, lead_error>;
using motor_boxes = feed_drive_boxes<linear_motor<stribeck<>>>;

inline std::unique_ptr<drive_side> make_drive(const ball_screw_description& d, const sensor_description& sensor,
                                              double period, std::uint64_t seed) {
    const auto side = [](const friction_side& s) {
        return asymmetric_stribeck<>::side{in_si(s.static_Nm), in_si(s.coulomb_Nm), in_si(s.fall_rad_per_s),
                                           in_si(s.rise_rad_per_s)};
    };
    screw_boxes::parameters p{.amplifier = in_si(d.amplifier_A_per_V),
                              .drive = {.inertia = in_si(d.inertia_kg_m2),
                                        .viscous = in_si(d.viscous_Nm_s_per_rad),
                                        .torque_constant = in_si(d.torque_constant_Nm_per_A),
                                        .pitch = in_si(d.pitch_m),
                                        .friction = {side(d.forward), side(d.backward)}},
                              .lead = {in_si(1 + d.lead_error)}};
    if (d.current_limit_A) p.effort_limit = in_si(*d.current_limit_A);
    p.table_mass = in_si(d.table_mass_kg);
    p.compliance = in_si(d.compliance_m_per_N);
    p.backlash = in_si(d.backlash_m);
    add_sensors(p, sensor, seed);
    return std::make_unique<drive_of<screw_boxes>>(p, period);
}

inline std::unique_ptr<drive_side> make_drive(const linear_motor_description& d,
                                              const sensor_description& sensor, double period,
                                              std::uint64_t seed) {
    motor_boxes::parameters p{
        .amplifier = in_si(1.0),
        .drive = {.mass = in_si(d.mass_kg),
                  .force_constant = in_si(d.force_constant_N_per_V),
                  .friction = {in_si(d.coulomb_N), in_si(d.static_N.value_or(d.coulomb_N)),
                               in_si(d.stribeck_velocity_m_per_s.value_or(1)), in_si(d.viscous_N_s_per_m)},
                  .delay = in_si(d.delay_s),
                  .substeps = 4}}; // ten move no figure of docs/cnc.md by a hundredth, and take twice the time
    if (d.drive_limit_V) p.effort_limit = in_si(*d.drive_limit_V);
    add_sensors(p, sensor, seed);
    return std::make_unique<drive_of<motor_boxes>>(p, period);
}

} // namespace quadrant_cnc
