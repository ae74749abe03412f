// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hal_pins.hpp"

#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/axis_load.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <cmath>

/// A linear-motor axis for HAL, simulated: mass on Stribeck friction, cogging, input delay, amplifier, encoder.
namespace hal {

namespace signal = quadrant::signal;
using quadrant::duration;

class hal_plant {
    using cogging = quadrant::cogging_force<4>;
    using load = quadrant::axis_load<cogging>;
    using linear_motor = quadrant::linear_motor<quadrant::stribeck<>, 64, double, load>;

public:
    static constexpr const char *component = "quadrant_plant", *prefix = "quadrant-plant";

    struct parameters {
        linear_motor::parameters motor;
        double scale = 1000; ///< machine units per metre
    };
    static constexpr auto list() {
        using p = parameters;
        return std::array{
            field<p>("mass", 1, [](p& s) { return &s.motor.mass; }),
            field<p>("force-constant", 1, [](p& s) { return &s.motor.force_constant; }),
            field<p>("friction-coulomb", 0, [](p& s) { return &s.motor.friction.coulomb; }),
            field<p>("friction-static", 0, [](p& s) { return &s.motor.friction.static_level; }),
            field<p>("friction-velocity", 0.002, [](p& s) { return &s.motor.friction.stribeck_velocity; }),
            field<p>("friction-viscous", 0, [](p& s) { return &s.motor.friction.viscous; }),
            field<p>("friction-shape", 1, [](p& s) { return &s.motor.friction.shape; }),
            field<p>("delay", 0, [](p& s) { return &s.motor.delay; }),
            field<p>("limit", 10, [](p& s) { return &s.motor.limit; }),
            field<p>("dac-step", 0, [](p& s) { return &s.motor.dac_step; }),
            field<p>("encoder-step", 0, [](p& s) { return &s.motor.encoder_step; }),
            field<p>("substeps", 10, [](p& s) { return &s.motor.substeps; }),
            field<p>("cogging-period", 0.03, [](p& s) { return &s.motor.load.cogging.period; }),
            field<p>("cogging-1", 0, [](p& s) { return &s.motor.load.cogging.size[0]; }),
            field<p>("cogging-2", 0, [](p& s) { return &s.motor.load.cogging.size[1]; }),
            field<p>("cogging-3", 0, [](p& s) { return &s.motor.load.cogging.size[2]; }),
            field<p>("cogging-4", 0, [](p& s) { return &s.motor.load.cogging.size[3]; }),
            field<p>("cogging-phase-1", 0, [](p& s) { return &s.motor.load.cogging.phase[0]; }),
            field<p>("cogging-phase-2", 0, [](p& s) { return &s.motor.load.cogging.phase[1]; }),
            field<p>("cogging-phase-3", 0, [](p& s) { return &s.motor.load.cogging.phase[2]; }),
            field<p>("cogging-phase-4", 0, [](p& s) { return &s.motor.load.cogging.phase[3]; }),
            field<p>("scale", 1000, [](p& s) { return &s.scale; })};
    }

    struct pins {
        real_pin command, external, position;
        explicit pins(pin_maker& maker) {
            maker.make(command, HAL_IN, "command");
            maker.make(external, HAL_IN, "external");
            maker.make(position, HAL_OUT, "position");
        }
    };

    /// What no real axis shows: where the mass is and how it moves, before the encoder.
    struct wires {
        quantity<quadrant::si::length> position{};
        quantity<quadrant::si::velocity> velocity{};

        static constexpr auto taps() {
            return std::array{quadrant::tap<signal::position, &wires::position>("position"),
                              quadrant::tap<signal::velocity, &wires::velocity>("velocity")};
        }
    };

    hal_plant(const parameters& p, duration period) : given_(p), motor_(p.motor, period) {
        quadrant::require_positive("quadrant_plant.scale", p.scale);
        quadrant::require(!(p.motor.limit.value() > 0) || p.motor.dac_step <= p.motor.limit,
                          "quadrant_plant.dac_step", p.motor.dac_step,
                          "must not be above limit (" + quadrant::detail::shortest(p.motor.limit) + ")");
    }

    static constexpr auto taps() {
        static_assert(quadrant::every_wire_has_a_tap(wires::taps()));
        return wires::taps();
    }
    wires wire() const noexcept { return {motor_.now().x, motor_.now().v}; }

    /// A command that is no number leaves the axis where it is for this period.
    bool step(const pins& p) noexcept {
        const auto reading = motor_(quantity<quadrant::si::electric_potential>::from_value(p.command.get()),
                                    quantity<quadrant::si::force>::from_value(p.external.get()));
        p.position.set(given_.scale * reading.value());
        return !motor_.faulted();
    }

    /// Another axis in the place of this one; only at rest, so that no motion is lost.
    bool adopt(const hal_plant& next) noexcept {
        if (std::abs(motor_.now().v.value()) > 1e-6) return false;
        const auto x = motor_.now().x;
        *this = next;
        motor_.settle(x);
        return true;
    }

private:
    parameters given_;
    linear_motor motor_;
};

} // namespace hal
