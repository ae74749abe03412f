// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"
#include "play_between_masses.hpp"
#include "sprung_mass.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// Motion of motor and load of a `servo_axis`, and what its joints remember.
template <class Real, class Contact, class Laws> struct servo_state {
    Real x{0}, v{0};         ///< of the motor [m], [m/s]
    Real load{0};            ///< of the load [m]
    mask_of<Real> carried{}; ///< the motor moves the load: the play is crossed
    Real current{0};         ///< behind the amplifier's lag
    typename sprung_mass<Real>::state second{};
    typename play_between_masses<Real>::state apart{};
    typename Contact::state friction{};
    typename Laws::state laws{};

    /// An observer's correction moves the whole axis.
    void shift(Real dx, Real dv) noexcept {
        x += dx;
        load += dx;
        v += dv;
        apart.load += dx;
        apart.w += dv;
    }
    /// Who leads the axis along a motion moves what the motor drives: the second mass stays where it is.
    void lead(Real dx, Real dv) noexcept {
        shift(dx, dv);
        second.q -= dx;
        second.w -= dv;
    }
    /// Another state in the lanes that `here` picks.
    void take(const mask_of<Real>& here, const servo_state& other) noexcept {
        const auto put = [&](Real& to, const Real& from) { to = select(here, from, to); };
        const auto choose = [&](mask_of<Real>& to, const mask_of<Real>& from) {
            to = either(both(here, from), both(!here, to));
        };
        put(x, other.x);
        put(v, other.v);
        put(load, other.load);
        choose(carried, other.carried);
        put(current, other.current);
        put(second.q, other.second.q);
        put(second.w, other.second.w);
        put(apart.load, other.apart.load);
        put(apart.w, other.apart.w);
        put(apart.flank, other.apart.flank);
        take_friction(here, other.friction);
        take_memory(here, other.laws);
    }
    void take_memory(const mask_of<Real>& here, const typename Laws::state& other) noexcept {
        if constexpr (requires { laws[0]; }) { // one a lane
            const Real one = select(here, Real(1), Real(0));
            for (std::size_t i = 0; i < lane_count<Real>; ++i)
                if (lane(one, i) != 0) laws[i] = other[i];
        } else if (any(here)) {
            laws = other;
        }
    }
    void take_friction(const mask_of<Real>& here, const typename Contact::state& other) noexcept {
        for (std::size_t i = 0; i < friction.force.size(); ++i) {
            friction.force[i] = select(here, other.force[i], friction.force[i]);
            friction.slips[i] = either(both(here, other.slips[i]), both(!here, friction.slips[i]));
        }
    }
    static servo_state at(Real position, Real velocity = Real(0)) noexcept {
        servo_state s;
        s.x = s.load = s.apart.load = position;
        s.v = s.apart.w = velocity;
        return s;
    }
};

} // namespace quadrant::inline v0
