// SPDX-License-Identifier: BSL-1.0
// A ferraris_force_estimator in the slot `disturbance` of a milling_axis, and of an xy_control: fed with the
// measured acceleration and what acts at that sample.
#include <quadrant/base/literals.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_control.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration T = 500_us;
constexpr double mass = 165, force_constant = 1470;
using estimator = ferraris_force_estimator<signal::voltage>;
using nothing = absent<signal::position, signal::voltage>;
template <class Observer> using boxes = milling_axis_boxes<absent<signal::velocity, signal::voltage>, Observer>;

template <class Observer> typename boxes<Observer>::parameters given(double corner = 100) {
    typename boxes<Observer>::parameters p{.position_gain = 150.0 / 1_s,
                                           .velocity_gain = 30_V / 1_mps,
                                           .velocity_integral = 250_V / 1_m,
                                           .estimator_corner = 150_Hz,
                                           .notch = {294_Hz, 0.17},
                                           .plant_gain = (force_constant / mass) * (1_mps2 / 1_V),
                                           .limit = 10_V};
    if constexpr (std::is_same_v<Observer, estimator>)
        p.disturbance = {mass * 1_kg, force_constant * (1_N / 1_V), corner * 1_Hz};
    return p;
}
/// A mass that a force of 200 N is put on at 0.1 s; exact over each period, the acceleration that of its begin.
template <class Axis, class Step> double furthest(Axis& axis, Step step) {
    double x = 0, v = 0, u = 0, most = 0;
    for (int k = 0; k < 2000; ++k) {
        const double push = k < 200 ? 0 : 200;
        const double a = (force_constant * u + push) / mass;
        u = step(axis, x * 1_m, a * 1_mps2).value();
        const double next = (force_constant * u + push) / mass;
        x += T.value() * v + T.value() * T.value() / 2 * next;
        v += T.value() * next;
        most = std::max(most, std::abs(x));
    }
    CHECK_FALSE(axis.faulted());
    return most * 1e6;
}
} // namespace

TEST_CASE(
    "milling_axis: a ferraris_force_estimator in the slot takes a step of force out in a fraction of the way") {
    milling_axis<boxes<nothing>> plain{.box = {given<nothing>(), T}};
    milling_axis<boxes<estimator>> sensed{.box = {given<estimator>(), T}};
    const double alone = furthest(plain, [](auto&axis, auto x, auto) { return axis({}, x); }),
                 with = furthest(sensed, [](auto&axis, auto x, auto a) { return axis({}, {}, x, a); });
    MESSAGE("um: " << alone << " without, " << with << " with the estimate");
    CHECK(with < alone / 2.5);
    CHECK(sensed.wire.disturbance.value() == doctest::Approx(200 / force_constant).epsilon(1e-3));
}

TEST_CASE("milling_axis with a ferraris_force_estimator: settle, track, retune and shift hold the command") {
    using axis_type = milling_axis<boxes<estimator>>;
    static_assert(axis_type::takes_acceleration);
    static_assert(retunable_milling_boxes<boxes<estimator>> && shiftable_milling_boxes<boxes<estimator>>);
    axis_type axis{.box = {given<estimator>(), T}};
    const axis_type::motion there{20_mm};
    axis.settle(20_mm, 2_V);
    for (int k = 0; k < 20; ++k)
        CHECK(axis(there, there, 20_mm, 0_mps2).value() == doctest::Approx(2).epsilon(1e-12));
    axis.retune({given<estimator>(200), T}, there);
    for (int k = 0; k < 20; ++k)
        CHECK(axis(there, there, 20_mm, 0_mps2).value() == doctest::Approx(2).epsilon(1e-12));
    axis.shift(5_mm);
    const axis_type::motion shifted{25_mm};
    CHECK(axis(shifted, shifted, 25_mm, 0_mps2).value() == doctest::Approx(2).epsilon(1e-9));
    for (int k = 0; k < 400; ++k)
        axis.track(shifted, shifted, 25_mm, 1_V, 0_mps2); // another controller holds it
    CHECK(axis(shifted, shifted, 25_mm, 0_mps2).value() == doctest::Approx(1).epsilon(1e-6));
    const auto last = axis.wire.command;
    const auto lost = std::numeric_limits<double>::quiet_NaN() * 1_mps2;
    CHECK(axis(shifted, shifted, 25_mm, lost) == last);
    CHECK(axis.faulted());
}

TEST_CASE("xy_control: an axis that wants the acceleration gets its own, the other one none") {
    using control = xy_control<boxes<estimator>, boxes<nothing>>;
    static_assert(control::takes_acceleration && !xy_control<boxes<nothing>>::takes_acceleration);
    control both({given<estimator>(), given<nothing>()}, T);
    milling_axis<boxes<estimator>> x{.box = {given<estimator>(), T}};
    milling_axis<boxes<nothing>> y{.box = {given<nothing>(), T}};
    bool same = true;
    for (int k = 0; k < 200; ++k) {
        const auto at = std::sin(0.1 * k) * 1_mm;
        const auto a = std::cos(0.3 * k) * 1_mps2;
        const auto u = both({}, {}, {.x = on_x(at), .y = on_y(0.5 * at)}, {.x = on_x(a), .y = on_y(3.0 * a)});
        same = same && u.x.plain() == x({}, {}, at, a) && u.y.plain() == y({}, 0.5 * at);
    }
    CHECK(same);
}
