// SPDX-License-Identifier: BSL-1.0
// What the concepts accept and what they refuse, in pairs. Nothing runs: this file compiles or it does not.
#include <quadrant/quadrant.hpp>

#include <doctest/doctest.h>

using namespace quadrant;
namespace s = quadrant::signal;

// signal_tag
static_assert(signal_tag<s::velocity>);
static_assert(!signal_tag<double>);
namespace {
struct no_text {
    using unit = si::length;
};
struct mine {
    using unit = si::length;
    static constexpr const char* text = "m";
};
} // namespace
static_assert(signal_tag<mine>);
static_assert(!signal_tag<no_text>);

// rate_of
static_assert(rate_of<s::velocity, s::position>);
static_assert(!rate_of<s::position, s::velocity>);
static_assert(rate_of<s::acceleration, s::velocity>);
static_assert(!rate_of<s::acceleration, s::position>);

// Units that a parameter must have
static_assert(std::same_as<gain_of<s::velocity, s::position>, per_second>);
static_assert(!std::is_convertible_v<frequency, per_second> && !std::is_convertible_v<per_second, frequency>);
static_assert(!std::is_convertible_v<frequency, quantity<si::angular_velocity>>);
static_assert(std::same_as<gain_of<s::force, s::force>, quantity<si::dimensionless>>);
static_assert(!std::same_as<gain_of<s::force, s::velocity>, gain_rate_of<s::force, s::velocity>>);
static_assert(std::same_as<gain_rate_of<s::force, s::velocity>, gain_of<s::force, s::position>>);
static_assert(std::same_as<parameter_real<float>, double>);
static_assert(std::same_as<parameter_real<dual<2>>, dual<2>>);

// maps
static_assert(maps<notch<s::force>, s::force, s::force>);
static_assert(!maps<notch<s::force>, s::voltage, s::voltage>);
static_assert(maps<proportional<s::position, s::velocity>, s::position, s::velocity>);
static_assert(!maps<proportional<s::position, s::velocity>, s::velocity, s::position>);
static_assert(maps<notch<s::force, float>, s::force, s::force>);          // in its own number type
static_assert(!maps<notch<s::force, float>, s::force, s::force, double>); // not in another
namespace {
struct users_own { // two members are enough
    quantity<si::force> operator()(quantity<si::force> x) { return x; }
    void reset() {}
};
struct without_reset {
    quantity<si::force> operator()(quantity<si::force> x) { return x; }
};
struct bare_double {
    double operator()(double x) { return x; }
    void reset() {}
};
} // namespace
static_assert(maps<users_own, s::force, s::force>);
static_assert(!maps<without_reset, s::force, s::force>);
static_assert(!maps<bare_double, s::force, s::force>);
static_assert(!maps<users_own, double, s::force>);

// A differentiator needs a rate, a fractional delay an order it has, a PI a rule it knows
template <class In, class Out>
concept differentiates = requires {
    typename backward_difference<In, Out>;
};
static_assert(differentiates<s::position, s::velocity>);
static_assert(!differentiates<s::position, s::acceleration>);
template <std::size_t Order, std::size_t Capacity>
concept delays = requires {
    typename fractional_delay<s::force, Capacity, Order>;
};
static_assert(delays<1, 4> && delays<3, 4> && delays<1, 0>);
static_assert(!delays<2, 4> && !delays<0, 4> && !delays<3, 0>);
template <class Rule>
concept winds_up = requires {
    typename proportional_integral<s::velocity, s::force, Rule>;
};
static_assert(winds_up<integral_clamp> && winds_up<conditional_integration> && winds_up<back_calculation>);
static_assert(!winds_up<double>);

// series: one signal, one number type
template <class... Blocks>
concept chains = requires {
    typename series<Blocks...>;
};
static_assert(chains<notch<s::force>, lowpass<s::force>>);
static_assert(!chains<notch<s::force>, lowpass<s::voltage>>);
static_assert(!chains<notch<s::force>, lowpass<s::force, float>>);
static_assert(!chains<proportional<s::position, s::velocity>>);

// axis_boxes: the stock ones, a swapped box of the same kind, a wrong one, a missing one
namespace {
using stock = cascade_p_pi_boxes<>;
struct swapped : stock {
    absent<s::velocity, s::voltage> friction;
};
struct wrong_signal : stock {
    notch<s::force> resonance;
};
struct wrong_number : stock {
    limiter<s::voltage, float> amplifier;
};
struct not_a_box : stock {
    double dac;
};
struct nothing {};
struct one_missing {
    decltype(stock::reference_velocity) reference_velocity;
    decltype(stock::reference_acceleration) reference_acceleration;
    decltype(stock::measured_velocity) measured_velocity;
    decltype(stock::position_loop) position_loop;
    decltype(stock::velocity_feedforward) velocity_feedforward;
    decltype(stock::velocity_loop) velocity_loop;
    decltype(stock::resonance) resonance;
    decltype(stock::acceleration_feedforward) acceleration_feedforward;
    decltype(stock::amplifier) amplifier;
    decltype(stock::dac) dac;
};
struct complete : one_missing {
    decltype(stock::friction) friction;
};
} // namespace
static_assert(axis_boxes<stock>);
static_assert(axis_boxes<swapped>);
static_assert(axis_boxes<complete>);
static_assert(!axis_boxes<one_missing>);
static_assert(!axis_boxes<wrong_signal>);
static_assert(!axis_boxes<wrong_number>);
static_assert(!axis_boxes<not_a_box>);
static_assert(!axis_boxes<nothing>);

// A step never throws, and blocks copy without help
static_assert(noexcept(std::declval<notch<s::force>&>().reset()));
static_assert(std::is_copy_constructible_v<cascade<stock>> && std::is_copy_assignable_v<cascade<stock>>);
static_assert(std::is_aggregate_v<cascade<stock>>);

TEST_CASE("concepts: this file compiled") { CHECK(true); }
