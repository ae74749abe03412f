// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis.hpp"
#include "drive_side.hpp"

#include <quadrant/compose/feed_control.hpp>
#include <quadrant/control/generalized_predictive.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>
#include <quadrant/diagnosis/controller_box.hpp>
#include <quadrant/feedforward/friction_feedforward.hpp>

#include <optional>

namespace quadrant_cnc {

/// The controller's side of an axis, whatever its law.
struct control_side {
    virtual ~control_side() = default;
    virtual volts step(const axis_motion<>& asked, const axis_measurement<>& measured) noexcept = 0;
    virtual void settle(double at) noexcept = 0;
    virtual double due() const noexcept = 0; ///< the reference of this sample
    virtual std::size_t lead() const noexcept { return 0; }
    virtual bool limited() const noexcept = 0;
    virtual bool faulted() const noexcept = 0;
};

/// The drive's friction in volts, added to the command as the reference will cause it; or nothing.
class known_friction {
    using curve = asymmetric_stribeck<signal::velocity, signal::voltage>;
    using feedforward = friction_feedforward<curve>;

public:
    using input = signal::velocity;
    using output = signal::voltage;
    using value = volts;
    using parameters = std::optional<feedforward::parameters>;

    known_friction(const parameters& p, duration period) {
        if (p) law_.emplace(*p, period);
    }
    volts operator()(quantity_of<signal::velocity> v) noexcept { return law_ ? (*law_)(v) : volts(); }
    void reset() noexcept {
        if (law_) law_->reset();
    }
    void settle(quantity_of<signal::velocity> v) noexcept {
        if (law_) law_->settle(v);
    }
    bool faulted() const noexcept { return law_ && law_->faulted(); }

    static parameters of(const axis_description& a) {
        if (!a.friction_feedforward) return {};
        feedforward::parameters p{.law = {},
                                  .force_constant = in_si(1.0),
                                  .width = in_si(a.friction_feedforward->width_m_per_s),
                                  .scale = a.friction_feedforward->scale,
                                  .rest = at_rest::held};
        if (const auto* d = std::get_if<ball_screw_description>(&a.drive)) {
            const double per_Nm = 1 / (d->amplifier_A_per_V * d->torque_constant_Nm_per_A),
                         way = pitch_per_radian(*d);
            const auto side = [&](const friction_side& s) {
                return curve::side{in_si(per_Nm * s.static_Nm), in_si(per_Nm * s.coulomb_Nm),
                                   in_si(way * s.fall_rad_per_s), in_si(way * s.rise_rad_per_s)};
            };
            p.law = {side(d->forward), side(d->backward), in_si(per_Nm / way * d->viscous_Nm_s_per_rad)};
        } else {
            const auto& m = std::get<linear_motor_description>(a.drive);
            const double fall = m.stribeck_velocity_m_per_s.value_or(1), per_N = 1 / m.force_constant_N_per_V;
            const curve::side both{in_si(per_N * m.static_N.value_or(m.coulomb_N)), in_si(per_N * m.coulomb_N),
                                   in_si(fall), in_si(fall)};
            p.law = {both, both, in_si(per_N * m.viscous_N_s_per_m)};
        }
        // Laws that know the plant drive its viscous part already, those that do not meet it in their integral.
        p.law.viscous = {};
        return p;
    }

private:
    std::optional<feedforward> law_;
};

template <class Law> struct control_of final : control_side {
    using boxes = feed_control_boxes<Law, known_friction>;
    control_of(const axis_description& a, const typename Law::parameters& law, double period)
        : control{.box = {{.law = law,
                           .friction = known_friction::of(a),
                           .limit = in_si(a.command.limit_V),
                           .dac_step = in_si(a.dac_step())},
                          duration::from_value(period)}} {}
    volts step(const axis_motion<>& asked, const axis_measurement<>& measured) noexcept override {
        return control(asked, measured);
    }
    void settle(double at) noexcept override { control.settle(in_si(at)); }
    double due() const noexcept override { return control.wire.reference.value(); }
    std::size_t lead() const noexcept override {
        if constexpr (requires { Law::most_lead; })
            return control.box.law.lead();
        else
            return 0;
    }
    bool limited() const noexcept override { return control.limited(); }
    bool faulted() const noexcept override { return control.faulted(); }
    feed_control<boxes> control;
};

/// The cascade of the gap's machine file: positions only, with filters of its own.
template <class Cascade> struct cascade_control final : control_side {
    explicit cascade_control(const Cascade& c) : control(c) {}
    volts step(const axis_motion<>& asked, const axis_measurement<>& measured) noexcept override {
        return control(asked.position, measured.position);
    }
    void settle(double at) noexcept override {
        control.settle({.reference = in_si(at), .measured = in_si(at)});
    }
    double due() const noexcept override { return control.wire.reference.value(); }
    bool limited() const noexcept override { return control.limited(); }
    bool faulted() const noexcept override { return control.faulted(); }
    Cascade control;
};

inline axis_model<signal::voltage> believed(const axis_description& a, const believed_plant& p) {
    const plant_of_axis real = plant_of(a);
    return {in_si(p.plant_gain_m_per_s2_V.value_or(real.gain)),
            in_si(p.plant_damping_per_s.value_or(real.damping))};
}

/// One law a call: parameters from the file's keys, or from a design that uses them.
struct make_control {
    const axis_description& a;
    double period;
    using side = std::unique_ptr<control_side>;

    template <class Law> side with(const typename Law::parameters& law) const {
        return std::make_unique<control_of<Law>>(a, law, period);
    }
    duration T() const { return duration::from_value(period); }

    side operator()(const pid_description& d) const {
        pid<>::parameters p{.gain = in_si(d.gain_V_per_m),
                            .integral_gain = in_si(d.integral_gain_V_per_m_s),
                            .derivative_gain = in_si(d.derivative_gain_V_s_per_m),
                            .position_weight = d.position_weight,
                            .velocity_weight = d.velocity_weight,
                            .limit = in_si(a.command.limit_V)};
        if (d.derivative_corner_Hz) p.derivative_corner = in_si(*d.derivative_corner_Hz);
        return with<pid<>>(p);
    }
    side operator()(const p_pi_description& d) const {
        return with<p_pi<>>({.position_gain = in_si(d.position_gain_per_s),
                             .gain = in_si(d.gain_V_s_per_m),
                             .integral_gain = in_si(d.integral_gain_V_per_m),
                             .velocity_weight = d.velocity_weight,
                             .acceleration_gain = in_si(d.acceleration_gain_V_s2_per_m),
                             .limit = in_si(a.command.limit_V)});
    }
    side operator()(const sliding_mode_description& d) const {
        return with<sliding_mode<>>({.plant = believed(a, d),
                                     .sliding = in_si(d.sliding_per_s),
                                     .gain = in_si(d.gain_V_s_per_m),
                                     .adaptation = in_si(d.adaptation_V_per_m),
                                     .limit = in_si(a.command.limit_V)});
    }
    side operator()(const diagnosis::controller_description& d) const {
        const diagnosis::actuator_description out{
            .limit_V = a.command.limit_V, .dac_bits = a.command.dac_bits, .dac_range_V = a.command.dac_range_V};
        return diagnosis::with_cascade(d, out, period, [](const auto& cascade) -> side {
            return std::make_unique<cascade_control<std::decay_t<decltype(cascade)>>>(cascade);
        });
    }
    side operator()(const poles_description& d) const {
        const rst_poles at{in_si(d.natural_Hz), d.damping, in_si(d.observer_Hz)};
        if (!d.zero_phase) return with<pole_placement<>>(place_rst(believed(a, d), at, T()));
        return with<zero_phase_tracking<>>(zero_phase_rst(believed(a, d), at, T()));
    }
    side operator()(const lead_lag_description& d) const {
        return with<lead_lag<>>(
            design_lead_lag(believed(a, d), {in_si(d.crossover_Hz), d.phase_margin_deg, d.integral}, T()));
    }
    side operator()(const predictive_description& d) const {
        return with<generalized_predictive_law<>>(generalized_predictive<20>(
            believed(a, d), predictive_costs<>{.effort = in_si(d.effort_m_per_V)}, T()));
    }
    side operator()(const state_feedback_description& d) const {
        return with<state_feedback<>>({.plant = believed(a, d),
                                       .position_gain = in_si(d.position_gain_V_per_m),
                                       .velocity_gain = in_si(d.velocity_gain_V_s_per_m),
                                       .encoder_noise = in_si(d.encoder_noise_m),
                                       .drift = in_si(d.drift_V)});
    }
};

} // namespace quadrant_cnc
