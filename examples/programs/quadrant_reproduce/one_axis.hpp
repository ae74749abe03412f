// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "thesis.hpp"

#include <quadrant/control/quantizer.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/plant/linear_motor.hpp>

namespace thesis {

/// What an experiment of one axis is made from.
template <class Boxes, class Motor> struct one_axis_parameters {
    typename Boxes::parameters controller;
    typename Motor::parameters motor;
    quantity<si::length> encoder{}; ///< 0: none
};

/// One axis by itself: a `milling_axis`, a motor, an encoder. Tests put an axis of an `xy_loop` in its place.
template <class Boxes, class Motor> class one_axis {
public:
    using loop = milling_axis<Boxes>;
    using motion = typename loop::motion;

    explicit one_axis(const one_axis_parameters<Boxes, Motor>& p)
        : loop_{.box = {p.controller, period}}, motor_(p.motor, period), encoder_({p.encoder}, period) {}

    void step(const motion& now, const motion& ahead, quantity_of<signal::force> push = {}) {
        motor_(loop_(now, ahead, encoder_(motor_.now().x)), push);
    }
    auto now() const { return motor_.now(); } ///< of the axis, not of its encoder
    auto& disturbance() { return loop_.box.disturbance; }
    bool stopped() const { return motor_.faulted() || loop_.faulted() || loop_.limited(); }

private:
    loop loop_;
    Motor motor_;
    quantizer<signal::position> encoder_;
};

/// The axis without friction of its own: mass, viscous part and delay of the model.
inline linear_motor<coulomb_viscous<>>::parameters linear_machine(const axis& a, duration delay,
                                                                  std::size_t substeps) {
    const quantity<si::mass> mass = a.kf / a.B;
    return {.mass = mass,
            .force_constant = a.kf,
            .friction = {.viscous = a.A * mass},
            .delay = delay,
            .substeps = substeps};
}

} // namespace thesis
