// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/observer/disturbance_observer.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
namespace s = quadrant::signal;
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
using gain = gain_of<s::acceleration, s::voltage>;

struct axis { // [Jamaludin2008] Table 2.1, 2.2
    gain B;
    per_second A;
    frequency corner;
    double kp, ki;
};
const axis x{4.526_mps2 / 1_V, 28.57 / 1_s, 60_Hz, 60, 450}, y{8.916_mps2 / 1_V, 20.0 / 1_s, 90_Hz, 30, 250};
using observer = disturbance_observer<s::voltage>;
observer of(const axis& a) { return {{.corner = a.corner, .plant = axis_model<s::voltage>{a.B, a.A}}, T}; }

/// The axis behind a DAC without delay, exact for a held command.
class plant {
public:
    explicit plant(const axis& a) : b_(a.B.value()), a_(a.A.value()) {}
    quantity_of<s::position> operator()(quantity_of<s::voltage> u) {
        const double h = T.value(), e = std::exp(-a_ * h), to = b_ * u.value() / a_;
        x_ += to * h + (v_ - to) * (1 - e) / a_;
        v_ = to + (v_ - to) * e;
        return at();
    }
    quantity_of<s::position> at() const { return x_ * 1_m; }
    quantity_of<s::velocity> speed() const { return v_ * 1_mps; }

private:
    double b_, a_, x_ = 0, v_ = 0;
};

/// Error amplitude [um] at 1 Hz under a command disturbance of 1 V.
enum class loop { without, exact, delayed };
double error_at_1Hz(const axis& a, loop how) {
    auto ob = of(a);
    plant p(a);
    proportional_integral<s::velocity, s::voltage> velocity_loop{{a.kp * 1_V / 1_mps, a.ki * 1_V / 1_m, 1000_V},
                                                                 T};
    quantity_of<s::voltage> before{};
    double in_phase = 0, across = 0;
    for (int k = 0; k < 8000; ++k) {
        const double angle = 2 * pi * 1.0 * k * T.value();
        const auto wanted = velocity_loop(150.0 / 1_s * (0_m - p.at()) - p.speed());
        auto command = wanted;
        if (how == loop::exact) command = wanted - ob(p.at(), wanted);
        if (how == loop::delayed) { // what a loop body without the solution does
            command = wanted - before;
            ob(p.at(), wanted);
            ob.applied(command);
            before = ob.disturbance();
        }
        if (k >= 4000) in_phase += p.at().value() * std::cos(angle), across += p.at().value() * std::sin(angle);
        p(command + std::sin(angle) * 1_V);
    }
    return std::hypot(in_phase, across) / 2000 * 1e6;
}
} // namespace

TEST_CASE("disturbance_observer: Q of order 2 has the thesis' coefficients") {
    const auto qx = q_filter<2, 0>(x.corner),
               qy = q_filter<2, 0>(y.corner); // under eq. (4.7), printed to 4 digits
    CHECK(qx.numerator[0] == Approx(1.421e5).epsilon(3e-4));
    CHECK(qx.denominator[0] == qx.numerator[0]);
    CHECK(qx.denominator[1] == Approx(754).epsilon(3e-4));
    CHECK(qx.denominator[2] == 1);
    CHECK(qy.numerator[0] == Approx(3.198e5).epsilon(3e-4));
    CHECK(qy.denominator[1] == Approx(1131).epsilon(3e-4));
    CHECK(qx.numerator[1] == 0);
}
TEST_CASE(
    "disturbance_observer: Q of any order is a binomial, its numerator the first terms of the denominator") {
    const auto q = q_filter<5, 2>(frequency(1_Hz / (2 * pi)));
    CHECK(q.denominator == std::array{1.0, 5.0, 10.0, 10.0, 5.0, 1.0});
    CHECK(q.numerator == std::array{1.0, 5.0, 10.0, 0.0, 0.0, 0.0});
}
TEST_CASE("disturbance_observer: 60 and 90 Hz are not where |Q| is -3 dB: 38.6 and 57.9 Hz") {
    for (const auto& [a, hertz] : {std::pair{x, 38.6}, std::pair{y, 57.9}}) {
        const auto ob = of(a);
        // Bilinear: at 58 Hz the axis of frequencies is compressed by 0.3 %.
        CHECK(std::abs(ob.q(hertz * 1_Hz)) == Approx(std::sqrt(0.5)).epsilon(3e-3));
        CHECK(std::abs(ob.q(0_Hz)) == Approx(1).epsilon(1e-12));
    }
}
TEST_CASE("disturbance_observer: Q over Q/Gn is the nominal plant, far below half the sampling rate") {
    const auto ob = of(x);
    for (const double f : {0.5, 5.0, 20.0})
        CHECK(std::abs(ob.q(f * 1_Hz) / ob.inverse(f * 1_Hz) / ob.nominal(f * 1_Hz) - 1.0) < 2e-3);
}
TEST_CASE("disturbance_observer: finds a constant push of 1 V within 1 % after 7 / wc, whatever is commanded") {
    auto ob = of(x);
    plant p(x);
    quantity_of<s::voltage> d{};
    int k = 0;
    for (; k < 38; ++k) { // 19 ms: 1 - (1 + 7.16) exp(-7.16) = 0.9936
        const auto wanted = 0.3 * std::sin(0.1 * k) * 1_V;
        d = ob(p.at(), wanted);
        p(wanted - d + 1_V);
    }
    CHECK(d.value() == Approx(1).epsilon(0.01));
    for (; k < 400; ++k) p(1_V - (d = ob(p.at())));
    CHECK(d.value() == Approx(1).epsilon(1e-6));
}
TEST_CASE("disturbance_observer: the estimate of a sine is Q times the sine, but for the hold that Gn does not "
          "know") {
    auto ob = of(y);
    plant p(y);
    for (const double f : {5.0, 40.0}) {
        std::complex<double> sum = 0;
        for (int k = 0; k < 4400; ++k) {
            const double angle = 2 * pi * f * k * T.value();
            const auto d = ob(p.at());
            if (k >= 4000) sum += d.value() * std::polar(2.0 / 400, -angle);
            p(std::cos(angle) * 1_V - d);
        }
        // The hold delays the axis by half a sample, r, which Gn does not know: d = Q (r (u + push) - u), u =
        // -d.
        const auto q = ob.q(f * 1_Hz), r = std::polar(1.0, -pi * f * T.value());
        CHECK(std::abs(sum - q * r / (1.0 + q * (r - 1.0))) < 2e-3); // (w T)^2 / 12 of the bilinear form
    }
}
TEST_CASE("disturbance_observer: the loop through the command is solved to rounding") {
    auto ob = of(y), open = of(y); // the second is told the command afterwards: no loop to solve
    plant p(y);
    double worst = 0;
    for (int k = 0; k < 200; ++k) {
        const auto wanted = std::sin(0.3 * k) * 1_V, d = ob(p.at(), wanted), u = wanted - d;
        open(p.at(), 0_V);
        open.applied(u);
        worst = std::max(worst, std::abs((open.disturbance() - d).value()));
        p(u);
    }
    CHECK(worst < 1e-12);
}
TEST_CASE(
    "disturbance_observer: last cycle's command in place of the solution costs wc T / 2 at 1 Hz, 14 % on y") {
    for (const auto& [a, cost] : {std::pair{x, 0.094}, std::pair{y, 0.141}}) {
        const double without = error_at_1Hz(a, loop::without), exact = error_at_1Hz(a, loop::exact),
                     delayed = error_at_1Hz(a, loop::delayed);
        CHECK(exact < 0.05 * without);
        CHECK(delayed / exact == Approx(1 + cost).epsilon(0.01));
    }
}
TEST_CASE("disturbance_observer: clipping after it is part of the solution, and the estimate stays right") {
    auto ob = of(x);
    limiter<s::voltage> amplifier{{-1_V, 1_V}, T};
    plant p(x);
    int clipped = 0;
    for (int k = 0; k < 2000; ++k) {
        const auto wanted = 4 * std::sin(0.01 * k) * 1_V;
        const auto command = wanted - ob(p.at(), wanted);
        const auto applied = amplifier(command);
        ob.applied(applied);
        clipped += applied != command;
        // The equation of the loop with the limiter in it: u = limit(wanted - d(u)).
        CHECK(amplifier(wanted - ob.disturbance()).value() == Approx(applied.value()).epsilon(1e-12));
        p(applied + 0.5_V);
        // 0.5 V is found although the command was clipped; the hold and the bilinear form leave 20 mV
        if (k > 100) CHECK(ob.disturbance().value() == Approx(0.5).epsilon(0.05));
    }
    CHECK(clipped > 500);
}
TEST_CASE("disturbance_observer: what is added behind the tap is not compensated a second time") {
    auto ob = of(x);
    plant p(x);
    const auto friction = 0.2_V; // compensated by a feedforward of the same size
    for (int k = 0; k < 1000; ++k) {
        const auto command = 0_V - ob(p.at());
        const auto applied = command + friction;
        ob.applied(applied - friction);
        p(applied - friction);
    }
    CHECK(std::abs(ob.disturbance().value()) < 1e-12);
}
TEST_CASE("disturbance_observer: m = 1 follows a ramp that m = 0 lags behind") {
    disturbance_observer<s::voltage, s::position, 3, 1> ramp{{60_Hz, axis_model<s::voltage>{x.B, x.A}}, T};
    auto constant = of(x);
    plant p(x), q(x);
    double behind = 0, lag = 0;
    for (int k = 0; k < 2000; ++k) {
        const auto push = 2.0 * k * T.value() * 1_V;
        const auto d = ramp(p.at()), e = constant(q.at());
        p(push - d), q(push - e);
        behind = (push - d).value(), lag = (push - e).value();
    }
    // 1 - Q = 2 s / wc: slope times 2 / wc. The hold, which Gn does not know, delays wanted and push alike: no
    // lag of its own.
    CHECK(lag == Approx(2.0 * 2 / (2 * pi * 60)).epsilon(1e-9).scale(0));
    CHECK(std::abs(behind) < 1e-9);
}
TEST_CASE("disturbance_observer: a general nominal plant with a zero and without an integrator") {
    // Gn = 3 (s + 200) / ((s + 5) (s + 40) (s + 300)), relative degree 2
    const nominal_plant<3, 1> g{{600, 3}, {60000, 13700, 345, 1}};
    disturbance_observer<s::voltage, s::velocity, 3, 1, 3, 1> ob{{50_Hz, g}, T};
    const auto d = zero_order_hold(continuous<3>{{600, 3}, g.denominator}, T);
    using sampled = transfer_function<s::voltage, s::velocity, 3>;
    sampled p(sampled::parameters::in_si(d), T);
    auto v = 0_mps;
    for (int k = 0; k < 8000; ++k) {
        const auto wanted = 0.7_V;
        v = p(wanted - ob(v, wanted) + 0.4_V);
    }
    CHECK(ob.disturbance().value() == Approx(0.4).epsilon(1e-6));
    CHECK(v.value() == Approx(0.7 * 0.01).epsilon(1e-6)); // as if nothing pushed
    auto settled = ob;
    settled.settle(v, 0.4_V);
    CHECK(settled(v, 0.7_V).value() == Approx(0.4).epsilon(1e-5));
}
TEST_CASE("disturbance_observer: a bumpless start goes on with the command that was applied") {
    auto ob = of(y);
    ob.settle(0.3_m, -0.8_V);
    for (int k = 0; k < 100; ++k) CHECK(ob(0.3_m).value() == Approx(-0.8).epsilon(1e-12));
}
TEST_CASE("disturbance_observer: the delay of the axis leaves |Q Delta| at 0.12 and 0.18; a mode can break the "
          "bound") {
    const auto delayed = [](const observer& ob) {
        return [&ob](frequency f) { return ob.nominal(f) * std::polar(1.0, -2 * pi * f.value() * 650e-6); };
    };
    const auto ox = of(x), oy = of(y);
    const auto rx = robustness(ox, delayed(ox), 1_Hz, 900_Hz), ry = robustness(oy, delayed(oy), 1_Hz, 900_Hz);
    CHECK(rx.holds());
    CHECK(rx.worst == Approx(0.122).epsilon(0.01).scale(0)); // max of |Q| 2 sin(w Td/2), near wc
    CHECK(rx.at.value() == Approx(60).epsilon(0.05));
    CHECK(ry.worst == Approx(0.182).epsilon(0.01).scale(0));
    const auto mode = [&](frequency f) { // 45 Hz, 1 % damping, as strong as the axis itself
        const std::complex<double> r(0, f.value() / 45);
        return oy.nominal(f) * (1.0 + 1.0 / (r * r + 0.02 * r + 1.0));
    };
    const auto broken = robustness(oy, mode, 1_Hz, 900_Hz);
    CHECK_FALSE(broken.holds());
    CHECK(broken.at.value() == Approx(45).epsilon(0.01));
    CHECK_THROWS_AS(robustness(oy, mode, 10_Hz, 1_Hz), invalid_parameter);
}
TEST_CASE(
    "disturbance_observer: a bad sample holds the estimate, and an applied that follows changes nothing") {
    auto ob = of(x), twin = ob;
    for (int k = 0; k < 10; ++k) ob(double(k) * 1_um, 1_V), twin(double(k) * 1_um, 1_V);
    const auto last = ob.disturbance();
    CHECK(ob(std::numeric_limits<double>::quiet_NaN() * 1_m, 1_V) == last);
    ob.applied(7_V);
    CHECK(ob(1_um, std::numeric_limits<double>::infinity() * 1_V) == last);
    ob.applied(7_V);
    CHECK(ob.faulted());
    CHECK(ob(11_um, 2_V) == twin(11_um, 2_V));
    ob.applied(std::nan("") * 1_V); // nor a bad one
    CHECK(ob(12_um, 2_V) == twin(12_um, 2_V));
}
TEST_CASE(
    "disturbance_observer: refuses a corner above half the sampling rate, unstable inverses, no numbers") {
    const axis_model<s::voltage> g{x.B, x.A};
    CHECK_THROWS_WITH_AS(
        (observer{{1_kHz, g}, T}),
        "disturbance_observer.corner = 1000 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
        invalid_parameter);
    CHECK_THROWS_AS((observer{{0_Hz, g}, T}), invalid_parameter);
    CHECK_THROWS_AS((observer{{60_Hz, g}, 0_s}), invalid_parameter);
    CHECK_THROWS_WITH_AS((observer{{60_Hz, axis_model<s::voltage>{}}, T}),
                         "disturbance_observer.plant.numerator = 0: highest coefficient must not be zero",
                         invalid_parameter);
    CHECK_THROWS_AS((observer{{60_Hz, axis_model<s::voltage>{x.B, std::nan("") / 1_s}}, T}), invalid_parameter);
    using with_zero = disturbance_observer<s::voltage, s::velocity, 2, 0, 2, 1>;
    CHECK_THROWS_WITH_AS(
        (with_zero{{50_Hz, nominal_plant<2, 1>{{-200, 3}, {200, 45, 1}}}, T}),
        "disturbance_observer.plant.numerator = -200: has a zero on or right of the imaginary axis: "
        "1/Gn would be unstable",
        invalid_parameter);
}

namespace {
/// The thesis' loop on its model with delay: position error loop, sensitivity, position per disturbance at the
/// command.
struct loop_figures {
    std::complex<double> position_loop, sensitivity, compliance;
};
loop_figures figures(const axis& a, const observer* ob, double hertz) {
    using complex = std::complex<double>;
    const complex p(0, 2 * pi * hertz);
    const double n0 = a.kp > 50 ? 4.3e6 : 3.41e6, n1 = a.kp > 50 ? 125.7 : 314.2;
    const complex g = a.B.value() * std::exp(-650e-6 * p) / (p * (p + a.A.value())), pi_ = a.kp + a.ki / p,
                  speed = 942.5 * p / (p + 942.5) * (p * p + n0) / (p * p + n1 * p + n0);
    const complex q = ob ? ob->q(hertz * 1_Hz) : 0, inverse = ob ? ob->inverse(hertz * 1_Hz) : 0;
    const complex axis_with = g / (1.0 - q + inverse * g);
    const complex s = 1.0 / (1.0 + g * (pi_ * (150.0 + speed) + inverse) / (1.0 - q));
    return {150.0 * pi_ * axis_with / (1.0 + pi_ * axis_with * speed), s, g * s};
}
} // namespace

TEST_CASE(
    "disturbance_observer: margins and bandwidth of the thesis' loops with it are those of the reference") {
    // shared/reference/thesis.md, "On the model (ours)": 13.7 dB, 71.9 deg, 33.7 Hz (x), 12.9 dB, 71.0 deg,
    // 38.0 Hz (y); the sensitivity is 1 / (1 + all that is fed back). Q is bilinear here, continuous there: 0.1
    // dB.
    struct wanted {
        const axis& a;
        double gain_margin, phase_margin, bandwidth;
    };
    for (const auto& [a, gm, pm, hz] : {wanted{x, 13.7, 71.9, 33.7}, wanted{y, 12.9, 71.0, 38.0}}) {
        const auto ob = of(a);
        double margin = 0, phase = 0, bandwidth = 0;
        auto before = figures(a, &ob, 1);
        for (double f = 1.01; f < 150; f += 0.01) {
            const auto now = figures(a, &ob, f);
            if (phase == 0 && std::abs(now.position_loop) < 1)
                phase = 180 + std::arg(now.position_loop) * 180 / pi;
            if (margin == 0 && before.position_loop.imag() < 0 && now.position_loop.imag() >= 0)
                margin = -20 * std::log10(std::abs(now.position_loop));
            if (bandwidth == 0 && std::abs(now.sensitivity) > std::sqrt(0.5)) bandwidth = f;
            before = now;
        }
        CHECK(std::abs(margin - gm) < 0.2);
        CHECK(std::abs(phase - pm) < 0.1);
        CHECK(std::abs(bandwidth - hz) < 0.1);
    }
}
TEST_CASE("disturbance_observer: helps up to 44 Hz on x and 59 Hz on y, a little above where |Q| is -3 dB; "
          "beyond it makes worse") {
    struct wanted {
        const axis& a;
        double crossing, worst, at;
    };
    for (const auto& [a, crossing, most, where] : {wanted{x, 44.45, 1.44, 80}, wanted{y, 58.76, 1.62, 95}}) {
        const auto ob = of(a);
        const auto ratio = [&, &a = a](double f) { // of the error that a force leaves, with and without
            return std::abs(figures(a, &ob, f).compliance / figures(a, nullptr, f).compliance);
        };
        double f = 1, worst = 0, at = 0;
        while (ratio(f) < 1) f += 0.01;
        CHECK(std::abs(f - crossing) < 0.1);
        for (; f < 300; f += 0.1)
            if (ratio(f) > worst) worst = ratio(f), at = f;
        CHECK(worst == Approx(most).epsilon(0.01));
        CHECK(at == Approx(where).epsilon(0.02));
    }
}
