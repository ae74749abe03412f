// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../feedforward/cogging_harmonics.hpp"
#include "../../feedforward/friction_feedforward.hpp"
#include "../../filter/backward_difference.hpp"
#include "../../friction/maxwell_slip.hpp"
#include "../../friction/stribeck.hpp"
#include "../model/plant_model.hpp"

#include <span>

namespace quadrant::inline v0::diagnosis {

/// What a compensator is made of. The command's unit is that of the machine file, called volts here.
using level_block = friction_feedforward<stribeck<>, signal::voltage>; ///< friction by its level
using contact_block =
    maxwell_slip<friction_contact::most, signal::velocity, signal::voltage>; ///< with its give
using travel_block = cogging_harmonics<harmonics::most, signal::voltage>;    ///< what repeats along the travel

/// Friction by its level over speed: Coulomb and Stribeck friction of a fitted plant, without the viscous part,
/// which the cascade has a key for. At rest it is off: what still pushes there makes a stopped axis creep on.
inline level_block::parameters level_parameters(const plant_model& p) {
    const auto& f = p.friction;
    const double widest = 1e-4; // [m/s], far below any path
    const double narrow = f.excess > 0 ? std::min(widest, f.stribeck_velocity / 20) : widest;
    return {.law = {.coulomb = quantity_of<signal::force>::from_value(f.coulomb),
                    .static_level = quantity_of<signal::force>::from_value(f.coulomb + std::max(0.0, f.excess)),
                    .stribeck_velocity = quantity_of<signal::velocity>::from_value(f.stribeck_velocity),
                    .shape = f.stribeck_exponent},
            .force_constant = gain_of<signal::force, signal::voltage>::from_value(p.force_constant),
            .width = quantity_of<signal::velocity>::from_value(narrow),
            .rest = at_rest::off};
}

/// The same with the give of the contact: its elements, split until there are as many as the block has.
inline contact_block::parameters contact_parameters(const plant_model& p, double period) {
    const auto& f = p.friction;
    const double volts = 1 / p.force_constant, level = (f.coulomb + std::max(0.0, f.excess)) * volts;
    auto weights = f.contact.weights, lengths = f.contact.lengths();
    for (std::size_t n = f.contact.elements; n < weights.size(); ++n) { // two halves slip together: one element
        const auto end = weights.begin() + static_cast<std::ptrdiff_t>(n);
        const auto largest = static_cast<std::size_t>(std::max_element(weights.begin(), end) - weights.begin());
        weights[n] = weights[largest] /= 2;
        lengths[n] = lengths[largest];
    }
    double sum = 0;
    for (double w : weights) sum += w;
    contact_block::parameters out;
    out.curve = {.coulomb = quantity_of<signal::voltage>::from_value(std::max(f.coulomb * volts, 1e-6 * level)),
                 .static_level = quantity_of<signal::voltage>::from_value(level),
                 .stribeck_velocity = quantity_of<signal::velocity>::from_value(f.stribeck_velocity),
                 .shape = f.stribeck_exponent};
    for (std::size_t i = 0; i < weights.size(); ++i) {
        out.weights[i] = weights[i] / sum;
        out.stiffness[i] =
            gain_rate_of<signal::voltage, signal::velocity>::from_value(out.weights[i] * level / lengths[i]);
    }
    out.attraction = decltype(out.attraction)::from_value(level / period); // slips within a period
    return out;
}

/// A force that repeats along the travel, as the command that makes `gain` times it.
inline travel_block::parameters travel_parameters(const harmonics& force, double gain) {
    travel_block::parameters out{.pitch = quantity_of<signal::position>::from_value(force.period)};
    for (std::size_t i = 0; i < harmonics::most; ++i) {
        out.harmonics[i].order = static_cast<unsigned>(i + 1);
        if (i >= force.count) continue;
        out.harmonics[i].amplitude =
            quantity_of<signal::voltage>::from_value(gain * std::hypot(force.sine[i], force.cosine[i]));
        out.harmonics[i].phase = std::atan2(force.cosine[i], force.sine[i]);
    }
    return out;
}
/// The command that holds the axis against its cogging.
inline travel_block::parameters cogging_parameters(const plant_model& p) {
    return travel_parameters(p.cogging, -1 / p.force_constant);
}

/// Which forces of a plant a compensator pays.
struct compensated_forces {
    bool level = false;                    ///< Coulomb and Stribeck friction by level
    bool contact = false;                  ///< the same with the give of the contact; instead of level
    bool asymmetry = false, along = false; ///< what friction differs by direction and along the travel
    bool cogging = false, constant = false, spring = false;
    bool operator==(const compensated_forces&) const = default;
};

/// What a controller adds to its command so that the axis need not be late first: forces of a fitted plant,
/// computed from the reference alone.
///   u = friction(v_ref) + (a_c Fc + a_v B |v_ref|)/kf + Fc along(r) side/kf + cogging(r) + (k r - F)/kf
/// Ports: position reference [m] in, command out, to be added before or behind the controller's limit. Nothing
/// measured goes in, so that no gain or delay margin changes. State: that of the blocks.
class compensator {
public:
    compensator(const plant_model& p, const compensated_forces& what, double period)
        : what_(what), period_(period), velocity_({}, duration::from_value(period)),
          level_(level_parameters(p), duration::from_value(period)) {
        const double volts = 1 / p.force_constant;
        const auto& f = p.friction;
        const auto step = duration::from_value(period);
        if (what.contact) contact_.emplace(contact_parameters(p, period), step);
        if (what.along && f.along.count > 0)
            along_.emplace(travel_parameters(f.along, f.coulomb * volts), step);
        if (what.cogging && p.cogging.count > 0) cogging_.emplace(cogging_parameters(p), step);
        if (what.constant) constant_ -= p.constant_force * volts;
        if (what.asymmetry) {
            constant_ += f.coulomb_asymmetry * f.coulomb * volts;
            by_speed_ = f.viscous_asymmetry * f.viscous_slope * volts;
        }
        if (what.spring) by_position_ = p.spring * volts;
    }

    double operator()(double reference) noexcept {
        const auto r = quantity_of<signal::position>::from_value(reference);
        const auto v = velocity_(r);
        const double friction = level_(v).value();
        double u = constant_ + by_speed_ * std::abs(v.value()) + by_position_ * reference;
        if (what_.level) u += friction;
        if (contact_) u += (*contact_)(v).value();
        if (along_) u += (*along_)(r).value() * level_.now().side;
        if (cogging_) u += (*cogging_)(r).value();
        return u;
    }
    /// As if the reference had come to here at this velocity for ever.
    void settle(double reference, double velocity) noexcept {
        const auto v = quantity_of<signal::velocity>::from_value(velocity);
        velocity_.settle(quantity_of<signal::position>::from_value(reference), v);
        level_.settle(v);
        if (contact_) contact_->settle(v);
    }
    /// The whole reference of a log.
    std::vector<double> operator()(std::span<const double> reference) {
        const double v = reference.size() > 1 ? (reference[1] - reference[0]) / period_ : 0;
        settle(reference[0] - v * period_, v);
        std::vector<double> out;
        for (double r : reference) out.push_back((*this)(r));
        return out;
    }

private:
    compensated_forces what_;
    double period_, constant_ = 0, by_speed_ = 0, by_position_ = 0;
    backward_difference<signal::position, signal::velocity> velocity_;
    level_block level_; // whose sign is that of the motion, also when its force is not asked for
    std::optional<contact_block> contact_;
    std::optional<travel_block> along_, cogging_;
};

} // namespace quadrant::inline v0::diagnosis
