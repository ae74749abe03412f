// SPDX-License-Identifier: BSL-1.0
// Long: side_by_side() names each number of an axis.
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/slip_contact.hpp"
#include "amplifier_lag.hpp"
#include "harmonic_series.hpp"
#include "joint.hpp"
#include "play_between_masses.hpp"
#include "sprung_mass.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace quadrant::inline v0 {

/// The numbers of a `servo_axis`, their ranges, and how those of several axes stand side by side in lanes.
template <class Real, class Laws> struct servo_parameters {
    static constexpr std::size_t harmonics = 8, springs = 4;
    using number = parameter_real<Real>; ///< of parameters
    using contact = slip_contact<springs, Real>;
    using mask = mask_of<Real>;

    /// What repeats over a place or a time: period, and cosine and sine of each harmonic. Its unit is that of
    /// the joint.
    struct repeating {
        number period{1};                               ///< [m] or [s]; > 0
        std::array<number, harmonics> cosine{}, sine{}; ///< finite
    };
    /// Bare SI numbers: a fit moves each of them. Neutral as they stand, but for mass and force constant.
    struct parameters {
        number mass{1};           ///< all that moves, the sprung mass too [kg]
        number force_constant{1}; ///< [N] of a unit of the command
        number dead_zone{0};      ///< [unit of the command]
        number limit{std::numeric_limits<double>::infinity()};
        quantity<si::time, number> lag{};
        repeating ripple{};                       ///< of the force constant, relative, over position
        number constant{0};                       ///< [N]
        number spring{0};                         ///< [N/m], about position 0
        number gravity{0}, gravity_phase{0};      ///< [N m], [rad], of an axis whose position is an angle
        number coupling{0};                       ///< of the other axis' acceleration
        repeating cogging{};                      ///< [N] over position
        repeating process{};                      ///< [N] over time
        number process_mean{0}, process_start{0}; ///< [N], [s]
        typename contact::parameters friction{};
        repeating along{};              ///< of the friction's level, relative, over position
        number drift{0}, drift_time{1}; ///< level times 1 + drift (1 - exp(-t/drift_time))
        number load_friction{0};        ///< growth of the level with the force that the drive transmits; >= 0
        typename sprung_mass<Real>::parameters second{};
        number play{0};        ///< between motor and load, the encoder on the load [m]
        number play_behind{0}; ///< the same, the encoder on the motor [m]
        number motor_mass{std::numeric_limits<double>::infinity()}; ///< part of the mass before the play [kg]
        number motor_friction{std::numeric_limits<double>::infinity()}; ///< of the level, at most, there [N]
        repeating cyclic{};                                             ///< of the reading [m] over position
        Laws laws{};
    };
    /// Several axes side by side, one a lane; the last one again in the lanes that are left over.
    /// `axis_of(i)`: the parameters of axis i < `count`, a servo_axis in double.
    template <class AxisOf> static parameters side_by_side(std::size_t count, const AxisOf& axis_of) {
        using Single = std::remove_cvref_t<decltype(axis_of(0))>;
        const auto each = [&](const auto& number_of) {
            number out(0);
            for (std::size_t i = 0; i < lane_count<Real>; ++i)
                set_lane(out, i, number_of(axis_of(i < count ? i : count - 1)));
            return out;
        };
        const auto typed = [&]<class Quantity>(Quantity& to, const auto& quantity_of) {
            to = Quantity::from_value(each([&](const Single& p) { return quantity_of(p).value(); }));
        };
        const auto waves = [&](const auto& of) {
            repeating out;
            out.period = each([&](const Single& p) { return of(p).period; });
            for (std::size_t i = 0; i < harmonics; ++i) {
                out.cosine[i] = each([&](const Single& p) { return of(p).cosine[i]; });
                out.sine[i] = each([&](const Single& p) { return of(p).sine[i]; });
            }
            return out;
        };
        parameters out;
        out.mass = each([](const Single& p) { return p.mass; });
        out.force_constant = each([](const Single& p) { return p.force_constant; });
        out.dead_zone = each([](const Single& p) { return p.dead_zone; });
        out.limit = each([](const Single& p) { return p.limit; });
        typed(out.lag, [](const Single& p) { return p.lag; });
        out.ripple = waves([](const Single& p) -> auto& { return p.ripple; });
        out.constant = each([](const Single& p) { return p.constant; });
        out.spring = each([](const Single& p) { return p.spring; });
        out.gravity = each([](const Single& p) { return p.gravity; });
        out.gravity_phase = each([](const Single& p) { return p.gravity_phase; });
        out.load_friction = each([](const Single& p) { return p.load_friction; });
        out.coupling = each([](const Single& p) { return p.coupling; });
        out.cogging = waves([](const Single& p) -> auto& { return p.cogging; });
        out.process = waves([](const Single& p) -> auto& { return p.process; });
        out.process_mean = each([](const Single& p) { return p.process_mean; });
        out.process_start = each([](const Single& p) { return p.process_start; });
        out.along = waves([](const Single& p) -> auto& { return p.along; });
        out.drift = each([](const Single& p) { return p.drift; });
        out.drift_time = each([](const Single& p) { return p.drift_time; });
        out.play = each([](const Single& p) { return p.play; });
        out.play_behind = each([](const Single& p) { return p.play_behind; });
        out.motor_mass = each([](const Single& p) { return p.motor_mass; });
        out.motor_friction = each([](const Single& p) { return p.motor_friction; });
        out.cyclic = waves([](const Single& p) -> auto& { return p.cyclic; });
        typed(out.second.mass, [](const Single& p) { return p.second.mass; });
        typed(out.second.centre, [](const Single& p) { return p.second.centre; });
        out.second.damping = each([](const Single& p) { return p.second.damping; });
        auto& f = out.friction;
        typed(f.level, [](const Single& p) { return p.friction.level; });
        typed(f.excess, [](const Single& p) { return p.friction.excess; });
        typed(f.stribeck_velocity, [](const Single& p) { return p.friction.stribeck_velocity; });
        f.shape = each([](const Single& p) { return p.friction.shape; });
        typed(f.viscous, [](const Single& p) { return p.friction.viscous; });
        f.asymmetry = each([](const Single& p) { return p.friction.asymmetry; });
        f.excess_asymmetry = each([](const Single& p) { return p.friction.excess_asymmetry; });
        f.velocity_asymmetry = each([](const Single& p) { return p.friction.velocity_asymmetry; });
        f.viscous_asymmetry = each([](const Single& p) { return p.friction.viscous_asymmetry; });
        typed(f.attraction, [](const Single& p) { return p.friction.attraction; });
        typed(f.damping, [](const Single& p) { return p.friction.damping; });
        for (std::size_t i = 0; i < springs; ++i) {
            f.weights[i] = each([&](const Single& p) { return p.friction.weights[i]; });
            typed(f.stiffness[i], [&](const Single& p) { return p.friction.stiffness[i]; });
            typed(f.give[i], [&](const Single& p) { return p.friction.give[i]; });
        }
        if constexpr (requires { Laws(count, axis_of); }) out.laws = Laws(count, axis_of);
        return out;
    }
    /// What parts at the play.
    static typename play_between_masses<Real>::parameters masses_apart(const parameters& p) {
        typename play_between_masses<Real>::parameters out;
        out.width = p.play + p.play_behind;
        out.mass = p.mass;
        out.motor_mass = p.motor_mass;
        out.motor_level = p.motor_friction;
        out.viscous = p.friction.viscous.value();
        return out;
    }
    static const parameters& checked(const parameters& p, Real h) {
        require_positive<Real>("servo_axis.step", h);
        require_positive<Real>("servo_axis.mass", p.mass);
        require_finite<Real>("servo_axis.force_constant", p.force_constant);
        require_not_negative<Real>("servo_axis.dead_zone", p.dead_zone);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            require(lane(p.limit, i) > 0, "servo_axis.limit", lane(p.limit, i), "must be above 0");
            require(detail::plain(lane(p.second.mass, i)) < lane(p.mass, i), "servo_axis.second.mass",
                    lane(p.second.mass, i),
                    "must lie below the mass, of which it is a part (" + detail::shortest(lane(p.mass, i)) +
                        ")");
        }
        require_finite<Real>("servo_axis.constant", p.constant);
        require_finite<Real>("servo_axis.spring", p.spring);
        require_finite<Real>("servo_axis.gravity", p.gravity);
        require_finite<Real>("servo_axis.gravity_phase", p.gravity_phase);
        require_not_negative<Real>("servo_axis.load_friction", p.load_friction);
        require_finite<Real>("servo_axis.coupling", p.coupling);
        const auto repeats = [](const char* name, const repeating& r) {
            require_positive<Real>({name, ".period"}, r.period);
            for (std::size_t i = 0; i < harmonics; ++i) {
                require_finite<Real>({name, ".cosine"}, r.cosine[i]);
                require_finite<Real>({name, ".sine"}, r.sine[i]);
            }
        };
        repeats("servo_axis.ripple", p.ripple);
        repeats("servo_axis.cogging", p.cogging);
        repeats("servo_axis.process", p.process);
        repeats("servo_axis.along", p.along);
        repeats("servo_axis.cyclic", p.cyclic);
        require_finite<Real>("servo_axis.process_mean", p.process_mean);
        require_finite<Real>("servo_axis.process_start", p.process_start);
        require_finite<Real>("servo_axis.drift", p.drift);
        require_positive<Real>("servo_axis.drift_time", p.drift_time);
        require_not_negative<Real>("servo_axis.play", p.play);
        require_not_negative<Real>("servo_axis.play_behind", p.play_behind);
        (void)play_between_masses<Real>(masses_apart(p), h);
        (void)amplifier_lag<Real>({p.lag}, h);
        (void)sprung_mass<Real>(p.second, h);
        (void)contact(p.friction, p.mass, h);
        return p;
    }

    /// A sum over harmonics with its period, up to the last harmonic that has a size in some lane.
    class sum {
    public:
        explicit sum(const repeating& r) : inverse_period_(Real(1) / Real(r.period)) {
            for (std::size_t i = 0; i < harmonics; ++i) {
                series_.cosine[i] = Real(r.cosine[i]);
                series_.sine[i] = Real(r.sine[i]);
            }
            while (series_.count > 0 && all(equal(series_.cosine[series_.count - 1], Real(0))) &&
                   all(equal(series_.sine[series_.count - 1], Real(0))))
                --series_.count;
        }
        bool present() const noexcept { return series_.count > 0; }
        Real operator()(Real z) const noexcept { return series_(z * inverse_period_); }

    private:
        Real inverse_period_;
        detail::harmonic_series<harmonics, Real, Real> series_;
    };
};

} // namespace quadrant::inline v0
