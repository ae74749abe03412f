// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/absent.hpp"
#include "../block/maps.hpp"

namespace quadrant::inline v0 {

namespace detail {
/// A ripple box takes force and position, or, as `through` does, the force alone.
template <class R, class Real>
concept ripple_box = maps<R, signal::force, signal::force, Real> ||
    (requires(R r, quantity_of<signal::force, Real> f, quantity_of<signal::position, Real> x) {
        { r(f, x) } -> std::same_as<quantity_of<signal::force, Real>>;
        r.reset();
    });
} // namespace detail

/// What a motor's force meets on its way to the mass, box by box, in every sub-step of a `linear_motor`:
///   rippled = ripple(motor, x);  drive = rippled + cogging(x) + external;  bent = modes(drive)
/// The modes are excited by all but friction; what they add to the reading is deflection().
/// Ports: load(x, motor, external) gives the force that drives the mass; position [m], forces [N].
/// State: that of the boxes; `reset` as new.
/// NaN and infinities: as the boxes; the plant around goes back to where it was.
/// Cost: that of the boxes; `absent` and `through` cost nothing. Throws in the names of the boxes.
template <class Cogging = absent<signal::position, signal::force>, class Ripple = through<signal::force>,
          class Modes = absent<signal::force, signal::position>, class Real = double>
requires maps<Cogging, signal::position, signal::force, Real> && detail::ripple_box<Ripple, Real> &&
    maps<Modes, signal::force, signal::position, Real>
class axis_load {
public:
    using position = quantity_of<signal::position, Real>;
    using force = quantity_of<signal::force, Real>;

    /// Those of the boxes, in the order in which a force passes them.
    struct parameters {
        typename Cogging::parameters cogging{};
        typename Ripple::parameters ripple{};
        typename Modes::parameters modes{}; ///< their mass is that of the motor
    };

    axis_load(const parameters& p, duration period)
        : cogging_(p.cogging, period), ripple_(p.ripple, period), modes_(p.modes, period) {}

    force operator()(position x, force motor, force external) noexcept {
        const force drive = rippled(motor, x) + cogging_(x) + external;
        deflection_ = modes_(drive);
        return drive;
    }
    void reset() noexcept {
        cogging_.reset();
        ripple_.reset();
        modes_.reset();
        deflection_ = position();
    }

    bool faulted() const noexcept {
        return detail::is_faulted(cogging_) || detail::is_faulted(ripple_) || detail::is_faulted(modes_);
    }
    position deflection() const noexcept { return deflection_; } ///< at the end of the last sub-step
    const Cogging& cogging() const noexcept { return cogging_; }
    const Ripple& ripple() const noexcept { return ripple_; }
    const Modes& modes() const noexcept { return modes_; }

private:
    force rippled(force motor, position x) noexcept {
        if constexpr (requires { ripple_(motor, x); })
            return ripple_(motor, x);
        else
            return ripple_(motor);
    }

    Cogging cogging_;
    Ripple ripple_;
    Modes modes_;
    position deflection_{};
};

} // namespace quadrant::inline v0
