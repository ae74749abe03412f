// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../base/whole.hpp"
#include "../friction/coulomb_viscous.hpp"
#include "../friction/presliding.hpp"
#include "../friction/stick_slip.hpp"
#include "motor_load.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// A linear-motor axis: amplifier limit and DAC, input delay, motor, moving mass on a friction box, encoder.
///   M dv/dt = kf u(t - delay) + external - friction(v), dx/dt = v; reading = encoder rounding of x
/// u[k] is held for one period, starting `delay` after sample k; the delay does not include the hold.
/// Source: docs/formats.md (Timing); [Jamaludin2008] eq. (2.2) with friction; stick by friction/stick_slip.hpp,
/// by direction too (`asymmetric_stribeck`), or by a friction that remembers (`dahl`, `lugre`, `maxwell_slip`):
/// friction/presliding.hpp. Load: what a motor force meets on its way to the mass, as cogging and ripple in
/// `axis_load`; asked at x + v h/2 of each sub-step h. Default none.
/// Ports: command u[k] [V] in, encoder reading [m] at sample k+1 out; positive command, force and motion agree.
///   A second argument [N] is an external force held over the period.
/// State: position, velocity, past commands, what the friction remembers. `reset`: at rest at zero;
/// `settle(x)`: at rest at x, friction relaxed, no command pending.
/// Range: delay up to Capacity - 1 periods; substeps 1 ... 1000 (each advances the mass by one implicit step;
/// the
///   held command is averaged inside the sub-step where it changes).
/// NaN and infinities in a command or force, or a motion beyond all numbers: holds the last reading, keeps the
/// state, raises faulted(). Commands beyond the limit are clipped, limited() reports it.
/// Throws "linear_motor.<field> = ...: must ..." for every field and the period; friction box and load throw in
/// their own name.
/// Cost: about 12 multiplications and 3 divisions a sub-step; Capacity + 6 numbers. With scale and encoder as
/// boxes: `table_axis`.
template <class Friction = coulomb_viscous<>, std::size_t Capacity = 32, class Real = double,
          class Load = no_load>
requires(friction_law<Friction, Real> || friction_law_by_direction<Friction, Real> ||
         friction_with_memory<Friction, Real>) &&
    motor_load<Load, Real> && (Capacity > 0) class linear_motor {
    static constexpr bool loaded = !std::same_as<Load, no_load>;

public:
    using input = signal::voltage;
    using output = signal::position;
    using number = parameter_real<Real>; ///< of parameters
    using voltage = quantity_of<signal::voltage, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    using argument = voltage;
    using value = position;

    /// Amplifier, motor, mass, friction and encoder of one axis.
    struct parameters {
        quantity<si::mass, number> mass;                                ///< moving mass; > 0
        gain_of<signal::force, signal::voltage, number> force_constant; ///< motor and amplifier; > 0
        typename Friction::parameters friction{};             ///< of the friction box, viscous part included
        quantity<si::time, number> delay{};                   ///< before a command acts; >= 0
        quantity_of<signal::voltage, number> limit{};         ///< of the amplifier, both ways; 0: none
        quantity_of<signal::voltage, number> dac_step{};      ///< 0: none
        quantity_of<signal::position, number> encoder_step{}; ///< 0: none
        std::size_t substeps = 10;                            ///< per servo period; 1 ... 1000
        typename Load::parameters load{};
    };
    /// Motion of the mass, and the commands that are still on their way to it.
    struct state {
        position x{};
        velocity v{};
        std::array<voltage, Capacity + 1> past{}; ///< [0]: place of the coming command; then the newest first
    };

    linear_motor(const parameters& p, duration period)
        : given_(checked(p, period)), friction_(p.friction, period), mass_(in_real<Real>(p.mass)),
          force_constant_(in_real<Real>(p.force_constant)), limit_(in_real<Real>(p.limit)),
          dac_step_(in_real<Real>(p.dac_step)), encoder_step_(in_real<Real>(p.encoder_step)),
          h_(quantity<si::time, Real>::from_value(Real(period.value() / static_cast<double>(p.substeps)))),
          load_(p.load, period / static_cast<double>(p.substeps)) {
        require_coefficients<Real>("linear_motor.mass", p.mass,
                                   p.mass.value() * number(double(p.substeps) / period.value()));
        const number periods = p.delay.value() / number(period.value());
        whole_ = static_cast<std::size_t>(detail::plain(periods));
        fraction_ = Real(periods - number(static_cast<double>(whole_)));
    }

    /// Applies u from sample k on; returns the encoder reading of sample k+1.
    position operator()(voltage u, force external = force()) noexcept {
        const bool beyond = limit_ > voltage() && (u > limit_ || u < -limit_);
        state_.past[0] = rounded(beyond ? (u > voltage() ? limit_ : -limit_) : u, dac_step_);
        const voltage newer = state_.past[whole_], older = state_.past[whole_ + 1];
        position x = state_.x;
        velocity v = state_.v;
        [[maybe_unused]] const auto memory = remembered(); // goes back there after a fault
        [[maybe_unused]] const Load load = load_;
        const auto n = given_.substeps;
        auto&& law = in_sub_steps(friction_);
        for (std::size_t i = 0; i < n; ++i) {
            // Share of the sub-step in which the newer command already acts.
            const Real late = fraction_ * Real(static_cast<double>(n)) - Real(static_cast<double>(i));
            const Real share = late < Real(0) ? Real(1) : late >= Real(1) ? Real(0) : Real(1) - late;
            const voltage acting = newer * share + older * (Real(1) - share);
            const velocity next =
                advanced(law, v, driven(x + v * (h_ * Real(0.5)), force_constant_ * acting, external));
            x += (v + next) * (h_ * Real(0.5));
            v = next;
        }
        const position reading = rounded(x, encoder_step_); // not finite when x or v is not
        if (!finite(u, external, reading) || load_faulted()) {
            state_.past[0] = state_.past[1];
            if constexpr (friction_with_memory<Friction, Real>) friction_.become(memory);
            if constexpr (loaded) load_ = load;
            return out_.hold();
        }
        state_.x = x;
        state_.v = unless_died_out(v);
        for (std::size_t i = Capacity; i > 0; --i) state_.past[i] = state_.past[i - 1];
        limited_ = beyond;
        return out_.keep(reading);
    }
    void reset() noexcept { settle(position()); }
    void settle(position x) noexcept {
        const position reading = rounded(x, encoder_step_);
        if (!finite(x, reading)) return out_.raise();
        state_ = state{.x = x};
        if constexpr (friction_with_memory<Friction, Real>) friction_.reset();
        if constexpr (loaded) load_.reset();
        limited_ = false;
        out_.reset(reading);
    }

    bool limited() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }
    const Friction& friction() const noexcept { return friction_; } ///< its memory: friction().now()
    const Load& load() const noexcept { return load_; }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("linear_motor.period", period);
        require_positive<Real>("linear_motor.mass", p.mass);
        require_positive<Real>("linear_motor.force_constant", p.force_constant);
        require_not_negative<Real>("linear_motor.delay", p.delay);
        require(detail::plain(p.delay) / period.value() <= static_cast<double>(Capacity - 1),
                "linear_motor.delay", p.delay,
                "must not be beyond the capacity (" + detail::shortest(double(Capacity - 1)) + " periods)");
        require_not_negative<Real>("linear_motor.limit", p.limit);
        require_not_negative<Real>("linear_motor.dac_step", p.dac_step);
        require_not_negative<Real>("linear_motor.encoder_step", p.encoder_step);
        require(p.substeps >= 1 && p.substeps <= 1000, "linear_motor.substeps", static_cast<double>(p.substeps),
                "must lie between 1 and 1000");
        return p;
    }
    auto remembered() const noexcept {
        if constexpr (friction_with_memory<Friction, Real>)
            return typename Friction::state(friction_.now());
        else
            return 0;
    }
    /// One sub-step; a friction that remembers moves with the axis.
    template <class Law> [[gnu::always_inline]] velocity advanced(Law& law, velocity v, force drive) noexcept {
        if constexpr (friction_with_memory<Friction, Real>) {
            const auto to = presliding<Real>(friction_, mass_, v, drive, h_);
            friction_.become(to.friction);
            return to.v;
        } else
            return stick_slip<Real>(law, mass_, v, drive, h_);
    }
    force driven([[maybe_unused]] position x, force motor, force external) noexcept {
        if constexpr (loaded)
            return load_(x, motor, external);
        else
            return motor + external;
    }
    bool load_faulted() const noexcept {
        if constexpr (requires { load_.faulted(); })
            return load_.faulted();
        else
            return false;
    }
    template <class Quantity> static Quantity rounded(Quantity x, Quantity step) noexcept {
        if (!(step > Quantity())) return x;
        return step * detail::whole(Real(x / step));
    }

    parameters given_;
    Friction friction_;
    quantity<si::mass, Real> mass_;
    gain_of<signal::force, signal::voltage, Real> force_constant_;
    voltage limit_, dac_step_;
    position encoder_step_;
    quantity<si::time, Real> h_;
    [[no_unique_address]] Load load_;
    std::size_t whole_ = 0;
    Real fraction_{};
    state state_;
    bool limited_ = false;
    held_output<position> out_;
};

} // namespace quadrant::inline v0
