// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/literals.hpp>
#include <quadrant/block/absent.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/control/dead_band.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/proportional.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/control/rate_limiter.hpp>
#include <quadrant/feedforward/friction_feedforward.hpp>
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>
#include <quadrant/loop/cascade.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/memory/fractional_delay.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/observer/disturbance_observer.hpp>

#include <array>
#include <cstddef>
#include <tuple>

/// Every block that runs in lanes, once. `own` gives each lane parameters of its own.
namespace lanes_conformance {

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;
inline const duration T = 500_us;

/// Parameter number n of lane i: up to a fifth off what the block's line says.
inline double scaled(double x, std::size_t i, std::size_t n) {
    return x * (1 + 0.03 * double(i) + 0.01 * double((7 * n + 3 * i) % 5));
}
/// Hands out parameters: for lanes those of every lane, for double those of lane `which`.
template <class Real> struct own {
    std::size_t which = 0, count = 0;

    Real operator()(double x) {
        const std::size_t n = count++;
        if constexpr (multi_lane<Real>) {
            Real out;
            for (std::size_t i = 0; i < lane_count<Real>; ++i) out.set(i, scaled(x, i, n));
            return out;
        } else
            return scaled(x, which, n);
    }
    template <class Unit> quantity<Unit, Real> operator()(quantity<Unit> q) {
        return quantity<Unit, Real>::from_value((*this)(q.value()));
    }
    /// The same in every lane.
    static Real same(double x) { return Real(x); }
    template <class Unit> static quantity<Unit, Real> same(quantity<Unit> q) {
        return quantity<Unit, Real>::from_value(Real(q.value()));
    }
    /// 0 in the even lanes.
    Real odd(double x) {
        if constexpr (multi_lane<Real>) {
            Real out;
            for (std::size_t i = 0; i < lane_count<Real>; ++i) out.set(i, i % 2 == 0 ? 0 : x);
            return out;
        } else
            return which % 2 == 0 ? 0 : x;
    }
};

/// A control law with the reference alone as input; it is told of a command that was cut off.
template <class Law, class Real> struct law {
    using input = s::position;
    using argument = quantity_of<s::position, Real>;
    using value = typename Law::value;
    Law b;

    value operator()(argument x) noexcept {
        const auto rate = x / quantity<si::time, Real>::from_value(Real(0.03));
        const auto y = b(axis_motion<Real>{x, rate, rate / quantity<si::time, Real>::from_value(Real(0.02))},
                         argument(x * Real(0.7)), quantity_of<s::velocity, Real>(rate * Real(0.6)));
        b.applied(y * Real(0.9));
        return y;
    }
    void reset() noexcept { b.reset(); }
    void settle(argument x) noexcept { b.settle(x, value::from_value(x.value())); }
    bool faulted() const noexcept { return b.faulted(); }
};
template <class Law, class Real> auto law_of(const typename Law::parameters& p) {
    return law<Law, Real>{Law(p, T)};
}

/// A friction law that `friction_feedforward` takes: f = level v / sqrt(v^2 + 1), of no physical meaning.
template <class Real> struct bent {
    using input = s::velocity;
    using output = s::force;
    using value = quantity_of<s::force, Real>;
    struct parameters {
        value level;
    };
    bent(const parameters& p, duration) : level(p.level) {}
    value slip(quantity_of<s::velocity, Real> v) const noexcept {
        using std::sqrt;
        return level * Real(1 / sqrt(Real(v.value() * v.value() + Real(1))));
    }
    gain_of<s::force, s::velocity, Real> viscous() const noexcept {
        return gain_of<s::force, s::velocity, Real>::from_value(Real(0.3));
    }
    value level;
};

template <class Make> struct entry {
    const char* name;
    double amplitude;
    Make make;
};
template <class Make> entry(const char*, double, Make) -> entry<Make>;

inline const std::tuple blocks{
    entry{"backward_difference", 0.1,
          []<class R>(own<R>&) { return backward_difference<s::position, s::velocity, R>({}, T); }},
    entry{"two_sample_derivative", 0.1,
          []<class R>(own<R>&) { return two_sample_derivative<s::position, s::velocity, R>({}, T); }},
    entry{"filtered_derivative", 0.1,
          []<class R>(own<R>& p) { return filtered_derivative<s::position, s::velocity, R>({p(150_Hz)}, T); }},
    entry{"lowpass", 50, []<class R>(own<R>& p) { return lowpass<s::force, R>({p(100_Hz)}, T); }},
    entry{"notch", 50,
          []<class R>(own<R>& p) {
              return notch<s::force, R>({p(330_Hz), p(0.1)}, T);
          }},
    entry{"butterworth", 50, []<class R>(own<R>& p) { return butterworth<s::force, R>({p(100_Hz)}, T); }},
    entry{"transfer_function", 50,
          []<class R>(own<R>& p) { // an integrator in the even lanes
              return transfer_function<s::force, s::position, 1, R>(
                  {{p(0.25_m / 1_N), p(0.5_m / 1_N)}, {p.same(1), R(p.odd(0.3) - R(1))}}, T);
          }},
    entry{"proportional", 0.1,
          []<class R>(own<R>& p) { return proportional<s::position, s::velocity, R>({p(150.0 / 1_s)}, T); }},
    entry{"proportional_integral", 0.1,
          []<class R>(own<R>& p) {
              return proportional_integral<s::velocity, s::voltage, integral_clamp, R>(
                  {p(60_V / 1_mps), p(450_V / 1_m), p(0.3_V)}, T);
          }},
    entry{"p_pi", 0.01,
          []<class R>(own<R>& p) {
              return law_of<p_pi<R>, R>({.position_gain = p(41.0 / 1_s),
                                         .gain = p(252_V / 1_mps),
                                         .integral_gain = p(9001_V / 1_m),
                                         .velocity_weight = p(0.9),
                                         .acceleration_gain = p(1.6_V / 1_mps2),
                                         .limit = p(8_V)});
          }},
    entry{"p_pi, back calculation", 0.01,
          []<class R>(own<R>& p) {
              return law_of<p_pi<R, s::voltage, back_calculation>, R>({.position_gain = p(41.0 / 1_s),
                                                                       .gain = p(252_V / 1_mps),
                                                                       .integral_gain = p(9001_V / 1_m),
                                                                       .velocity_weight = p(0.9),
                                                                       .acceleration_gain = p(1.6_V / 1_mps2),
                                                                       .limit = p(8_V),
                                                                       .anti_windup = {2_ms}});
          }},
    entry{"pid", 0.01,
          []<class R>(own<R>& p) {
              return law_of<pid<R>, R>({.gain = p(701_V / 1_m),
                                        .integral_gain = p(8000.0 * 1_V / (1_m * 1_s)),
                                        .derivative_gain = p(3.1_V / 1_mps),
                                        .derivative = derivative_from::positions,
                                        .derivative_corner = 200_Hz,
                                        .position_weight = p(0.7),
                                        .velocity_weight = p(0.9),
                                        .limit = p(8_V)});
          }},
    entry{"lead_lag", 0.01,
          []<class R>(own<R>& p) {
              const auto a = p(701_V / 1_m), b = p(-650_V / 1_m);
              return law_of<lead_lag<R>, R>({.r = {p.same(1), p(-1.3), p(0.35)},
                                             .feedback = {a, b, p.same(3_V / 1_m)},
                                             .reference = {a, b, p.same(3_V / 1_m)}});
          }},
    entry{"limiter", 8,
          []<class R>(own<R>& p) {
              return limiter<s::voltage, R>({p(-3_V), p(5_V)}, T);
          }},
    entry{"rate_limiter", 8,
          []<class R>(own<R>& p) { return rate_limiter<s::voltage, R>({p(3000_V / 1_s)}, T); }},
    entry{"dead_band", 8, []<class R>(own<R>& p) { return dead_band<s::voltage, R>({p(1_V)}, T); }},
    entry{"quantizer", 8, // no rounding in the even lanes
          []<class R>(own<R>& p) {
              return quantizer<s::voltage, R>({quantity_of<s::voltage, R>::from_value(p.odd(0.3))}, T);
          }},
    entry{"delay_line", 50,
          []<class R>(own<R>& p) {
              if constexpr (multi_lane<R>) {
                  typename delay_line<s::force, 7, R>::parameters each{};
                  for (std::size_t i = 0; i < lane_count<R>; ++i) each.length[i] = 1 + i;
                  return delay_line<s::force, 7, R>(each, T);
              } else
                  return delay_line<s::force, 7>({1 + p.which}, T);
          }},
    entry{"fractional_delay", 50,
          []<class R>(own<R>& p) { return fractional_delay<s::force, 7, 3, R>({p(1.7_ms)}, T); }},
    entry{"repetitive", 50,
          []<class R>(own<R>& p) {
              return repetitive<s::force, 12, 2, 3, 3, R>(
                  {.cycle = p(4.3_ms),
                   .weights = {p(0.7), p(0.1)},
                   .learning = {p(0.3), p(0.9), p(-0.2)},
                   .ahead = 1,
                   .smoothing = {p.same(0.25), p.same(0.5), p.same(0.25)}},
                  T);
          }},
    entry{"disturbance_observer", 0.1,
          []<class R>(own<R>& p) { // the plant integrates in the even lanes
              return disturbance_observer<s::voltage, s::position, 2, 0, 2, 0, R>(
                  {p(60_Hz), {{p(0.63)}, {p.odd(40), p(2.5), p.same(1)}}}, T);
          }},
    entry{"absent", 50, []<class R>(own<R>&) { return absent<s::velocity, s::force, R>({}, T); }},
    entry{"series", 50,
          []<class R>(own<R>& p) {
              return series<notch<s::force, R>, lowpass<s::force, R>>({{p(330_Hz), p(0.1)}, {p(200_Hz)}}, T);
          }},
    entry{"friction_feedforward", 0.1,
          []<class R>(own<R>& p) {
              return friction_feedforward<bent<R>, s::voltage, R>(
                  {{p(122_N)}, p(1450_N / 1_V), p(31_mmps), p(0.9), at_rest::held}, T);
          }},
};

} // namespace lanes_conformance
