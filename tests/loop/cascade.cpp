// SPDX-License-Identifier: BSL-1.0
// Long: one loop: a case for each statement of its page.
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
template <class Real> using estimator = filtered_derivative<signal::position, signal::velocity, Real>;
template <class Real> using boxes = cascade_p_pi_boxes<estimator<Real>, notch<signal::voltage, Real>>;
using axis = cascade<boxes<double>>;

/// The machine of practice/003 but for T.
template <class Boxes = boxes<double>> typename Boxes::parameters machine() {
    typename Boxes::parameters p{.position_gain = 104.861 / 1_s,
                                 .velocity_gain = 39.4461_V / 1_mps,
                                 .velocity_integral = 384.125_V / 1_m,
                                 .estimator = {},
                                 .velocity_feedforward = 1,
                                 .acceleration_feedforward = 0.187806_V / 1_mps2,
                                 .viscous_feedforward = 0.224606_V / 1_mps,
                                 .coulomb_feedforward = 0.0850344_V,
                                 .notch = {},
                                 .limit = 8_V,
                                 .dac_step = 20_V / 65536.0};
    if constexpr (requires { p.estimator.corner; }) p.estimator.corner = 163.943 * 1_Hz;
    if constexpr (requires { p.notch.centre; }) p.notch = {307.429 * 1_Hz, 0.08};
    return p;
}
const auto Ts = 1_ms;

/// The controller of docs/formats.md in bare doubles, written from its text.
struct bare {
    double T = 1e-3, r1 = 0, v_ref1 = 0, y1 = 0, v = 0, integral = 0, n1 = 0, n2 = 0, feedback = 0, wanted = 0;
    double operator()(double r, double y) {
        const double v_ref = (r - r1) / T, a_ref = (v_ref - v_ref1) / T;
        const double wc = 2 * std::numbers::pi * 163.943;
        v = ((2 - wc * T) * v + 2 * wc * (y - y1)) / (2 + wc * T);
        const double e = 104.861 * (r - y) + 1 * v_ref - v;
        integral = std::clamp(integral + 384.125 * T * e, -8.0, 8.0);
        feedback = 39.4461 * e + integral;
        const double t = std::tan(std::numbers::pi * 307.429 * T), a0 = 1 + 0.08 * t + t * t;
        const double b0 = (1 + t * t) / a0, b1 = 2 * (t * t - 1) / a0, a2 = (1 - 0.08 * t + t * t) / a0;
        const double damped = b0 * feedback + n1; // the notch keeps its states as the block does
        n1 = b1 * feedback - b1 * damped + n2;
        n2 = b0 * feedback - a2 * damped;
        const double sign = v_ref > 0 ? 1 : v_ref < 0 ? -1 : 0;
        wanted = damped + 0.187806 * a_ref + 0.224606 * v_ref + 0.0850344 * sign;
        r1 = r, v_ref1 = v_ref, y1 = y;
        return std::round(std::clamp(wanted, -8.0, 8.0) / (20.0 / 65536)) * (20.0 / 65536);
    }
};

double reference(int k) { return 0.02 * (1 - std::cos(0.01 * k)); }
/// A machine that follows with a lag and an error, so that every wire carries something.
double position(int k) {
    return k < 3 ? 0 : 0.01998 * (1 - std::cos(0.01 * (k - 2))) + 2e-6 * std::sin(0.9 * k);
}
quantity<si::length> metres(double x) { return quantity<si::length>::from_value(x); }
const auto bad = metres(std::numeric_limits<double>::quiet_NaN());
} // namespace

TEST_CASE("cascade: the controller of docs/formats.md in bare doubles, before the DAC to 1e-9 V") {
    auto p = machine();
    p.dac_step = 0_V;
    axis typed{.box = {p, Ts}};
    bare plain;
    double most = 0;
    for (int k = 0; k < 5000; ++k) {
        plain(reference(k), position(k));
        typed(metres(reference(k)), metres(position(k)));
        CHECK(std::abs(typed.wire.reference_velocity.value() - plain.v_ref1) < 1e-12);
        CHECK(std::abs(typed.wire.measured_velocity.value() - plain.v) < 1e-12);
        CHECK(std::abs(typed.wire.feedback.value() - plain.feedback) < 1e-9);
        CHECK(std::abs(typed.wire.wanted.value() - plain.wanted) < 1e-9);
        most = std::max(most, std::abs(typed.wire.command.value()));
    }
    CHECK(most > 1);   // volts: the loop works
    CHECK(most < 7.9); // and the limit was not what was tested
}
TEST_CASE("cascade: the same DAC steps as bare doubles, but at a tie") {
    axis typed{.box = {machine(), Ts}};
    bare plain;
    int off = 0;
    for (int k = 0; k < 5000; ++k) {
        const double u = plain(reference(k), position(k));
        const double steps =
            std::abs(typed(metres(reference(k)), metres(position(k))).value() - u) / (20.0 / 65536);
        CHECK(steps < 1.01);
        off += steps > 0.01;
    }
    CHECK(off <= 1);
}
TEST_CASE("cascade: 1 mm of step is 4.18 V of position loop, and is limited with the feedforward on top") {
    // 104.861/s * 1 mm * (39.4461 V s/m + 384.125 V/m * 1 ms) = 4.1766 V without feedforward and notch
    auto p = machine<cascade_p_pi_boxes<>>();
    p.velocity_feedforward = 0;
    p.acceleration_feedforward = {}, p.viscous_feedforward = {}, p.coulomb_feedforward = {};
    cascade<cascade_p_pi_boxes<>> quiet{.box = {p, Ts}};
    CHECK(quiet(1_mm, 0_mm).value() == doctest::Approx(4.1766).epsilon(1e-4));
    CHECK_FALSE(quiet.limited());
    axis full{.box = {machine(), Ts}};                         // a_ref = 1000 m/s^2
    CHECK(full(1_mm, 0_mm).value() == 26214 * (20.0 / 65536)); // the DAC step below 8 V
    CHECK(full.limited());
    CHECK(full.wire.wanted > 100_V);
    CHECK(full.wire.limited == 8_V);
    full.reset();
    full(-1_mm, 0_mm);
    CHECK(full.wire.limited == -8_V);
}
TEST_CASE("cascade: every wire has a tap, and the log header its units") {
    axis a{.box = {machine(), Ts}};
    a(1_mm, 0_mm);
    std::string header;
    double command = 0;
    for_each_tap(a.wire, axis::taps(), [&](const char* name, const char* unit, double value) {
        header += std::string(name) + " [" + unit + "] ";
        if (std::string(name) == "command") command = value;
    });
    CHECK(header.find("position_error [m] ") != header.npos);
    CHECK(header.find("reference_acceleration [m/s^2] ") != header.npos);
    CHECK(header.find("feedback [V] ") != header.npos);
    CHECK(command == a.wire.command.value());
    CHECK(command > 7.99);
}
TEST_CASE("cascade: settled in the middle of a motion it goes on without a bump") {
    auto p = machine();
    p.dac_step = 0_V;
    axis a{.box = {p, Ts}};
    // constant velocity of 100 mm/s, 20 um behind: the command must stay what it was
    a.settle({.reference = 30_mm,
              .measured = 29.98_mm,
              .reference_velocity = 100_mmps,
              .measured_velocity = 100_mmps,
              .command = 1.5_V});
    CHECK(a.wire.command.value() == doctest::Approx(1.5));
    const double more = 384.125 * 1e-3 * 104.861 * 20e-6; // what the integral gains per row, 0.8 mV
    CHECK(a(30.1_mm, 30.08_mm).value() == doctest::Approx(1.5).epsilon(1e-9));
    // The notch passes the slow ramp of the integral with a delay of its own; a bump would be 39 V/(m/s) times
    // an error.
    for (int k = 2; k < 50; ++k)
        CHECK(a(metres(0.03 + 1e-4 * k), metres(0.02998 + 1e-4 * k)).value() ==
              doctest::Approx(1.5 + more * (k - 1)).epsilon(1e-3));
}
TEST_CASE("cascade: settled in acceleration, and with the other estimators") {
    const auto check = [](auto a) {
        // constant acceleration 1 m/s^2 from 100 mm/s on; measured = reference
        const auto x = [](int k) { return metres(0.03 + 0.1 * k * 1e-3 + 0.5 * k * (k + 1) * 1e-6); };
        a.settle({.reference = x(0),
                  .measured = x(0),
                  .reference_velocity = 100_mmps,
                  .measured_velocity = 100_mmps,
                  .reference_acceleration = 1_mps2,
                  .command = 1.5_V});
        a(x(1), x(1));
        CHECK(a.wire.reference_acceleration.value() == doctest::Approx(1).epsilon(1e-6));
        CHECK(a.wire.reference_velocity.value() == doctest::Approx(0.101).epsilon(1e-9));
        // the estimator lags by less than 2 ms: 2 mm/s times 40 V/(m/s)
        CHECK(std::abs(a.wire.command.value() - 1.5) < 0.08);
    };
    check(axis{.box = {machine(), Ts}});
    using mean = cascade_p_pi_boxes<two_sample_derivative<signal::position, signal::velocity>>;
    check(cascade<mean>{.box = {machine<mean>(), Ts}});
    using difference = cascade_p_pi_boxes<backward_difference<signal::position, signal::velocity>>;
    check(cascade<difference>{.box = {machine<difference>(), Ts}});
}
TEST_CASE("cascade: reset is as new, a copy is a snapshot") {
    axis used{.box = {machine(), Ts}}, fresh = used;
    for (int k = 0; k < 300; ++k) used(metres(reference(k)), metres(position(k)));
    axis copy = used;
    copy.reset();
    CHECK(copy.wire.command.value() == 0);
    CHECK(used.wire.command.value() != 0);
    for (int k = 0; k < 300; ++k)
        CHECK(copy(metres(reference(k)), metres(position(k))) ==
              fresh(metres(reference(k)), metres(position(k))));
}
TEST_CASE("cascade: a bad sample gives the last command, moves no box, and is told until reset or settle") {
    for (const bool which : {false, true}) {
        axis a{.box = {machine(), Ts}};
        for (int k = 0; k < 300; ++k) a(metres(reference(k)), metres(position(k)));
        axis twin = a;
        const auto last = a.wire.command;
        CHECK((which ? a(bad, metres(0)) : a(metres(0), bad)) == last);
        CHECK(a.faulted());
        for (int k = 300; k < 400; ++k)
            CHECK(a(metres(reference(k)), metres(position(k))) ==
                  twin(metres(reference(k)), metres(position(k))));
        CHECK(a.faulted());
        CHECK_FALSE(twin.faulted());
        a.settle({.command = 1_V});
        CHECK_FALSE(a.faulted());
        a.settle({.reference = bad});
        CHECK(a.faulted());
        a.reset();
        CHECK_FALSE(a.faulted());
    }
}
TEST_CASE("cascade: a box that overflows is told by the cascade") {
    axis a{.box = {machine(), Ts}};
    a(metres(1e308), metres(-1e308));
    CHECK(a.faulted());
    CHECK(finite(a(metres(0), metres(0))));
}
TEST_CASE("cascade: the PI is charged with what the amplifier cut off, feedforward included") {
    struct learning_boxes : cascade_p_pi_boxes<> {
        using cascade_p_pi_boxes<>::cascade_p_pi_boxes;
        learning_boxes(const parameters& p, duration period)
            : cascade_p_pi_boxes<>(p, period),
              velocity_loop({p.velocity_gain, p.velocity_integral, p.limit, {20_ms}}, period) {}
        proportional_integral<signal::velocity, signal::voltage, back_calculation>
            velocity_loop; // hides the clamped one
    };
    static_assert(axis_boxes<learning_boxes>);
    auto p = machine<cascade_p_pi_boxes<>>();
    p.coulomb_feedforward = 7.9_V;
    cascade<learning_boxes> a{.box = {p, Ts}};
    // 1 mm behind at a steady crawl: PI 4.2 V, feedforward 7.9 V: 4.1 V beyond the 8 V. PI alone is within its
    // limit.
    for (int k = 0; k < 5; ++k) a(metres(1e-3 + 1e-7 * k), metres(1e-7 * k));
    CHECK(a.limited());
    CHECK(a.wire.feedback < 8_V);
    CHECK(a.box.velocity_loop.limited());
    CHECK(a.box.velocity_loop.now().excess.value() ==
          doctest::Approx((a.wire.wanted - a.wire.limited).value()));
}
TEST_CASE("cascade: a drive that takes newtons, a series of notches, float") {
    using two = series<notch<signal::force>, notch<signal::force>>;
    using in_newtons = cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, two>;
    const in_newtons::parameters p{.position_gain = 100.0 / 1_s,
                                   .velocity_gain = 2000_N / 1_mps,
                                   .velocity_integral = 20000_N / 1_m,
                                   .estimator = {150_Hz},
                                   .notch = {{330_Hz, 0.1}, {450_Hz, 0.1}},
                                   .limit = 400_N};
    cascade<in_newtons> a{.box = {p, Ts}};
    const quantity<si::force> u = a(1_um, 0_um);
    CHECK(u > 0_N);

    cascade<boxes<float>> rough{.box = {machine<boxes<float>>(), Ts}};
    axis exact{.box = {machine(), Ts}};
    using metres_f = quantity_of<signal::position, float>;
    double worst = 0;
    for (int k = 0; k < 2000; ++k)
        worst = std::max(
            worst,
            std::abs(double(rough(metres_f::from_value(float(reference(k))),
                                  metres_f::from_value(float(position(k))))
                                .value()) -
                     exact(metres(double(float(reference(k)))), metres(double(float(position(k))))).value()));
    CHECK(worst <
          0.05); // [V]: 0.1 m in float is good to 7 nm; over T^2 and the feedforward that is what is left
}
TEST_CASE("cascade: with a dual, the command's derivative by a gain is that of a difference quotient") {
    using D = dual<1>;
    using dual_boxes = boxes<D>;
    const auto run = [](auto& loop, auto number, auto&& each) {
        using Real = decltype(number);
        using metres_r = quantity_of<signal::position, Real>;
        for (int k = 0; k < 300; ++k)
            each(k, loop(metres_r::from_value(Real(reference(k))), metres_r::from_value(Real(position(k))))
                        .value());
    };
    const auto with_gain = [](auto gain) {
        using Real = decltype(gain);
        using B = boxes<Real>;
        const auto m = machine();
        typename B::parameters p{};
        p.position_gain = decltype(p.position_gain)::from_value(gain);
        p.velocity_gain = decltype(p.velocity_gain)::from_value(Real(m.velocity_gain.value()));
        p.velocity_integral = decltype(p.velocity_integral)::from_value(Real(m.velocity_integral.value()));
        p.estimator.corner = decltype(p.estimator.corner)::from_value(Real(163.943));
        p.notch.centre = decltype(p.notch.centre)::from_value(Real(307.429));
        p.notch.width = Real(0.08);
        p.limit = decltype(p.limit)::from_value(Real(8));
        return cascade<B>{.box = {p, Ts}};
    };
    const double h = 1e-3;
    auto loop = with_gain(D::variable(104.861, 0));
    auto up = with_gain(104.861 + h), down = with_gain(104.861 - h);
    std::array<double, 300> quotient{};
    run(up, 0.0, [&](int k, double u) { quotient[std::size_t(k)] = u; });
    run(down, 0.0,
        [&](int k, double u) { quotient[std::size_t(k)] = (quotient[std::size_t(k)] - u) / (2 * h); });
    run(loop, D(), [&](int k, const D& u) {
        CHECK(u.partial[0] == doctest::Approx(quotient[std::size_t(k)]).epsilon(1e-6).scale(1e-2));
    });
    static_assert(axis_boxes<dual_boxes>);
}
