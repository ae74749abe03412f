// SPDX-License-Identifier: BSL-1.0
// Long: one machine of the source, each of its boxes a type.
#pragma once
#include <quadrant/base/in_si.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/predictive.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/loop/feed_control.hpp>
#include <quadrant/observer/kalman.hpp>
#include <quadrant/observer/lugre_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>
#include <quadrant/plant/three_phase_drive.hpp>
#include <quadrant/trajectory/s_curve.hpp>

#include <algorithm>
#include <array>
#include <cmath>

/// The precision stage of [LowKeck2003]. Its parameters are not published: the machine is the plausible one of
/// shared/reference/linear_stage.md, what the controller believes is off by 5 to 20 %. A volt stands for an
/// ampere.
namespace stage {

using namespace quadrant;
using namespace quadrant::literals;

inline constexpr duration period = duration::from_value(2e-3);
inline constexpr std::size_t horizon = 10;

/// Friction and motor of the machine, or what somebody thinks of them.
struct machine {
    double mass = 6, force_constant = 40, viscous = 15;         ///< [kg], [N/A], [N s/m]
    double coulomb = 8, static_level = 12, stribeck = 5e-3;     ///< [N], [N], [m/s]
    double stiffness = 1.5e6, damping = 3000, falls_by = 10e-3; ///< of the bristles [N/m], [N s/m], [m/s]
    std::size_t substeps = 20;                                  ///< of its simulation, a period
    bool current_loops = false; ///< two PI in the frame of the magnets, or the current at once
};
inline constexpr machine real{};
inline constexpr machine believed{6.4, 38, 13, 7.4, 11, 6e-3, 1.25e6, 2500, 12e-3};

/// The drive of Fig. 2: winding, bus and bandwidth are ours, as the source prints none.
inline three_phase_drive<>::parameters drive_of(const machine& m) {
    return {.force_constant = in_si(m.force_constant),
            .resistance = in_si(4.0),
            .time_constant = in_si(2e-3),
            .pole_pair = in_si(0.032),
            .bus = 120_V,
            .current_limit = 8_A,
            .bandwidth = 300_Hz,
            .steps = 20};
}

/// In newtons, or in volts.
template <signal_tag Out>
typename lugre<signal::velocity, Out>::parameters friction_of(const machine& m, double unit = 1) {
    using law = lugre<signal::velocity, Out>;
    typename law::parameters p;
    p.curve = {in_si(m.coulomb / unit), in_si(m.static_level / unit), in_si(m.stribeck),
               in_si(m.viscous / unit), 2};
    p.stiffness = in_si(m.stiffness / unit);
    p.damping = in_si(m.damping / unit);
    p.damping_velocity = in_si(m.falls_by);
    return p;
}
using motor = linear_motor<lugre<>>;
inline motor::parameters motor_of(const machine& m, quantity<si::length> encoder = 1_um) {
    return {.mass = in_si(m.mass),
            .force_constant = in_si(m.force_constant),
            .friction = friction_of<signal::force>(m),
            .limit = 8_V,
            .encoder_step = encoder,
            .substeps = m.substeps};
}

/// What is tuned.
struct tuning {
    double position, speed,
        increment; ///< errors, and a change of the command, that cost the same [m], [m/s], [A]
    double drift;  ///< of the Kalman filter [N]
};
inline constexpr tuning tight{5e-6, 4e-3, 0.02, 30};
inline constexpr tuning moderate{30e-6, 10e-3, 0.01, 30}; ///< at which friction shows
using law = predictive<horizon>;
inline law::parameters law_of(const machine& m, const tuning& t) {
    return {.plant = {in_si(m.force_constant / m.mass), in_si(m.viscous / m.mass)},
            .weights = bryson_weights(t.position * 1_m, t.speed * 1_mps, t.increment * 1_V)};
}
inline kalman<signal::voltage>::parameters filter_of(const machine& m, const tuning& t) {
    return {.mass = in_si(m.mass),
            .force_constant = in_si(m.force_constant),
            .viscous = in_si(m.viscous),
            .encoder_noise = 1_um / std::sqrt(12.0),
            .drift = in_si(t.drift)};
}

/// Friction compensation: fed forward from the reference, or that corrected by what the axis is behind.
struct no_feedforward {
    using forward = absent<signal::velocity, signal::voltage>;
    using observer = absent<signal::velocity, signal::voltage>;
    static forward::parameters forward_of(const machine&) { return {}; }
    static observer::parameters observer_of(const machine&) { return {}; }
};
struct fed_forward : no_feedforward {
    using forward = lugre<signal::velocity, signal::voltage>;
    static forward::parameters forward_of(const machine& m) {
        return friction_of<signal::voltage>(m, m.force_constant);
    }
};
struct observed : no_feedforward {
    using observer = lugre_observer<signal::voltage>;
    static observer::parameters observer_of(const machine& m) {
        return {friction_of<signal::voltage>(m, m.force_constant), 30.0 / 1_s};
    }
};

/// One sample of a run, SI.
struct moment {
    double time, reference, position, velocity, measured, estimate, speed_estimate, command;
    double error() const { return reference - position; }
};

/// The machine's motor on the friction that the controller believes in, with numbers of its own.
struct lugre_machine {
    using type = motor;
    static type::parameters of(const machine& m) { return motor_of(m); }
};
/// The same on friction by another law: two springs that break away, over about the same way.
struct springs_machine {
    using type = linear_motor<maxwell_slip<2>>;
    static type::parameters of(const machine& m) {
        return {.mass = in_si(m.mass),
                .force_constant = in_si(m.force_constant),
                .friction = {.curve = {in_si(m.coulomb), in_si(m.static_level), in_si(m.stribeck),
                                       in_si(m.viscous)},
                             .weights = {0.6, 0.4},
                             .forces = {},
                             .stiffness = {in_si(0.8 * m.stiffness), in_si(0.2 * m.stiffness)},
                             .attraction = 1000_N / 1_s},
                .limit = 8_V,
                .encoder_step = 1_um,
                .substeps = m.substeps};
    }
};

/// What controls the stage: filter, predictive law and compensation of the friction.
template <class Compensation> class controller {
public:
    controller(const machine& thought, const tuning& t)
        : control_{.box = {{.law = law_of(thought, t),
                            .friction = Compensation::forward_of(thought),
                            .limit = 8_V},
                           period}},
          observer_(Compensation::observer_of(thought), period), filter_(filter_of(thought, t), period) {}

    /// The command; the reference is given `horizon` samples before it is due.
    quantity<si::electric_potential> operator()(quantity<si::length> measured,
                                                const axis_motion<>& due_later) noexcept {
        speed_ = filter_(measured, command_);
        command_ = control_(due_later, {filter_.position(), speed_});
        if constexpr (requires { observer_.given().correction; })
            command_ += observer_(control_.wire.reference_velocity, reference() - filter_.position());
        return command_;
    }
    void settle(quantity<si::length> x) noexcept {
        control_.settle(x);
        observer_.reset();
        filter_.settle(x);
        speed_ = {};
        command_ = {};
    }
    quantity<si::length> reference() const noexcept { return control_.wire.reference; } ///< due now
    quantity<si::length> position() const noexcept { return filter_.position(); }       ///< estimated
    quantity<si::velocity> speed() const noexcept { return speed_; }                    ///< estimated
    bool faulted() const noexcept { return control_.faulted() || filter_.faulted(); }

private:
    feed_control<feed_control_boxes<law, typename Compensation::forward>> control_;
    typename Compensation::observer observer_;
    kalman<signal::voltage> filter_;
    quantity<si::velocity> speed_{};
    quantity<si::electric_potential> command_{};
};

/// The machine and the drive that moves it.
template <class Machine> class driven {
public:
    explicit driven(const machine& is)
        : motor_(Machine::of(is), period), drive_(drive_of(is), period), current_loops_(is.current_loops) {}

    void step(quantity<si::electric_potential> u, quantity<si::force> f = {}) noexcept {
        measured_ = current_loops_ ? motor_(0_V, drive_(u.value() * 1_A, motor_.now().x, motor_.now().v) + f)
                                   : motor_(u, f);
    }
    void settle(quantity<si::length> at) noexcept {
        motor_.settle(at);
        drive_.reset();
        measured_ = at;
    }
    quantity<si::length> measured() const noexcept { return measured_; }
    auto now() const noexcept { return motor_.now(); }
    bool faulted() const noexcept { return motor_.faulted(); }

private:
    typename Machine::type motor_;
    three_phase_drive<> drive_;
    bool current_loops_;
    quantity<si::length> measured_{};
};

/// The stage under control; references are given `horizon` samples before they are due.
template <class Compensation, class Machine = lugre_machine> class axis {
public:
    axis(const machine& is, const machine& thought, const tuning& t) : control_(thought, t), machine_(is) {}

    moment step(double time, const axis_motion<>& due_later) {
        const auto command = control_(machine_.measured(), due_later);
        const moment now{time,
                         control_.reference().value(),
                         machine_.now().x.value(),
                         machine_.now().v.value(),
                         machine_.measured().value(),
                         control_.position().value(),
                         control_.speed().value(),
                         command.value()};
        machine_.step(command);
        return now;
    }
    bool faulted() const { return control_.faulted() || machine_.faulted(); }

private:
    controller<Compensation> control_;
    driven<Machine> machine_;
};

/// From rest at zero; `reference(t)` is defined for every time; `tell(moment)` hears every sample of 0 ... end.
template <class Compensation, class Machine = lugre_machine, class Reference, class Tell>
void run(const machine& is, const machine& thought, const tuning& t, const Reference& reference, double end,
         Tell&& tell) {
    axis<Compensation, Machine> a(is, thought, t);
    const double T = period.value();
    const auto samples = static_cast<long>(end / T + 0.5);
    const long known = static_cast<long>(horizon);
    for (long k = -known; k <= samples && !a.faulted(); ++k) {
        const moment m = a.step(double(k) * T, reference(double(k + known) * T));
        if (k >= 0) tell(m);
    }
}

/// What is read off a move of that length.
struct figures {
    double peak_speed = 0, peak_command = 0;       ///< [m/s], [A]
    double settling = 0, max_error = 0, final = 0; ///< [s] into +-2 um, [um], [um]
    double peak_speed_at = 0;                      ///< [s]
    double stuck_from = 0; ///< [um] to go where it first stands still, below 0.1 mm/s, after half the move
};
template <class Compensation, class Machine = lugre_machine, class Tell>
figures move(const machine& is, const machine& thought, const tuning& t, double length, double time, double end,
             Tell&& tell) {
    const trajectory::s_curve curve({length * 1_m, time * 1_s});
    const auto reference = [&](double at) {
        const auto m = curve(at * 1_s);
        return axis_motion<>{m.position, m.velocity, m.acceleration};
    };
    figures f;
    run<Compensation, Machine>(is, thought, t, reference, end, [&](const moment& m) {
        if (std::abs(m.velocity) > f.peak_speed) f.peak_speed = std::abs(m.velocity), f.peak_speed_at = m.time;
        if (f.stuck_from == 0 && m.time > time / 2 && std::abs(m.velocity) < 1e-4)
            f.stuck_from = 1e6 * std::abs(length - m.position);
        f.peak_command = std::max(f.peak_command, std::abs(m.command));
        f.max_error = std::max(f.max_error, 1e6 * std::abs(m.error()));
        f.final = 1e6 * std::abs(length - m.position);
        if (f.final > 2) f.settling = m.time + period.value();
        tell(m);
    });
    return f;
}

/// The last micrometre is a matter of where the counts of the encoder happen to lie: medians over nine machines
/// whose mass differs by 0.1 %, the final error the largest of them.
template <class Compensation>
figures usual(const machine& is, const machine& thought, const tuning& t, double length, double time,
              double end) {
    std::array<figures, 9> all;
    for (std::size_t k = 0; k < all.size(); ++k) {
        machine one = is;
        one.mass *= 0.996 + 0.001 * double(k);
        all[k] = move<Compensation>(one, thought, t, length, time, end, [](const moment&) {});
    }
    const auto ordered = [&](double figures::*what, std::size_t which) {
        std::array<double, 9> x;
        for (std::size_t k = 0; k < all.size(); ++k) x[k] = all[k].*what;
        std::sort(x.begin(), x.end());
        return x[which];
    };
    return {ordered(&figures::peak_speed, 4), ordered(&figures::peak_command, 4),
            ordered(&figures::settling, 4),   ordered(&figures::max_error, 4),
            ordered(&figures::final, 8),      ordered(&figures::peak_speed_at, 4),
            ordered(&figures::stuck_from, 4)};
}

/// The linear cycle of BS 3800 with targets of 10 um: three forward, half a step over, the same three back,
/// half a step over. 0.1 s to each, 0.4 s there.
struct linear_cycle {
    static constexpr double targets[] = {0, 10, 20, 30, 35, 30, 20, 10, 5, 10, 20, 30, 35, 30, 20, 10, 5};
    static constexpr double takes = 0.1, lasts = 0.5;
    static constexpr std::size_t steps = std::size(targets) - 1;
    static constexpr double end() { return double(steps) * lasts; }

    axis_motion<> operator()(double at) const {
        const auto k = std::min(std::size_t(std::max(at, 0.0) / lasts), steps - 1);
        const double from = 1e-6 * targets[k], to = 1e-6 * targets[k + 1];
        const auto m = trajectory::s_curve({(to - from) * 1_m, takes * 1_s})((at - double(k) * lasts) * 1_s);
        return {from * 1_m + m.position, m.velocity, m.acceleration};
    }
};

} // namespace stage
