// SPDX-License-Identifier: BSL-1.0
// Long: one rule, retuning without a jump, for each block outside the laws.
// Other parameters in the middle of a random signal, beside a twin that keeps its own: what the coming output
// is off by is bounded by the formula in the block's doc comment, for every pair of parameters, and the bound
// is reached.
#include <quadrant/base/literals.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/control/dead_band.hpp>
#include <quadrant/control/proportional.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/control/rate_limiter.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/memory/fractional_delay.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>

#include "retuned.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
/// `bound(x, y, b, next_b)` from the signal, the twin's outputs, and the first coefficients of both.
template <class Block> void check_filter(auto draw, auto bound) {
    random_numbers random;
    verdict said;
    for (int trial = 0; trial < 3000; ++trial) {
        const Block other(draw(random), T);
        Block twin(draw(random), T), kept = twin;
        const auto x = random.signal(60);
        std::vector<double> y;
        for (std::size_t k = 0; k + 1 < x.size(); ++k) y.push_back(step(twin, x[k])), step(kept, x[k]);
        const double b = first(Block(twin.given(), T)), other_b = first(other);
        kept.retune(other);
        const double was = step(twin, x.back()), is = step(kept, x.back());
        said(is - was, bound(x, y, b, other_b), 1e-11 * largest(x) * (b + other_b));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999); // the formula is an equality
    CHECK(said.most < 1.001);

    // At a constant input nothing happens, then or later.
    double off = 0;
    for (int trial = 0; trial < 100; ++trial) {
        Block block(draw(random), T);
        block.settle(Block::argument::from_value(7));
        const double before = step(block, 7);
        block.retune(Block(draw(random), T));
        for (int k = 0; k < 100; ++k) off = std::max(off, std::abs(step(block, 7) - before));
    }
    CHECK(off <= 1e-10);
}
double moved(const std::vector<double>& x) { return std::abs(x.back() - x[x.size() - 2]); }
} // namespace

TEST_CASE("retune: notch and butterworth, the output is off by (b0' - b0)(x[k] - x[k-1]), and by nothing at a "
          "constant input") {
    const auto bound = [](const auto& x, const auto&, double b, double next) {
        return std::abs(next - b) * moved(x);
    };
    check_filter<notch<signal::force>>(
        [](auto& r) {
            return notch<signal::force>::parameters{.centre = r.decades(10, 900) * 1_Hz,
                                                    .width = r.decades(0.01, 2)};
        },
        bound);
    check_filter<butterworth<signal::force>>(
        [](auto& r) { return butterworth<signal::force>::parameters{r.decades(10, 900) * 1_Hz}; }, bound);
}

TEST_CASE(
    "retune: a transfer function is off by (b0' - b0)(x[k] - x[k-1]), and by nothing at a constant input where "
    "both have one gain there") {
    using filter = transfer_function<signal::force, signal::force, 2>;
    check_filter<filter>(
        [](auto& r) {
            const double w = 2 * pi * r.decades(1, 500);
            return filter::parameters::in_si(
                bilinear(continuous<2>{{w * w, r.decades(0.01, 2) * w, r.decades(0.01, 1)},
                                       {w * w, r.decades(0.1, 2) * w, 1}},
                         T));
        },
        [](const auto& x, const auto&, double b, double next) { return std::abs(next - b) * moved(x); });
}

TEST_CASE("retune: a Ferraris estimate is off by b0' (f'[k] - f[k-1]) - b0 (f[k] - f[k-1])") {
    using estimator = ferraris_force_estimator<signal::voltage>;
    random_numbers random;
    const auto draw = [&] {
        return estimator({.mass = random.decades(10, 1000) * 1_kg,
                          .force_constant = random.decades(10, 1000) * (1_N / 1_V),
                          .corner = random.decades(1, 500) * 1_Hz},
                         T);
    };
    verdict said;
    for (int trial = 0; trial < 20000; ++trial) {
        estimator kept = draw(), twin = kept;
        const estimator other = draw();
        const auto a = random.signal(40), u = random.signal(40);
        for (std::size_t k = 0; k + 1 < a.size(); ++k)
            kept(a[k] * 1_mps2, u[k] * 1_V), twin(a[k] * 1_mps2, u[k] * 1_V);
        kept.retune(other);
        const double was = twin(a[39] * 1_mps2, u[39] * 1_V).value(),
                     is = kept(a[39] * 1_mps2, u[39] * 1_V).value();
        const auto force = [&](const estimator& e, std::size_t k) {
            return e.given().mass.value() * a[k] - e.given().force_constant.value() * u[k];
        };
        const auto first_of = [](estimator fresh) {
            return fresh(1_mps2).value() / fresh.given().mass.value();
        };
        const double b = first_of(estimator(twin.given(), T)), next = first_of(other);
        const double size = 1000 * (largest(a) + largest(u));
        said(is - was,
             std::abs(next * (force(kept, 39) - force(twin, 38)) - b * (force(twin, 39) - force(twin, 38))),
             1e-11 * size);
        CHECK(kept.command().value() ==
              doctest::Approx(is / kept.given().force_constant.value()).epsilon(1e-14));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);
    estimator e = draw();
    e.retune(estimator(e.given(), 2.0 * T));
    CHECK(e.faulted());
}

TEST_CASE(
    "retune: lowpass and filtered derivative, the output is off by the change of b times what b multiplies") {
    check_filter<lowpass<signal::force>>(
        [](auto& r) { return lowpass<signal::force>::parameters{r.decades(1, 900) * 1_Hz}; },
        [](const auto& x, const auto& y, double b, double next) {
            return std::abs((next - b) * (x.back() + x[x.size() - 2] - 2 * y.back()));
        });
    using derivative = filtered_derivative<signal::position, signal::velocity>;
    check_filter<derivative>(
        [](auto& r) { return derivative::parameters{r.decades(1, 900) * 1_Hz}; },
        [](const auto& x, const auto& y, double b, double next) { // b/T is what an impulse gives
            const double rate = (x.back() - x[x.size() - 2]) / T.value();
            return std::abs((next - b) * T.value() * (rate - y.back()));
        });
}

TEST_CASE("retune: a series retunes each of its blocks") {
    using two = series<notch<signal::force>, notch<signal::force>>;
    two pair({{330_Hz, 0.1}, {200_Hz, 0.2}}, T);
    const two other({{340_Hz, 0.1}, {180_Hz, 0.3}}, T);
    for (int k = 0; k < 50; ++k) step(pair, std::sin(0.1 * k));
    pair.retune(other);
    CHECK(std::get<1>(pair.given()).centre == 180_Hz);
    pair.settle(3_N);
    pair.retune(two({{100_Hz, 0.1}, {90_Hz, 0.3}}, T));
    CHECK(step(pair, 3) == doctest::Approx(3).epsilon(1e-14));
    pair.shift(2_N);
    CHECK(step(pair, 5) == doctest::Approx(5).epsilon(1e-14));
}

TEST_CASE("retune: a gain jumps by its change times the input") {
    proportional<signal::position, signal::velocity> kv{{150.0 / 1_s}, T};
    kv.retune({{160.0 / 1_s}, T});
    CHECK(kv(2_mm).value() == doctest::Approx(0.32));
}

TEST_CASE("retune: a rate limiter jumps by at most the change of its rate times the period, a dead band by the "
          "change of its width") {
    random_numbers random;
    std::array<verdict, 2> said;
    for (int trial = 0; trial < 20000; ++trial) {
        const auto x = random.signal(50); // 50 x 20 000 = 1e6 samples
        const double size = largest(x);
        const auto rate = [&] { return random.decades(1e-3, 1) * size / T.value(); };
        const auto width = [&] { return random.decades(1e-3, 1) * size; };
        const double r = rate(), next_r = rate(), w = width(), next_w = width();
        using ramp = rate_limiter<signal::force>;
        using band = dead_band<signal::force>;
        const auto slope = [](double bare) { return bare * 1_N / 1_s; };
        ramp kept({slope(r)}, T), twin = kept;
        band kept_band({w * 1_N}, T), twin_band = kept_band;
        for (std::size_t k = 0; k + 1 < x.size(); ++k)
            step(kept, x[k]), step(twin, x[k]), step(kept_band, x[k]), step(twin_band, x[k]);
        kept.retune(ramp({slope(next_r)}, T));
        kept_band.retune(band({next_w * 1_N}, T));
        said[0](step(kept, x.back()) - step(twin, x.back()), std::abs(next_r - r) * T.value(), 1e-14 * size);
        said[1](step(kept_band, x.back()) - step(twin_band, x.back()), std::abs(next_w - w), 1e-14 * size);
    }
    for (const verdict& each : said) {
        CHECK(each.broken == 0);
        CHECK(each.most > 0.999);
    }
    rate_limiter<signal::force> slow({1000_N / 1_s}, T);
    slow.retune({{2000_N / 1_s}, 2.0 * T}); // designed for another period
    CHECK(slow.faulted());
    CHECK(slow.given().rate == 1000_N / 1_s);
}

TEST_CASE_TEMPLATE("retune: the PI's next output moves by no more than its new gains would have moved it", Rule,
                   integral_clamp, conditional_integration, back_calculation) {
    using pi_loop = proportional_integral<signal::velocity, signal::voltage, Rule>;
    random_numbers random;
    const auto draw = [&](double limit) {
        typename pi_loop::parameters p{random.decades(1, 100) * (1_V / 1_mps),
                                       random.decades(1, 1e5) * (1_V / 1_m), limit * 1_V};
        if constexpr (std::same_as<Rule, back_calculation>) p.anti_windup = {10_ms};
        return p;
    };
    verdict said;
    for (int trial = 0; trial < 3000; ++trial) {
        const double limit = trial % 3 == 0 ? random.decades(0.1, 100) : 1e9; // restrained or free
        pi_loop loop(draw(limit), T);
        const pi_loop other(draw(random.between(0.5, 1) * limit), T);
        const auto e = random.signal(60);
        double u = 0;
        for (std::size_t k = 0; k + 1 < e.size(); ++k) u = step(loop, e[k]);
        const double last = e[e.size() - 2], now = e.back(), integral = u - other.given().gain.value() * last;
        loop.retune(other, last * 1_mps);
        double bound = other.given().gain.value() * std::abs(now - last) +
                       other.given().integral_gain.value() * T.value() * std::abs(now);
        if (std::same_as<Rule, integral_clamp>)
            bound += std::max(0.0, std::abs(integral) - other.given().limit.value());
        if constexpr (std::same_as<Rule, back_calculation>)
            bound += T.value() / 0.01 * std::abs(loop.now().excess.value());
        said(step(loop, now) - u, bound, 1e-13 * (std::abs(u) + other.given().gain.value() * std::abs(last)));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
}

TEST_CASE("retune: the observer's estimate is off by the formula, and by nothing in even motion") {
    using observer = disturbance_observer<signal::voltage>;
    random_numbers random;
    const auto draw = [&] {
        return observer(
            {random.decades(5, 300) * 1_Hz,
             axis_model<signal::voltage>{random.decades(1, 10) * (1_mps2 / 1_V), random.between(0, 50) / 1_s}},
            T);
    };
    const auto coefficients = [](observer fresh) { // d = (p0 x - q0 wanted)/(1 - q0), from rest
        observer twin = fresh;
        const double to_wanted = fresh(0_m, 1_V).value(), to_measured = twin(1_m, 0_V).value();
        const double q0 = to_wanted / (to_wanted - 1);
        return std::array{to_measured * (1 - q0), q0};
    };
    verdict said;
    for (int trial = 0; trial < 2000; ++trial) {
        observer kept = draw(), twin = kept;
        const observer other = draw();
        const auto z = random.signal(60), wanted = random.signal(60);
        const auto give = [](observer& o, double at, double w) { return o(1e-6 * at * 1_m, w * 1_V).value(); };
        const auto tell = [&](observer& o) { // something was clipped
            o.applied(o.now().command + 0.1 * wanted[3] * 1_V);
        };
        for (std::size_t k = 0; k < 59; ++k) {
            give(kept, z[k], wanted[k]), give(twin, z[k], wanted[k]);
            if (k % 4 == 0) tell(kept), tell(twin);
        }
        const double before = twin.now().command.value();
        kept.retune(other);
        const double was = give(twin, z[59], wanted[59]), is = give(kept, z[59], wanted[59]);
        const auto [p, q] = coefficients(observer(twin.given(), T));
        const auto [next_p, next_q] = coefficients(other);
        const double x = 1e-6 * (z[59] - 2 * z[58] + z[57]), u = wanted[59] - was - before;
        said(is - was, std::abs(((next_p - p) * x - (next_q - q) * u) / (1 - next_q)),
             1e-9 * (largest(wanted) + std::abs(was) + 1e-6 * largest(z) * (p + next_p)));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);

    observer o({60_Hz, axis_model<signal::voltage>{4.526_mps2 / 1_V, 28.57 / 1_s}}, T);
    double off = 0, before = 0;
    for (int k = 0; k < 3000; ++k) {
        if (k == 2000)
            o.retune(observer({200_Hz, axis_model<signal::voltage>{4.526_mps2 / 1_V, 28.57 / 1_s}}, T));
        o(50e-6 * k * 1_m, 1_V); // 0.1 m/s
        o.applied(1_V);
        const double d = o.disturbance().value();
        if (k >= 2000) off = std::max(off, std::abs(d - before));
        if (k == 1999) before = d;
    }
    CHECK(off <= 1e-9); // rounding of positions over T, through the inverse
}

TEST_CASE(
    "retune: a delay jumps by at most its change times the largest step of the inputs (4/3 of that, cubic)") {
    random_numbers random;
    std::array<verdict, 3> said;
    for (int trial = 0; trial < 3000; ++trial) {
        const auto x = random.signal(40);
        // The steepest step that either delay, or what lies between, is read from; one more beside, for the
        // cubic.
        const auto steepest = [&](double a, double b) {
            double most = 0;
            const auto from = std::size_t(std::min(a, b)), to = std::size_t(std::ceil(std::max(a, b)));
            for (std::size_t age = from > 0 ? from - 1 : 0; age < to + 1; ++age)
                most = std::max(most, std::abs(x[39 - age] - x[38 - age]));
            return most;
        };
        const std::size_t n = random.engine() % 21, next_n = random.engine() % 21;
        delay_line<signal::force, 20> whole({n}, T), whole_twin = whole;
        const double d = random.between(1, 20),
                     next = trial % 2 == 0 ? random.between(1, 20) : std::min(20.0, d + 0.01);
        fractional_delay<signal::force, 20, 1> line({d * T}, T), line_twin = line;
        fractional_delay<signal::force, 20, 3> cubic({d * T}, T), cubic_twin = cubic;
        for (std::size_t k = 0; k < 39; ++k)
            step(whole, x[k]), step(whole_twin, x[k]), step(line, x[k]), step(line_twin, x[k]),
                step(cubic, x[k]), step(cubic_twin, x[k]);
        if (trial % 3 == 0) // either way
            whole.length(next_n), line.delay(next * T), cubic.delay(next * T);
        else
            whole.retune({{next_n}, T}), line.retune({{next * T}, T}), cubic.retune({{next * T}, T});
        const double by = std::abs(next - d), most = steepest(d, next), rounding = 1e-12 * largest(x);
        said[0](step(whole, x[39]) - step(whole_twin, x[39]),
                std::abs(double(next_n) - double(n)) * steepest(double(n), double(next_n)), rounding);
        said[1](step(line, x[39]) - step(line_twin, x[39]), by * most, rounding);
        said[2](step(cubic, x[39]) - step(cubic_twin, x[39]), 4.0 / 3 * by * most, rounding);
    }
    for (const verdict& each : said) {
        CHECK(each.broken == 0);
        CHECK(each.most > 0.9);
    }
}

namespace {
using memory = repetitive<signal::position, 40, 2, 5, 3>;
memory learner(random_numbers& random, double cycle) {
    memory::parameters p{.cycle = cycle * T, .weights = {random.between(0.5, 2), 0}, .ahead = 2, .fade = 5_ms};
    p.weights[1] = 1 - p.weights[0];
    for (double& each : p.learning) each = random.between(-0.4, 0.4);
    p.smoothing[0] = p.smoothing[2] = random.between(0, 0.3);
    p.smoothing[1] = 1 - 2 * p.smoothing[0];
    return {p, T};
}
double sum_of(const auto& taps) {
    double sum = 0;
    for (const double each : taps) sum += std::abs(each);
    return sum;
}
double peak(const auto& ring) {
    double most = 0;
    for (const auto& each : ring) most = std::max(most, std::abs(each.value()));
    return most;
}
} // namespace

TEST_CASE("retune: a memory's new length is faded in, nothing at the first sample and a share of the "
          "difference at each") {
    random_numbers random;
    verdict said;
    int jumps = 0;
    for (int trial = 0; trial < 300; ++trial) {
        memory kept = learner(random, random.between(10, 30)), twin = kept;
        const auto e = random.signal(160);
        for (std::size_t k = 0; k < 140; ++k) step(kept, e[k]), step(twin, e[k]);
        kept.cycle(random.between(10, 39) * T);
        if (!kept.fading()) continue;
        double off = 0;
        for (std::size_t j = 0; j < 8; ++j) { // till a change comes round again
            const double range = 2 * 1.25 * sum_of(kept.given().weights) * peak(twin.now().p);
            const double more = step(kept, e[140 + j]) - step(twin, e[140 + j]);
            jumps += j == 0 && std::abs(more) > 1e-14 * range;
            said(more - off, sum_of(kept.given().learning) * range / 10, 1e-12 * range); // 5 ms are 10 steps
            off = more;
        }
    }
    CHECK(jumps == 0);
    CHECK(said.broken == 0);
    CHECK(said.most > 0.9); // of the worst that could have been learnt
}

TEST_CASE("retune: a memory keeps what it has learnt under other filters and weights") {
    random_numbers random;
    verdict said;
    for (int trial = 0; trial < 2000; ++trial) {
        const double cycle = random.between(10, 39);
        memory kept = learner(random, cycle), twin = kept;
        const memory other = learner(random, cycle);
        const auto e = random.signal(100);
        for (std::size_t k = 0; k < 99; ++k) step(kept, e[k]), step(twin, e[k]);
        kept.retune(other);
        const double was = step(twin, e[99]), is = step(kept, e[99]);
        std::array<double, 5> taps{};
        for (std::size_t i = 0; i < 5; ++i) taps[i] = other.given().learning[i] - twin.given().learning[i];
        const double weights =
            std::abs(other.given().weights[0] - twin.given().weights[0]) * 2; // both move alike
        said(is - was,
             sum_of(taps) * peak(twin.now().r.x) +
                 1.25 * std::abs(other.given().learning[0]) * weights * peak(twin.now().p),
             1e-12 * (peak(twin.now().r.x) + peak(twin.now().p)));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.9);
}

namespace {
using slipping = stribeck<>;
using dahl_law = dahl<>;
using lugre_law = lugre<>;
using springs = maxwell_slip<3>;

auto draw_curve(random_numbers& r) {
    const double level = r.decades(10, 1000);
    return slipping::parameters{level * 1_N, r.between(1, 2) * level * 1_N, r.decades(1e-3, 0.1) * 1_mps,
                                r.decades(1, 1e3) * (1_N / 1_mps)};
}
template <class Law> Law draw_law(random_numbers& r) {
    const auto stiff = [&] { return r.decades(1e5, 1e8) * (1_N / 1_m); };
    if constexpr (std::same_as<Law, slipping>)
        return {draw_curve(r), T};
    else if constexpr (std::same_as<Law, dahl_law>)
        return {{r.decades(10, 1000) * 1_N, stiff(), r.between(0, 2), r.decades(1, 1e3) * (1_N / 1_mps)}, T};
    else if constexpr (std::same_as<Law, lugre_law>)
        return {{draw_curve(r), stiff(), r.decades(1, 1e5) * (1_N / 1_mps)}, T};
    else {
        springs::parameters p{.curve = draw_curve(r), .stiffness = {stiff(), stiff(), stiff()}};
        p.weights = {r.between(0.1, 1), r.between(0.1, 1), r.between(0.1, 1)};
        const double sum = p.weights[0] + p.weights[1] + p.weights[2];
        for (double& w : p.weights) w /= sum;
        p.attraction = r.decades(10, 1e6) * (1_N / 1_s);
        return {p, T};
    }
}
/// The dry part of what a law holds, and what it can hold at most.
double held(const dahl_law& law) { return law.now().force.value(); }
double held(const lugre_law& law) { return law.now().force.value(); }
double held(const springs& law) {
    double sum = 0;
    for (const auto& each : law.now().elements) sum += each.force.value();
    return sum;
}
double most_held(const dahl_law& law) { return law.given().coulomb.value(); }
double most_held(const auto& law) { return law.given().curve.static_level.value(); }
double viscous(const dahl_law& law) { return law.given().viscous.value(); }
double viscous(const auto& law) { return law.given().curve.viscous.value(); }
/// How far the dry part can go in one sample at v.
double reach(const dahl_law& law, double v) {
    return std::exp2(law.given().shape) * law.given().stiffness.value() * std::abs(v) * T.value();
}
double reach(const lugre_law& law, double v) {
    const auto& p = law.given();
    return (1 + p.curve.static_level / p.curve.coulomb) *
           (p.stiffness.value() * T.value() + p.damping.value()) * std::abs(v);
}
double reach(const springs& law, double v) {
    const auto& p = law.given();
    const double relaxes = p.attraction.value() * std::max(1.0, p.curve.static_level / p.curve.coulomb - 1);
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        sum += std::max(p.stiffness[i].value() * std::abs(v), relaxes * p.weights[i]) * T.value();
    return sum;
}
} // namespace

TEST_CASE_TEMPLATE(
    "retune: friction that remembers is off by no more than one step of either law, and what the new "
    "one cannot hold",
    Law, dahl_law, lugre_law, springs) {
    random_numbers random;
    verdict said, cut; // less than the new level held, or more
    double beyond = 0, lost = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        Law kept = draw_law<Law>(random), twin = kept;
        const Law other = draw_law<Law>(random);
        auto v = random.signal(60);
        const double scale = random.decades(1e-6, 0.3) / largest(v); // sticks, breaks away, slides
        for (double& each : v) each *= scale;
        for (std::size_t k = 0; k + 1 < v.size(); ++k) step(kept, v[k]), step(twin, v[k]);
        kept.retune(other);
        const double before = held(twin), level = most_held(other), now = v.back();
        beyond = std::max(beyond, std::abs(held(kept)) / level);
        if (std::abs(before) <= level) lost = std::max(lost, std::abs(held(kept) - before) / level);
        const double each = reach(twin, now), next = reach(other, now);
        const double steps = std::same_as<Law, dahl_law> ? std::max(each, next) : each + next;
        const double excess = std::max(0.0, std::abs(before) - level);
        verdict& which = excess > 0 ? cut : said;
        which(step(kept, now) - step(twin, now),
              steps + std::abs(viscous(other) - viscous(twin)) * std::abs(now) + excess,
              1e-11 * (std::abs(before) + level));
    }
    for (const verdict& each : {said, cut}) {
        CAPTURE(each.most);
        CHECK(each.broken == 0);
        CHECK(each.most > 0.9);
    }
    CHECK(beyond <= 1 + 1e-12);
    CHECK(lost <= 1e-12);
}

TEST_CASE("retune: a Stribeck curve jumps by what it changes at the speed") {
    random_numbers random;
    double most = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        slipping kept = draw_law<slipping>(random);
        const slipping other = draw_law<slipping>(random);
        const double v = random.decades(1e-5, 1) * (trial % 2 ? 1 : -1);
        step(kept, -v);
        kept.retune(other);
        slipping fresh = other;
        most = std::max(most, std::abs(step(kept, v) / step(fresh, v) - 1));
    }
    CHECK(most == 0);
}

TEST_CASE("retune: with the same parameters nothing changes, bit for bit; another period is refused") {
    random_numbers random;
    const auto x = random.signal(200);
    const auto check = [&](auto block, const auto& same, const auto& other_period) {
        auto twin = block;
        bool equal = true;
        for (std::size_t k = 0; k < x.size(); ++k) {
            if (k == 100) block.retune(same);
            equal = equal && step(block, x[k]) == step(twin, x[k]);
        }
        CHECK(equal);
        CHECK_FALSE(block.faulted());
        block.retune(other_period);
        CHECK(block.faulted());
        CHECK(step(block, x[7]) == step(twin, x[7]));
    };
    const auto both = [&]<class Block>(const typename Block::parameters& p) {
        check(Block(p, T), Block(p, T), Block(p, 1_ms));
    };
    both.operator()<notch<signal::force>>({330_Hz, 0.1});
    both.operator()<lowpass<signal::force>>({100_Hz});
    both.operator()<disturbance_observer<signal::voltage>>(
        {60_Hz, axis_model<signal::voltage>{4.526_mps2 / 1_V, 28.57 / 1_s}});
    both.operator()<dahl_law>({122_N, 60_N / 1_um, 1, 850_N / 1_mps});
    both.operator()<lugre_law>({{8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1500_N / 1_mm, 2985_N / 1_mps});
    both.operator()<springs>({.curve = {122_N, 177_N, 2_mmps, 850_N / 1_mps},
                              .weights = {0.2, 0.3, 0.5},
                              .stiffness = {60_N / 1_um, 20_N / 1_um, 5_N / 1_um},
                              .attraction = 450_N / 1_s});
    memory m = learner(random, 17);
    check(m, m, memory({.cycle = 20_ms, .ahead = 2}, 1_ms));
}
