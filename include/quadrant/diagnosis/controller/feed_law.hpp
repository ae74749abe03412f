// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../feedforward/friction_feedforward.hpp"
#include "../../filter/filtered_derivative.hpp"
#include "../../friction/asymmetric_stribeck.hpp"
#include "../../loop/feed_control.hpp"
#include "../../observer/kalman.hpp"
#include "kind.hpp"

#include <optional>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Dry friction in volts, added to the command as the reference will cause it; or nothing.
class known_friction {
    using curve = asymmetric_stribeck<signal::velocity, signal::voltage>;
    using feedforward = friction_feedforward<curve>;

public:
    using input = signal::velocity;
    using output = signal::voltage;
    using value = quantity_of<signal::voltage>;
    using parameters = std::optional<feedforward::parameters>;

    known_friction(const parameters& p, duration period) {
        if (p) law_.emplace(*p, period);
    }
    value operator()(quantity_of<signal::velocity> v) noexcept { return law_ ? (*law_)(v) : value(); }
    void reset() noexcept {
        if (law_) law_->reset();
    }
    void settle(quantity_of<signal::velocity> v) noexcept {
        if (law_) law_->settle(v);
    }
    bool faulted() const noexcept { return law_ && law_->faulted(); }

    static parameters of(const given_values& v) {
        if (!v.has_box("friction")) return {};
        const auto side = [&](std::size_t i) {
            return curve::side{in_si(v.list("friction.static_V")[i]), in_si(v.list("friction.coulomb_V")[i]),
                               in_si(v.list("friction.fall_m_per_s")[i]),
                               in_si(v.list("friction.rise_m_per_s")[i])};
        };
        return feedforward::parameters{.law = {side(0), side(1), {}},
                                       .force_constant = in_si(1.0),
                                       .width = in_si(v["friction.width_m_per_s"]),
                                       .scale = v["friction.scale"],
                                       .rest = at_rest::held};
    }

private:
    std::optional<feedforward> law_;
};

/// A law of a feed axis with what stands beside and behind it. The velocity is the measured one, or that of a
/// filter; a Kalman filter gives the position, too. A law that is `Taught` remembers its commands or estimates
/// from them: the log tells it what was applied where it begins, and in every row where it cannot run alone.
template <class Law, bool Taught> class feed_loop final : public running_controller {
    using boxes = feed_control_boxes<Law, known_friction>;
    using estimator = filtered_derivative<signal::position, signal::velocity>;
    using state_filter = kalman<signal::voltage>;

public:
    feed_loop(const given_values& v, const actuator_description& a, double period,
              const typename Law::parameters& law)
        : control_{.box = {{.law = law,
                            .friction = known_friction::of(v),
                            .limit = in_si(stage_of(a).limit),
                            .dac_step = in_si(stage_of(a).dac_step)},
                           duration::from_value(period)}},
          past_(std::max<std::size_t>(100, static_cast<std::size_t>(0.05 / period))) {
        if (v.has("velocity_filter_Hz"))
            velocity_.emplace(estimator::parameters{.corner = in_si(v["velocity_filter_Hz"])},
                              duration::from_value(period));
    }
    void estimate_by(const state_filter::parameters& p, double period) {
        states_.emplace(p, duration::from_value(period));
    }
    std::unique_ptr<running_controller> copy() const override { return std::make_unique<feed_loop>(*this); }
    double step(const axis_motion<>& asked, const axis_measurement<>& measured) override {
        axis_measurement<> now = measured;
        if (velocity_) now.velocity = (*velocity_)(measured.position);
        if (states_) {
            now.velocity = (*states_)(measured.position, in_si(applied_)); // z^-1
            now.position = states_->position();
        }
        return applied_ = control_(asked, now).value();
    }
    void applied(double command) override {
        if (told_) tell(command);
    }
    double show(const axis_motion<>& asked, const axis_measurement<>& measured, double command) override {
        const double u = step(asked, measured);
        if constexpr (Taught) tell(command);
        return Taught ? command : u;
    }
    bool remembers() const override { return !told_; }
    /// Alone, without an axis that answers, its command grows without bound: it can be replayed only row by
    /// row.
    bool grows() {
        constexpr int rows = 10000;
        settle({.command = 1});
        for (int k = 0; k < rows; ++k)
            if (!(std::abs(step({}, {})) < 10)) return true;
        return false;
    }
    void told_always(bool yes) { told_ = yes; }
    void settle(const loop_start& row) override {
        control_.settle(in_si(row.measured), in_si(row.command));
        if (velocity_) velocity_->settle(in_si(row.measured));
        if (states_) states_->settle(in_si(row.measured));
        applied_ = row.command;
    }
    std::size_t past() const override { return past_ + lead(); }
    std::size_t lead() const override {
        if constexpr (requires { Law::most_lead; })
            return control_.box.law.lead();
        else
            return 0;
    }
    double due() const override { return control_.wire.reference.value(); }
    bool limited() const override { return control_.limited(); }
    bool faulted() const override { return control_.faulted(); }

private:
    void tell(double command) {
        applied_ = command;
        if constexpr (Taught) {
            const auto u = quantity_of<signal::voltage>::from_value(command);
            // Within a step of the converter it is what the law asked for, which the law knows better than the
            // log.
            if (std::abs(command - control_.wire.limited.value()) > control_.box.dac.given().step.value())
                control_.box.law.applied(control_.wire.feedback + (u - control_.wire.wanted));
        }
    }

    feed_control<boxes> control_;
    std::optional<estimator> velocity_;
    std::optional<state_filter> states_;
    std::size_t past_;
    double applied_ = 0; ///< since the last row [V]
    bool told_ = false;  ///< by the log, in every row
};

template <class Law, bool Taught>
std::unique_ptr<running_controller> make_feed_loop(const given_values& v, const actuator_description& a,
                                                   double period, const typename Law::parameters& law) {
    auto loop = std::make_unique<feed_loop<Law, Taught>>(v, a, period, law);
    if constexpr (Taught) loop->told_always(feed_loop<Law, Taught>(v, {}, period, law).grows());
    return loop;
}

/// What a law believes of the axis.
inline axis_model<signal::voltage> believed_plant(const given_values& v) {
    return {in_si(v["plant_gain_m_per_s2_V"]), in_si(v["plant_damping_per_s"])};
}

} // namespace detail

namespace controllers {

/// Keys that every law of a feed axis has.
inline constexpr std::array<controller_key, 7> feed_law_keys{{
    {.name = "velocity_filter_Hz",
     .says = "corner of a filtered derivative of the position, in place of the measured velocity",
     .rule = detail::rule::positive,
     .otherwise = std::numeric_limits<double>::infinity()},
    {.name = "friction.static_V",
     .says = "friction fed forward, forward and backward: level at rest",
     .rule = detail::rule::not_negative,
     .needed = true,
     .form = key_form::list,
     .least = 2,
     .most = 2},
    {.name = "friction.coulomb_V",
     .says = "level at speed",
     .rule = detail::rule::not_negative,
     .needed = true,
     .form = key_form::list,
     .least = 2,
     .most = 2},
    {.name = "friction.fall_m_per_s",
     .says = "velocity over which the static part falls",
     .rule = detail::rule::positive,
     .needed = true,
     .form = key_form::list,
     .least = 2,
     .most = 2},
    {.name = "friction.rise_m_per_s",
     .says = "velocity over which the Coulomb part rises",
     .rule = detail::rule::positive,
     .needed = true,
     .form = key_form::list,
     .least = 2,
     .most = 2},
    {.name = "friction.width_m_per_s",
     .says = "velocity over which its sign turns",
     .rule = detail::rule::positive,
     .needed = true},
    {.name = "friction.scale",
     .says = "share of it that is fed forward",
     .rule = detail::rule::not_negative,
     .otherwise = 1},
}};
/// What a law that knows the plant believes of it.
inline constexpr std::array<controller_key, 2> believed_plant_keys{{
    {.name = "plant_gain_m_per_s2_V",
     .says = "acceleration per command of the axis, as the law believes it",
     .rule = detail::rule::positive,
     .needed = true},
    {.name = "plant_damping_per_s",
     .says = "viscous friction over mass, as the law believes it",
     .rule = detail::rule::not_negative},
}};

} // namespace controllers
} // namespace quadrant::inline v0::diagnosis
