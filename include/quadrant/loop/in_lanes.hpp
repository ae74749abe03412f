// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/lanes.hpp"
#include "../friction/maxwell_slip_lanes.hpp"
#include "../memory/repetitive_in_step.hpp"
#include "../observer/disturbance_observer.hpp"
#include "milling_axis_boxes.hpp"
#include "velocity_pair.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

/// The blocks of two axes of one kind as one block in two lanes: the same template with another number type,
/// and its parameters from those of both axes. An own block of a box becomes one by two overloads beside these,
/// `in_lanes_of` and `both`.
namespace quadrant::inline v0 {

/// The number type of two axes in the lanes of one register, x first.
using xy_number = lanes_in_step<2>;

namespace detail {
template <steps_together Real> struct velocity_boxes<Real> {
    velocity_boxes(const auto& p, duration period) : estimators({{p.estimator_corner}, p.notch}, period) {}

    velocity_pair<Real> estimators;
};

template <class Block> struct in_lanes_of;
template <signal_tag In, signal_tag Out> struct in_lanes_of<absent<In, Out, double>> {
    using type = absent<In, Out, xy_number>;
};
template <signal_tag In, signal_tag Out> struct in_lanes_of<stribeck<In, Out, double>> {
    using type = stribeck<In, Out, xy_number>;
};
template <std::size_t N, signal_tag In, signal_tag Out> struct in_lanes_of<maxwell_slip<N, In, Out, double>> {
    using type = maxwell_slip<N, In, Out, xy_number>;
};
template <signal_tag Command, signal_tag Measured, std::size_t N, std::size_t M, std::size_t P, std::size_t Z>
struct in_lanes_of<disturbance_observer<Command, Measured, N, M, P, Z, double>> {
    using type = disturbance_observer<Command, Measured, N, M, P, Z, xy_number>;
};
template <signal_tag Signal, std::size_t Capacity, std::size_t Order, std::size_t L, std::size_t Q>
struct in_lanes_of<repetitive<Signal, Capacity, Order, L, Q, double>> {
    using type = repetitive<Signal, Capacity, Order, L, Q, xy_number>;
};
template <class F, class D, class M, signal_tag Command>
struct in_lanes_of<milling_axis_boxes<F, D, M, double, Command>> {
    using type = milling_axis_boxes<typename in_lanes_of<F>::type, typename in_lanes_of<D>::type,
                                    typename in_lanes_of<M>::type, xy_number, Command>;
};

inline xy_number both(double x, double y) noexcept { return xy_number(std::array{x, y}); }
template <class Unit>
quantity<Unit, xy_number> both(const quantity<Unit>& x, const quantity<Unit>& y) noexcept {
    return quantity<Unit, xy_number>::from_value(both(x.value(), y.value()));
}
template <class Each, std::size_t N> auto both(const std::array<Each, N>& x, const std::array<Each, N>& y) {
    std::array<decltype(both(x[0], y[0])), N> out;
    for (std::size_t i = 0; i < N; ++i) out[i] = both(x[i], y[i]);
    return out;
}
/// What is no number has to be the same on both axes.
template <class Value> Value common(const char* field, const Value& x, const Value& y) {
    if constexpr (std::is_integral_v<Value>)
        require(x == y, field, double(y), "must be the same on both axes");
    else
        require(x == y, field, y, "must be the same on both axes");
    return x;
}

template <class In, class Out>
typename absent<In, Out, xy_number>::parameters both(std::type_identity<absent<In, Out>>, const auto&,
                                                     const auto&) {
    return {};
}
template <class In, class Out>
typename stribeck<In, Out, xy_number>::parameters both(std::type_identity<stribeck<In, Out>>, const auto& x,
                                                       const auto& y) {
    return {both(x.coulomb, y.coulomb), both(x.static_level, y.static_level),
            both(x.stribeck_velocity, y.stribeck_velocity), both(x.viscous, y.viscous),
            common("in_lanes.shape", x.shape, y.shape)};
}
template <std::size_t N, class In, class Out>
typename maxwell_slip<N, In, Out, xy_number>::parameters both(std::type_identity<maxwell_slip<N, In, Out>>,
                                                              const auto& x, const auto& y) {
    return {both(std::type_identity<stribeck<In, Out>>(), x.curve, y.curve), both(x.weights, y.weights),
            both(x.forces, y.forces), both(x.stiffness, y.stiffness), both(x.attraction, y.attraction)};
}
template <class C, class Z, std::size_t N, std::size_t M, std::size_t P, std::size_t Zeros>
typename disturbance_observer<C, Z, N, M, P, Zeros, xy_number>::parameters
both(std::type_identity<disturbance_observer<C, Z, N, M, P, Zeros>>, const auto& x, const auto& y) {
    return {both(x.corner, y.corner),
            {both(x.plant.numerator, y.plant.numerator), both(x.plant.denominator, y.plant.denominator)}};
}
template <class S, std::size_t C, std::size_t O, std::size_t L, std::size_t Q>
typename repetitive<S, C, O, L, Q, xy_number>::parameters both(std::type_identity<repetitive<S, C, O, L, Q>>,
                                                               const auto& x, const auto& y) {
    return {both(x.cycle, y.cycle),         both(x.weights, y.weights),
            both(x.learning, y.learning),   common("in_lanes.ahead", x.ahead, y.ahead),
            both(x.smoothing, y.smoothing), common("in_lanes.fade", x.fade, y.fade)};
}
template <class F, class D, class M, class C>
typename in_lanes_of<milling_axis_boxes<F, D, M, double, C>>::type::parameters
both(std::type_identity<milling_axis_boxes<F, D, M, double, C>>, const auto& x, const auto& y) {
    return {.position_gain = both(x.position_gain, y.position_gain),
            .velocity_gain = both(x.velocity_gain, y.velocity_gain),
            .velocity_integral = both(x.velocity_integral, y.velocity_integral),
            .estimator_corner = both(x.estimator_corner, y.estimator_corner),
            .notch = {both(x.notch.centre, y.notch.centre), both(x.notch.width, y.notch.width)},
            .plant_gain = both(x.plant_gain, y.plant_gain),
            .plant_pole = both(x.plant_pole, y.plant_pole),
            .friction = both(std::type_identity<F>(), x.friction, y.friction),
            .disturbance = both(std::type_identity<D>(), x.disturbance, y.disturbance),
            .memory = both(std::type_identity<M>(), x.memory, y.memory),
            .limit = both(x.limit, y.limit),
            .dac_step = both(x.dac_step, y.dac_step)};
}
} // namespace detail

/// Names the boxes of an axis whose twin lies beside it in the lanes of a register:
/// `xy_control<in_lanes<boxes>>`.
template <class Boxes> struct in_lanes {
    using alone = Boxes;                                        ///< of one axis, in double
    using together = typename detail::in_lanes_of<Boxes>::type; ///< of both
    using parameters = typename Boxes::parameters;              ///< of one axis

    /// The boxes of both axes, from the parameters of each.
    static together of(const parameters& x, const parameters& y, duration period) {
        return {detail::both(std::type_identity<Boxes>(), x, y), period};
    }
};

} // namespace quadrant::inline v0
