// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <doctest/doctest.h>
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/slip_contact.hpp>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr double mass = 340, step = 2e-5;
template <class Real = double> using contact = slip_contact<4, Real>;
using newton_per_metre = gain_of<signal::force, signal::position>;
using newton_per_second = quantity<unit_quotient<si::force, si::time>>;

/// The y axis of the thesis' table: four springs, the attraction of its table.
contact<>::parameters thesis_y(double attraction = 1000) {
    contact<>::parameters p;
    p.level = 100_N;
    p.excess = 50_N;
    p.stribeck_velocity = 2.2_mm / 1_s;
    p.viscous = 850_N / 1_mps;
    p.weights = {0.4, 0.3, 0.2, 0.1};
    p.stiffness = {newton_per_metre::from_value(2e7), newton_per_metre::from_value(8e6),
                   newton_per_metre::from_value(2e6), newton_per_metre::from_value(5e5)};
    p.attraction = newton_per_second::from_value(attraction);
    return p;
}
maxwell_slip<4> same_as_block(const contact<>::parameters& p) {
    return {{.curve = {.coulomb = p.level,
                       .static_level = p.level + p.excess,
                       .stribeck_velocity = p.stribeck_velocity,
                       .viscous = p.viscous},
             .weights = p.weights,
             .stiffness = p.stiffness,
             .attraction = p.attraction},
            duration::from_value(step)};
}
double sum(const contact<>::state& s) {
    double out = 0;
    for (double f : s.force) out += f;
    return out;
}
} // namespace

TEST_CASE("slip_contact: a mass on it moves as on the maxwell_slip block that is solved to the last bit") {
    for (double attraction : {1000.0, 1e9}) {
        CAPTURE(attraction);
        const auto p = thesis_y(attraction);
        const contact<> guide(p, mass, step);
        contact<>::state s;
        auto block = same_as_block(p);
        double v = 0, x = 0, most = 0;
        quantity_of<signal::velocity> w;
        double y = 0;
        for (int k = 0; k < 200000; ++k) { // 4 s: presliding, breakaway, strokes of some millimetres, reversals
            const double drive =
                170 * std::sin(2 * 3.14159265 * 0.7 * k * step) + 60 * std::sin(2 * 3.14159265 * 11 * k * step);
            v = guide(s, mass * v + step * drive, v);
            x += step * v;
            const auto to =
                presliding<double>(block, quantity<si::mass>::from_value(mass), w,
                                   quantity_of<signal::force>::from_value(drive), duration::from_value(step));
            block.become(to.friction);
            w = to.v;
            y += step * w.value();
            most = std::max(most, std::abs(x));
        }
        CHECK(most > 1e-3);
        CHECK(std::abs(x - y) <
              2e-3 * most); // the level is that of the step's start: an error of the order of the step
    }
}

TEST_CASE("slip_contact: a push below the breakaway level holds, and a lasting one above it slides") {
    const contact<> guide(thesis_y(1e9), mass, step);
    contact<>::state s;
    double v = 0, x = 0;
    const auto push = [&](double to,
                          int steps) { // slowly: a push that jumps swings the springs to twice its size
        for (int k = 0; k < steps; ++k) {
            const double drive = to * std::min(1.0, 2.0 * k / steps);
            v = guide(s, mass * v + step * drive, v);
            x += step * v;
        }
    };
    push(140, 100000);
    CHECK(std::abs(v) < 1e-4);
    CHECK(sum(s) == doctest::Approx(140).epsilon(0.02));
    CHECK(x < 1e-4);
    push(160, 100000);
    CHECK(v > 0.01);
}

TEST_CASE("slip_contact: no random push gets more energy out than it put in") {
    std::mt19937 random(3);
    std::normal_distribution<double> draw;
    for (double attraction : {300.0, 1e5, 1e300}) {
        CAPTURE(attraction);
        auto p = thesis_y(attraction);
        p.asymmetry = 0.3;
        p.damping = 0.4_ms;
        const contact<> guide(p, mass, step * 20);
        contact<>::state s;
        const double h = step * 20;
        double v = 0, put_in = 0, drive = 0, least = 0;
        for (int k = 0; k < 100000; ++k) {
            if (k % 25 == 0) drive = 150 * draw(random);
            const double before = v;
            v = guide(s, mass * v + h * drive, v);
            put_in += 0.5 * (before + v) * h * drive;
            double stored = 0.5 * mass * v * v;
            for (std::size_t i = 0; i < 4; ++i)
                stored += 0.5 * s.force[i] * s.force[i] / p.stiffness[i].value();
            least = std::min(least, put_in - stored);
        }
        CHECK(least > -1e-9 * put_in);
    }
}

TEST_CASE("slip_contact: one spring by its own path is one of several by the general one") {
    auto p = thesis_y();
    p.weights = {1, 0, 0, 0};
    p.stiffness = {newton_per_metre::from_value(2e7), {}, {}, {}};
    auto q = p; // the same, with a spring so weak that it does nothing
    q.stiffness[1] = newton_per_metre::from_value(1e-30);
    const contact<> one(p, mass, step), several(q, mass, step);
    contact<>::state a, b;
    double v = 0, w = 0;
    for (int k = 0; k < 100000; ++k) {
        const double drive = 200 * std::sin(1e-3 * k) * std::sin(1.7e-4 * k);
        v = one(a, mass * v + step * drive, v);
        w = several(b, mass * w + step * drive, w);
        REQUIRE(std::abs(v - w) < 1e-9);
    }
}

TEST_CASE("slip_contact: lanes are contacts of their own") {
    using four = lanes<4>;
    contact<four>::parameters together;
    std::array<contact<>::parameters, 4> each;
    for (std::size_t i = 0; i < 4; ++i) {
        each[i] = thesis_y(i == 0 ? 1e300 : 200.0 * static_cast<double>(i));
        each[i].asymmetry = 0.1 * static_cast<double>(i);
        if (i == 2) each[i].excess = 0_N;
    }
    const auto put = [&](auto of) {
        auto to = of(together);
        for (std::size_t i = 0; i < 4; ++i) set_lane(to, i, of(each[i]));
        return to;
    };
    together.level = put([](auto& p) { return p.level; });
    together.excess = put([](auto& p) { return p.excess; });
    together.stribeck_velocity = put([](auto& p) { return p.stribeck_velocity; });
    together.viscous = put([](auto& p) { return p.viscous; });
    together.asymmetry = put([](auto& p) { return p.asymmetry; });
    together.attraction = put([](auto& p) { return p.attraction; });
    for (std::size_t j = 0; j < 4; ++j) {
        together.weights[j] = put([&](auto& p) { return p.weights[j]; });
        together.stiffness[j] = put([&](auto& p) { return p.stiffness[j]; });
    }
    const contact<four> guides(together, four(mass), four(step));
    contact<four>::state s;
    four v(0);
    std::array<contact<>::state, 4> alone;
    std::array<double, 4> w{};
    for (int k = 0; k < 50000; ++k) {
        const double drive = 220 * std::sin(1e-3 * k);
        v = guides(s, four(mass) * v + four(step * drive), v);
        for (std::size_t i = 0; i < 4; ++i) {
            w[i] = contact<>(each[i], mass, step)(alone[i], mass * w[i] + step * drive, w[i]);
            REQUIRE(std::abs(v[i] - w[i]) <= 1e-12 * (1 + std::abs(w[i]))); // the exponential is another one
        }
    }
}

TEST_CASE("slip_contact: what no guide has is refused by name") {
    auto p = thesis_y();
    p.attraction = newton_per_second::from_value(0);
    CHECK_THROWS_WITH(contact<>(p, mass, step), "slip_contact.attraction = 0: must be above 0");
    p = thesis_y();
    p.asymmetry = 1.5;
    CHECK_THROWS_WITH(contact<>(p, mass, step), "slip_contact.asymmetry = 1.5: must lie between -1 and 1");
    p = thesis_y();
    p.stiffness[2] = -p.stiffness[2];
    CHECK_THROWS_WITH(contact<>(p, mass, step),
                      "slip_contact.stiffness = -2e+06 N/m: must be finite and not below 0");
}

TEST_CASE(
    "slip_contact: the excess falls by the shape, as that of the stribeck block, and in a lane as alone") {
    const auto held = [](const auto& guide, auto v) { // the springs under a velocity that a heavy mass keeps
        using number = decltype(v);
        typename contact<number>::state s;
        for (int k = 0; k < 20000; ++k) guide(s, number(1e12) * v, v);
        number out(0);
        for (const number& f : s.force) out = out + f;
        return out;
    };
    using four = lanes<4>;
    contact<four>::parameters together;
    const std::array shapes{0.5, 1.0, 2.0, 4.0};
    auto p = thesis_y(1e300);
    together.level = quantity_of<signal::force, four>::from_value(four(100));
    together.excess = quantity_of<signal::force, four>::from_value(four(50));
    together.stribeck_velocity = quantity_of<signal::velocity, four>::from_value(four(2.2e-3));
    for (std::size_t i = 0; i < 4; ++i) {
        together.weights[i] = four(p.weights[i]);
        together.stiffness[i] =
            gain_of<signal::force, signal::position, four>::from_value(four(p.stiffness[i].value()));
        together.shape.set(i, shapes[i]);
    }
    for (const double v : {1e-3, 2.2e-3, 5e-3}) {
        const four all = held(contact<four>(together, four(1e12), four(step)), four(v));
        for (std::size_t i = 0; i < 4; ++i) {
            CAPTURE(shapes[i]);
            p.shape = shapes[i];
            p.viscous = {};
            const double alone = held(contact<>(p, 1e12, step), v);
            CHECK(alone ==
                  doctest::Approx(100 + 50 * std::exp(-std::pow(v / 2.2e-3, shapes[i]))).epsilon(1e-9));
            CHECK(all[i] == doctest::Approx(alone).epsilon(1e-12));
        }
    }
    p.shape = 5;
    CHECK_THROWS_WITH(contact<>(p, mass, step), "slip_contact.shape = 5: must lie between 0.25 and 4");
}

TEST_CASE("slip_contact: each direction breaks away at its own static level and falls with its own Stribeck "
          "velocity") {
    auto p = thesis_y(1e300);
    p.asymmetry = 0.1;
    p.excess_asymmetry = -0.4;
    p.velocity_asymmetry = 0.3;
    const contact<> guide(p, mass, step);
    for (const double sign : {1.0, -1.0}) {
        CAPTURE(sign);
        const double level = 100 * (1 + 0.1 * sign), excess = 50 * (1 - 0.4 * sign),
                     vs = 2.2e-3 * (1 + 0.3 * sign);
        const auto held = [&](double v) { // the springs under a velocity that a heavy mass keeps
            const contact<> driven(p, 1e12, step);
            contact<>::state s;
            for (int k = 0; k < 20000; ++k) driven(s, 1e12 * v, v);
            return sum(s);
        };
        for (const double v : {1e-3, 4e-3, 0.1})
            CHECK(held(sign * v) == doctest::Approx(sign * (level + excess * std::exp(-v / vs))).epsilon(1e-9));
        const auto slides = [&](double to) {
            contact<>::state s;
            double v = 0;
            for (int k = 0; k < 200000; ++k) {
                const double drive = sign * to * std::min(1.0, 1e-5 * k);
                v = guide(s, mass * v + step * drive, v);
            }
            return sign * v > 1e-3;
        };
        CHECK_FALSE(
            slides(0.9 * (level + excess))); // the springs creep under a push, and their level falls a little
        CHECK(slides(1.03 * (level + excess)));
    }
}

TEST_CASE(
    "slip_contact: a load that presses on it raises what it holds, also where it holds nothing by itself") {
    contact<>::parameters p;
    p.weights[0] = 1;
    p.give[0] = quantity_of<signal::position>::from_value(1e-6);
    const contact<> guide(p, mass, step);
    // The displacement after a second [m]; the push grows slowly first, as one at once would stretch the
    // contact twice as far.
    const auto pushed = [&](double push, double added) {
        contact<>::state s;
        double v = 0, x = 0;
        for (int k = -50000; k < 50000; ++k) {
            v = guide(s, mass * v + step * push * std::min(1.0, (k + 50000) / 50000.0), v, 0, added);
            x += step * v;
        }
        return x;
    };
    CHECK(pushed(9, 10) == doctest::Approx(0.9e-6).epsilon(0.1));
    CHECK(pushed(11, 10) > 0.5 * (11 - 10) / mass);
    // Without the load it holds nothing: a push that grows for a second and stays for another, 1/6 + 1/2 + 1/2.
    CHECK(pushed(11, 0) == doctest::Approx(11 / mass * (1.0 / 6 + 0.5 + 0.5)).epsilon(0.001));
}
