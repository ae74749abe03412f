// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../plant/servo_axis.hpp"
#include "plant_model.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Laws of effects at the joints of one plant. They are called through a pointer that this program set, so that
/// code for another instruction set may call them too.
class plant_laws {
public:
    using state = own_laws::memories;

    plant_laws() = default;
    explicit plant_laws(const own_laws& laws)
        : laws_(&laws), ask_([](const own_laws& of, joint where, const law_point& p, state& remembered) {
              return of.sum(where, p, remembered);
          }) {
        for (std::size_t i = 0; i < joint_count; ++i) at_[i] = laws.any_at(static_cast<joint>(i));
    }
    bool at(joint where) const noexcept { return at_[static_cast<std::size_t>(where)]; }
    double operator()(joint where, const law_point& p, state& remembered) const {
        return ask_(*laws_, where, p, remembered);
    }
    double operator()(joint where, const law_point& p, const state& remembered) const {
        state unchanged = remembered;
        return (*this)(where, p, unchanged);
    }

private:
    const own_laws* laws_ = nullptr;
    std::array<bool, joint_count> at_{};
    double (*ask_)(const own_laws&, joint, const law_point&, state&) = nullptr;
};

/// The same for plants side by side: asked lane by lane, where a plant has any.
template <class Real> class lane_laws {
    static constexpr std::size_t width = lane_count<Real>;

public:
    using state = std::array<plant_laws::state, width>;

    lane_laws() = default;
    template <class AxisOf> lane_laws(std::size_t count, const AxisOf& axis_of) {
        for (std::size_t i = 0; i < width; ++i) {
            laws_[i] = axis_of(i < count ? i : count - 1).laws;
            for (std::size_t j = 0; j < at_.size(); ++j) at_[j] = at_[j] || laws_[i].at(static_cast<joint>(j));
        }
    }
    bool at(joint where) const noexcept { return at_[static_cast<std::size_t>(where)]; }
    Real operator()(joint where, const joint_point<Real>& p, state& remembered) const {
        Real out(0);
        for (std::size_t i = 0; i < width; ++i)
            if (laws_[i].at(where))
                set_lane(out, i,
                         laws_[i](where,
                                  {lane(p.position, i), lane(p.velocity, i), lane(p.command, i),
                                   lane(p.time, i), lane(p.step, i)},
                                  remembered[i]));
        return out;
    }
    Real operator()(joint where, const joint_point<Real>& p, const state& remembered) const {
        state unchanged = remembered;
        return (*this)(where, p, unchanged);
    }

private:
    std::array<plant_laws, width> laws_{};
    std::array<bool, joint_count> at_{};
};

} // namespace detail

/// The library's axis with one plant of a diagnosis, and with one in each lane.
using plant_axis = servo_axis<double, detail::plant_laws>;
template <class Real> using plant_axes = servo_axis<Real, detail::lane_laws<Real>>;

/// What the axis of a plant is made from. The plant must live as long as the axis.
inline plant_axis::parameters axis_parameters(const plant_model& p) {
    const auto repeating = [](const harmonics& h) {
        plant_axis::repeating out;
        if (h.count == 0) return out;
        out.period = h.period;
        static_assert(plant_axis::harmonics == harmonics::most);
        std::copy_n(h.cosine.begin(), h.count, out.cosine.begin());
        std::copy_n(h.sine.begin(), h.count, out.sine.begin());
        return out;
    };
    const auto typed = []<class Quantity>(Quantity& to, double value) { to = Quantity::from_value(value); };

    plant_axis::parameters out;
    out.mass = p.moving_mass();
    out.force_constant = p.force_constant;
    out.dead_zone = p.dead_zone;
    out.limit = p.drive_limit;
    typed(out.lag, p.lag);
    out.ripple = repeating(p.ripple);
    out.constant = p.constant_force;
    out.spring = p.spring;
    out.gravity = p.weight();
    out.gravity_phase = p.gravity.phase;
    out.load_friction = p.friction.load;
    out.coupling = p.coupling;
    out.cogging = repeating(p.cogging);
    out.process = repeating(p.cutting);
    out.process_mean = p.cutting_mean;
    out.process_start = p.cutting_start;
    out.along = repeating(p.friction.along);
    out.drift = p.friction.drift();
    out.drift_time = p.friction.drift_time;
    out.play = p.backlash, out.play_behind = p.backlash_behind;
    out.motor_mass = p.mass_before_the_play(), out.motor_friction = p.motor_coulomb;
    out.cyclic = repeating(p.cyclic);
    out.laws = detail::plant_laws(p.own);
    typed(out.second.mass, p.second_mass());
    typed(out.second.centre, p.mode.frequency_Hz);
    out.second.damping = std::min(p.mode.damping, 0.999);

    auto& f = out.friction;
    typed(f.level, std::max(0.0, p.friction.coulomb));
    typed(f.excess, std::max(0.0, p.friction.excess));
    typed(f.stribeck_velocity, p.friction.stribeck_velocity);
    f.shape = p.friction.stribeck_exponent;
    typed(f.viscous, p.friction.viscous_slope);
    f.asymmetry = p.friction.coulomb_asymmetry;
    f.excess_asymmetry = p.friction.excess_asymmetry;
    f.velocity_asymmetry = p.friction.velocity_asymmetry;
    f.viscous_asymmetry = p.friction.viscous_asymmetry;
    typed(f.attraction, p.friction.contact.attraction);
    typed(f.damping, p.friction.contact.damping);
    const auto& contact = p.friction.contact;
    for (std::size_t i = 0; i < std::min(contact.elements, plant_axis::springs); ++i) {
        f.weights[i] = contact.weights[i];
        typed(f.stiffness[i], p.friction.stiffness(i));
        typed(f.give[i], contact.lengths()[i]);
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
