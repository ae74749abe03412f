// SPDX-License-Identifier: BSL-1.0
// Long: one loop: a case for each statement of its page.
#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using friction = stribeck<signal::velocity, signal::voltage>;
template <class Friction = friction, class Disturbance = absent<signal::position, signal::voltage>,
          class Memory = absent<signal::position, signal::position>>
using boxes = milling_axis_boxes<Friction, Disturbance, Memory>;
using axis = milling_axis<boxes<>>;

/// The x axis of [Jamaludin2008].
template <class Boxes = boxes<>> typename Boxes::parameters x_axis() {
    typename Boxes::parameters p{.position_gain = 150.0 / 1_s,
                                 .velocity_gain = 60_V / 1_mps,
                                 .velocity_integral = 450_V / 1_m,
                                 .estimator_corner = 942.5 / (2 * pi) * 1_Hz,
                                 .notch = {330_Hz, 0.0606},
                                 .plant_gain = 4.526_mps2 / 1_V,
                                 .plant_pole = 28.57_per_s,
                                 .friction = {},
                                 .disturbance = {},
                                 .memory = {},
                                 .limit = 10_V,
                                 .dac_step = {}};
    if constexpr (std::same_as<decltype(p.friction), friction::parameters>)
        p.friction = {122_V / 1450.0, 177_V / 1450.0, 2.2_mmps, {}};
    return p;
}
quantity<si::length> metres(double x) { return quantity<si::length>::from_value(x); }
template <class Axis = axis> typename Axis::motion motion(int k) {
    const double w = 5, t = k * 5e-4;
    return {0.02 * (1 - std::cos(w * t)) * 1_m, 0.02 * w * std::sin(w * t) * 1_mps,
            0.02 * w * w * std::cos(w * t) * 1_mps2};
}
/// A machine that follows with a lag and an error, so that every wire carries something.
double place(int k) { return k < 3 ? 0 : 0.9998 * motion(k - 2).position.value() + 2e-6 * std::sin(0.9 * k); }

/// The same loop in bare doubles, from the equations of reference/thesis.md.
struct bare {
    double T = 5e-4, integral = 0, last = 0;
    struct estimate {
        double y = 0, v = 0, s0 = 0, s1 = 0;
        double operator()(double x, double h) { // Vest bilinear, then the notch pre-warped
            const double wc = 942.5;
            v = ((2 - wc * h) * v + 2 * wc * (x - y)) / (2 + wc * h);
            y = x;
            const double t = std::tan(std::numbers::pi * 330 * h), a0 = 1 + 0.0606 * t + t * t;
            const double b0 = (1 + t * t) / a0, b1 = 2 * (t * t - 1) / a0, a2 = (1 - 0.0606 * t + t * t) / a0;
            const double out = b0 * v + s0;
            s0 = b1 * v - b1 * out + s1;
            s1 = b0 * v - a2 * out;
            return out;
        }
    } of_reference, of_measured;
    double operator()(const axis::motion& r, double y) {
        const double x = r.position.value();
        const double e = 150 * (x - y) + of_reference(x, T) - of_measured(y, T);
        integral += 450 * T * e;
        const double travel = (x - last) / T, sign = travel > 0 ? 1 : travel < 0 ? -1 : 0;
        last = x;
        const double f = (122 + 55 * std::exp(-std::abs(travel) / 2.2e-3)) * sign / 1450;
        return 60 * e + integral + (r.acceleration.value() + 28.57 * r.velocity.value()) / 4.526 + f;
    }
};

/// Sees the command without friction and gives a hundredth of it; solved: what it sees is wanted - estimate.
struct half_observer {
    using parameters = std::tuple<>;
    half_observer(const parameters&, duration) {}
    quantity<si::electric_potential> operator()(quantity<si::length>, quantity<si::electric_potential> wanted) {
        return wanted * (0.01 / 1.01);
    }
    void applied(quantity<si::electric_potential> u) { seen = u; }
    void reset() { seen = {}; }
    quantity<si::electric_potential> seen{};
};

/// The last error once more: what a memory with a cycle of one sample would give.
struct echo {
    using parameters = std::tuple<>;
    echo(const parameters&, duration) {}
    quantity<si::length> operator()(quantity<si::length> e) { return std::exchange(last, e); }
    void reset() { last = {}; }
    void settle(quantity<si::length> e) { last = e; }
    quantity<si::length> last{};
};

using quiet = absent<signal::velocity, signal::voltage>;
using memory = repetitive<signal::position, 100, 2>;
using learning = milling_axis<boxes<quiet, absent<signal::position, signal::voltage>, memory>>;
/// The x axis with a memory for a cycle of 85 periods, its filters made from the thesis' model.
decltype(learning::box) with_memory() {
    auto p = x_axis<decltype(learning::box)>();
    const analysis::p_pi_loop loop{analysis::rigid_axis_model<>{p.plant_pole, p.plant_gain, 0.65_ms},
                                   analysis::pi_model<>{p.velocity_gain, p.velocity_integral},
                                   analysis::in_series{analysis::derivative_model{p.estimator_corner},
                                                       analysis::notch_model{330_Hz, 0.0606}},
                                   p.position_gain};
    const auto t = [&](frequency f) { return loop.tracking(f); };
    const auto q = analysis::smoothing_filter<61>(200_Hz, Ts);
    const auto whole = analysis::up_to_nyquist(Ts);
    const auto l = analysis::learning_filter<90>(t, q, 30, Ts, whole);
    p.memory = analysis::repetitive_parameters<memory>(t, std::array<double, 2>{2, -1}, l, q, 85.0 * Ts, whole);
    return {p, Ts};
}
} // namespace

TEST_CASE("milling_axis: the thesis' loop in bare doubles, to 1e-9 V, in the linear range") {
    axis typed{.box = {x_axis(), Ts}};
    bare plain;
    double most = 0;
    for (int k = 0; k < 5000; ++k) {
        const double u = plain(motion(k), place(k));
        typed(motion(k), metres(place(k)));
        CHECK(std::abs(typed.wire.wanted.value() - u) < 1e-9);
        most = std::max(most, std::abs(u));
    }
    CHECK(most > 0.5);
    CHECK(most < 9);
}
TEST_CASE(
    "milling_axis: 1 mm of step is 9.03 V of position loop: 150/s times (60 V s/m + 450 V/m times 0.5 ms)") {
    auto p = x_axis<boxes<absent<signal::velocity, signal::voltage>>>();
    milling_axis<boxes<absent<signal::velocity, signal::voltage>>> a{.box = {p, Ts}};
    a({}, -1_mm); // the measured place jumps; Vest of it goes against
    CHECK(a.wire.position_error == 1_mm);
    CHECK((a.wire.feedback.value() - 60.225 * -a.wire.measured_velocity.value()) ==
          doctest::Approx(9.03375).epsilon(1e-9));
}
TEST_CASE("milling_axis: the feedforward of plant and friction looks ahead, the loop does not") {
    axis now{.box = {x_axis(), Ts}}, early{.box = {x_axis(), Ts}};
    for (int k = 0; k < 1000; ++k) {
        now(motion(k), metres(place(k)));
        early(motion(k), motion(k + 2), metres(place(k)));
        CHECK(early.wire.feedback == now.wire.feedback);
    }
    axis later{.box = {x_axis(), Ts}};
    for (int k = 0; k < 1002; ++k) later(motion(k), metres(0));
    CHECK(early.wire.inertia == later.wire.inertia);
    CHECK(early.wire.drag == later.wire.drag);
    CHECK(early.wire.friction == later.wire.friction);
    CHECK(early.wire.inertia != now.wire.inertia);
}
TEST_CASE("milling_axis: an observer is fed the command without friction, less its own estimate, and learns "
          "what was cut off") {
    using observed = milling_axis<boxes<friction, half_observer>>;
    observed a{.box = {x_axis<boxes<friction, half_observer>>(), Ts}};
    axis without{.box = {x_axis(), Ts}};
    for (int k = 0; k < 100; ++k) {
        a(motion<observed>(k), metres(place(k)));
        without(motion(k), metres(place(k)));
        CHECK(a.wire.linear == without.wire.linear);
        CHECK(a.wire.compensated.value() == doctest::Approx(a.wire.linear.value() / 1.01).epsilon(1e-12));
        CHECK(a.box.disturbance.seen.value() == doctest::Approx(a.wire.compensated.value()).epsilon(1e-12));
        CHECK(a.wire.command == a.wire.compensated + a.wire.friction);
    }
    a({}, {}, -20_mm); // 180 V wanted
    CHECK(a.limited());
    CHECK(a.wire.command == 10_V);
    CHECK(a.box.disturbance.seen.value() == doctest::Approx(10 - a.wire.friction.value()).epsilon(1e-9));
    auto stepped = x_axis<boxes<friction, half_observer>>(); // what the DAC rounds off too
    stepped.dac_step = 0.25_V;
    observed b{.box = {stepped, Ts}};
    b(motion<observed>(1), metres(0));
    CHECK(b.wire.command != b.wire.limited);
    CHECK(b.box.disturbance.seen.value() ==
          doctest::Approx((b.wire.command - b.wire.friction).value()).epsilon(1e-9));
}
TEST_CASE("milling_axis: what is cut off is charged to the velocity loop, whoever asked for it") {
    struct listening : boxes<> {
        using boxes<>::boxes;
        struct loop {
            using output = signal::voltage;
            quantity<si::electric_potential> operator()(quantity<si::velocity>) { return 1_V; }
            void applied(quantity<si::electric_potential> u) { told = u; }
            void reset() {}
            void settle(quantity<si::velocity>, quantity<si::electric_potential>) {}
            quantity<si::electric_potential> told{};
        } velocity_loop;
    };
    milling_axis<listening> a{.box = {x_axis(), Ts}};
    a({{}, {}, 10_mps2}, 0_m);
    CHECK(a.box.velocity_loop.told == 1_V); // nothing was cut off
    a({{}, {}, 45.26_mps2}, 0_m);           // 10 V for the mass: 1 V too much
    CHECK(a.limited());
    CHECK(std::abs(a.box.velocity_loop.told.value()) < 1e-12);
}
TEST_CASE("milling_axis: every wire has a tap, and the log header its units") {
    axis a{.box = {x_axis(), Ts}};
    a(motion(1), 1_mm);
    std::string header;
    for_each_tap(a.wire, axis::taps(), [&](const char* name, const char* unit, double) {
        header += std::string(name) + " [" + unit + "] ";
    });
    CHECK(header.find("position_error [m] ") != header.npos);
    CHECK(header.find("travel [m/s] ") != header.npos);
    CHECK(header.find("compensated [V] ") != header.npos);
}
TEST_CASE("milling_axis: settled at rest under a load it goes on without a bump") {
    axis a{.box = {x_axis(), Ts}};
    for (int k = 0; k < 500; ++k) a(motion(k), metres(place(k)));
    a.settle(12_mm, 0.3_V);
    const axis::motion rest{12_mm, {}, {}};
    for (int k = 0; k < 100; ++k) CHECK(a(rest, 12_mm).value() == doctest::Approx(0.3).epsilon(1e-12));
    CHECK_FALSE(a.faulted());
}
TEST_CASE("milling_axis: with the observer in its slot: settled under a load without a bump, and a push of 100 "
          "N moves it less") {
    using observer = disturbance_observer<signal::voltage>;
    using observed = milling_axis<boxes<absent<signal::velocity, signal::voltage>, observer>>;
    using plain = milling_axis<boxes<absent<signal::velocity, signal::voltage>>>;
    auto p = x_axis<boxes<absent<signal::velocity, signal::voltage>, observer>>();
    p.disturbance = {60_Hz, axis_model<signal::voltage>{p.plant_gain, p.plant_pole}};
    observed a{.box = {p, Ts}};
    a.settle(12_mm, 0.3_V);
    for (int k = 0; k < 100; ++k)
        CHECK(a({12_mm, {}, {}}, 12_mm).value() == doctest::Approx(0.3).epsilon(1e-9));
    const auto pushed = [](auto loop) {
        linear_motor<> m{{.mass = 320.4_kg,
                          .force_constant = 1450_N / 1_V,
                          .friction = {{}, 9153_N / 1_mps},
                          .delay = 0.4_ms},
                         Ts};
        auto reading = metres(0);
        double most = 0;
        for (int k = 0; k < 1000; ++k) {
            reading = m(loop({}, reading), 100_N);
            most = std::max(most, std::abs(reading.value()));
        }
        CHECK(std::abs(reading.value()) < 0.3e-6); // the integral is slow
        return most;
    };
    const double with = pushed(observed{.box = {p, Ts}});
    const double without =
        pushed(plain{.box = {x_axis<boxes<absent<signal::velocity, signal::voltage>>>(), Ts}});
    CHECK(without > 4e-6);
    CHECK(with < 0.7 * without);
}
TEST_CASE("milling_axis: what the memory gives is added to the position error, before the position loop and "
          "nowhere else") {
    using echoing = milling_axis<boxes<friction, absent<signal::position, signal::voltage>, echo>>;
    echoing a{.box = {x_axis<decltype(echoing::box)>(), Ts}};
    axis without{.box = {x_axis(), Ts}};
    quantity<si::length> before{};
    for (int k = 0; k < 200; ++k) {
        a(motion<echoing>(k), metres(place(k)));
        without(motion(k), metres(place(k)));
        CHECK(a.wire.position_error == without.wire.position_error);
        CHECK(a.wire.learned == before);
        CHECK((a.wire.demand - without.wire.demand).value() ==
              doctest::Approx(150 * before.value()).epsilon(1e-9).scale(1e-6));
        CHECK(a.wire.drag + a.wire.friction == without.wire.drag + without.wire.friction);
        before = a.wire.position_error;
    }
    a.settle(12_mm);
    CHECK(a.box.memory.last == 0_m);
}
TEST_CASE("milling_axis: a memory that learns nothing changes no bit") {
    using forgetful = repetitive<signal::position, 100, 1, 1, 1>;
    using with = milling_axis<boxes<friction, absent<signal::position, signal::voltage>, forgetful>>;
    auto p = x_axis<decltype(with::box)>();
    p.memory = {.cycle = 85.0 * Ts, .weights = {0}};
    with a{.box = {p, Ts}};
    axis without{.box = {x_axis(), Ts}};
    for (int k = 0; k < 2000; ++k)
        CHECK(a(motion<with>(k), metres(place(k))) == without(motion(k), metres(place(k))));
}
TEST_CASE(
    "milling_axis: a force that repeats every 85 samples: with the memory a fiftieth of the error is left "
    "after 30 cycles") {
    linear_motor<> machine{
        {.mass = 320.4_kg, .force_constant = 1450_N / 1_V, .friction = {{}, 9153_N / 1_mps}, .delay = 0.4_ms},
        Ts};
    learning a{.box = with_memory()};
    quantity<si::length> reading{};
    double first = 0, last = 0;
    for (int k = 0; k < 30 * 85; ++k) {
        const double w = 2 * std::numbers::pi * k / 85;
        reading = machine(a({}, reading), (100 * std::sin(w) + 60 * std::cos(3 * w)) * 1_N);
        auto& most = k < 85 ? first : last;
        if (k < 85 || k >= 29 * 85) most = std::max(most, std::abs(reading.value()));
    }
    CHECK(first > 5e-6);
    CHECK(last < 0.02 * first);
    CHECK_FALSE(a.faulted());

    auto twin = a; // settled in the middle of it: nothing learnt is left, and the load is held without a bump
    a.settle(reading, 0.3_V);
    for (int k = 0; k < 200; ++k) {
        CHECK(a({reading, {}, {}}, reading).value() == doctest::Approx(0.3).epsilon(1e-12));
        CHECK(a.wire.learned == 0_m);
    }
    twin({}, reading); // the copy still knows
    CHECK(std::abs(twin.wire.learned.value()) > 1e-6);
    twin.reset();
    twin({}, 0_m);
    CHECK(twin.wire.learned == 0_m);
    CHECK(twin.wire.command == 0_V);
}
TEST_CASE("milling_axis: reset leaves it as new, copies are independent") {
    axis a{.box = {x_axis(), Ts}}, fresh{.box = {x_axis(), Ts}};
    for (int k = 0; k < 500; ++k) a(motion(k), metres(place(k)));
    axis copy = a, twin = a;
    copy.reset();
    for (int k = 0; k < 100; ++k)
        CHECK(copy(motion(k), metres(place(k))) == fresh(motion(k), metres(place(k))));
    for (int k = 500; k < 600; ++k) CHECK(a(motion(k), metres(place(k))) == twin(motion(k), metres(place(k))));
}
TEST_CASE(
    "milling_axis: a bad sample gives the last command, moves no box, and is told until reset or settle") {
    const double bad = std::numeric_limits<double>::quiet_NaN();
    axis a{.box = {x_axis(), Ts}};
    for (int k = 0; k < 500; ++k) a(motion(k), metres(place(k)));
    const auto last = a.wire.command;
    axis twin = a;
    auto broken = motion(500);
    broken.velocity = bad * 1_mps;
    CHECK(a(motion(500), metres(bad)) == last);
    CHECK(a(broken, metres(0)) == last);
    CHECK(a.faulted());
    for (int k = 500; k < 600; ++k) CHECK(a(motion(k), metres(place(k))) == twin(motion(k), metres(place(k))));
    CHECK(a.faulted());
    a.settle(metres(bad));
    CHECK(a.faulted());
    a.settle(1_mm);
    CHECK_FALSE(a.faulted());
}
TEST_CASE(
    "milling_axis: any friction law from velocity to the command fits its slot, a law in newtons does not") {
    using s = signal::velocity;
    static_assert(milling_boxes<boxes<maxwell_slip<4, s, signal::voltage>>>);
    static_assert(milling_boxes<boxes<lugre<s, signal::voltage>>>);
    static_assert(milling_boxes<boxes<absent<s, signal::voltage>>>);
    static_assert(milling_boxes<boxes<friction, half_observer>>);
    static_assert(
        milling_boxes<milling_axis_boxes<absent<s, signal::force>, absent<signal::position, signal::force>,
                                         absent<signal::position, signal::position>, float, signal::force>> ==
        false); // absent in double
    static_assert(
        milling_boxes<
            milling_axis_boxes<absent<s, signal::force, float>, absent<signal::position, signal::force, float>,
                               absent<signal::position, signal::position, float>, float, signal::force>>);
    static_assert(milling_boxes<decltype(learning::box)>);
    struct wrong : boxes<> {
        lugre<s, signal::force> friction;
    };
    static_assert(!milling_boxes<wrong>);
    struct nothing {};
    static_assert(!milling_boxes<nothing>);
}
TEST_CASE("milling_axis: refuses a plant without gain, and what its boxes refuse") {
    const auto says = [](auto change) {
        auto p = x_axis();
        change(p);
        try {
            boxes<>{p, Ts};
        } catch (const invalid_parameter& e) {
            return std::string(e.what());
        }
        return std::string("taken");
    };
    using P = boxes<>::parameters;
    CHECK(says([](P&) {}) == "taken");
    CHECK(says([](P& p) { p.plant_gain = {}; }) ==
          "milling_axis_boxes.plant_gain = 0 m/(V s^2): must be finite and above 0");
    CHECK(says([](P& p) { p.plant_pole = -1_per_s; }) ==
          "milling_axis_boxes.plant_pole = -1 per s: must be finite and not below 0");
    CHECK(says([](P& p) { p.notch.centre = 1_kHz; }) ==
          "notch.centre = 1000 Hz: must lie between 0 and half the sampling rate (1000 Hz)");
    CHECK(says([](P& p) { p.friction.static_level = 0.01_V; }).substr(0, 31) ==
          "stribeck.static_level = 0.01 V:");
}
