// SPDX-License-Identifier: BSL-1.0
// Long: the scenes of docs/integrator.md, one after the other.
// Day one, with whole loops: enable on the move, disable, emergency stop, other parameters, homing, a gantry.
#include <quadrant/base/literals.hpp>
#include <quadrant/block/parameter_swap.hpp>
#include <quadrant/control/axis_enable.hpp>
#include <quadrant/control/following_error.hpp>
#include <quadrant/control/gain_schedule.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/loop/gantry_pair.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration T = 500_us;
using position = quantity<si::length>;
using voltage = quantity<si::electric_potential>;
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
boxes::parameters tuning() {
    return {.position_gain = 150.0 / 1_s,
            .velocity_gain = 60_V / 1_mps,
            .velocity_integral = 450_V / 1_m,
            .estimator = {.corner = 150_Hz},
            .velocity_feedforward = 1,
            .acceleration_feedforward = 340_kg / (1450_N / 1_V),
            .viscous_feedforward = 0.6_V / 1_mps,
            .coulomb_feedforward = 0.08_V,
            .notch = {.centre = 330_Hz, .width = 0.06},
            .limit = 10_V};
}
linear_motor<> motor() {
    return {{.mass = 340_kg,
             .force_constant = 1450_N / 1_V,
             .friction = {.coulomb = 0_N, .viscous = 950_N / 1_mps},
             .delay = 0.4_ms,
             .encoder_step = 250_nm},
            T};
}
position sway(int k) { return 20_mm * (1 - std::cos(0.002 * k)); } // 20 mm/s at most
} // namespace

TEST_CASE("enable on the move: the first command is the one that was applied, but for what a sample changes") {
    cascade<boxes> axis{.box = {tuning(), T}}, cold = axis;
    auto machine = motor();
    position y{};
    double steady = 0, last = 0;
    // Another controller has the axis: a plain P law with a lag.
    for (int k = 0; k < 1000; ++k) {
        const voltage other = 3000_V / 1_m * (sway(k) - y);
        axis.track(sway(k), y, other);
        steady = std::max(steady, std::abs(other.value() - last));
        CHECK(axis.wire.command.value() == doctest::Approx(other.value()).epsilon(1e-12)); // shown as applied
        last = other.value();
        y = machine(other);
    }
    CHECK(std::abs(last) > 0.2);
    const double jump = std::abs(axis(sway(1000), y).value() - last),
                 naive = std::abs(cold(sway(1000), y).value() - last);
    CHECK(jump <= 60 * 150 * 2e-6 + 60 * 2e-3); // one sample's change of the errors through the gains
    CHECK(jump < 0.1);
    CHECK(naive > 1); // as new it would take 20 mm for a jump
    for (int k = 1001; k < 3000; ++k) y = machine(axis(sway(k), y));
    CHECK(std::abs((sway(2999) - y).value()) < 10e-6); // and it goes on as ever
    CHECK_FALSE(axis.faulted());
}

TEST_CASE(
    "disabled for long, moved by hand, enabled at rest: the first command is zero, and nothing has wound up") {
    cascade<boxes> axis{.box = {tuning(), T}};
    for (int k = 0; k < 5000; ++k) { // the stream stays 5 mm away
        const position y = 7_mm * std::sin(0.001 * k);
        axis.track(y + 5_mm, y, 0_V);
        CHECK(std::abs(axis.box.velocity_loop.now().integral.value()) <=
              10); // and not 5 mm * 450 V/m * 2.5 s * ...
    }
    for (int k = 0; k < 200; ++k) axis.track(3_mm, 3_mm, 0_V);
    CHECK(std::abs(axis(3_mm, 3_mm).value()) <= 1e-9);
    CHECK(std::abs(axis.box.velocity_loop.now().integral.value()) <= 1e-9);
}

TEST_CASE(
    "milling_axis: off, the observer sees what is applied and the memory forgets; on, both start from there") {
    using observer = disturbance_observer<signal::voltage>;
    using memory = repetitive<signal::position, 100, 1, 3, 3>;
    using learning = milling_axis_boxes<absent<signal::velocity, signal::voltage>, observer, memory>;
    const auto B = 1450.0 / 340 * (1_mps2 / 1_V);
    learning::parameters p{.position_gain = 150.0 / 1_s,
                           .velocity_gain = 60_V / 1_mps,
                           .velocity_integral = 450_V / 1_m,
                           .estimator_corner = 150_Hz,
                           .notch = {.centre = 330_Hz, .width = 0.06},
                           .plant_gain = B,
                           .limit = 10_V};
    p.disturbance = {20_Hz, axis_model<signal::voltage>{B, 0.0 / 1_s}};
    p.memory = {.cycle = 40_ms, .learning = {0.1, 0.1, 0.1}, .ahead = 1, .smoothing = {0.25, 0.5, 0.25}};
    milling_axis<learning> axis{.box = {p, T}};
    using motion = milling_axis<learning>::motion;
    // A spring of 500 V/m pulls; another controller holds the axis at 1 mm with 0.5 V and lets it sway a
    // little.
    double d = 0;
    for (int k = 0; k < 3000; ++k)
        axis({1_mm * std::sin(0.1 * k)}, 0_m); // has learnt, wound up and estimated nonsense
    CHECK(std::abs(axis.wire.learned.value()) > 0);
    for (int k = 0; k < 3000; ++k) {
        axis.track(motion{1_mm}, 1_mm, 0.5_V);
        d = axis.wire.disturbance.value();
    }
    CHECK(d == doctest::Approx(-0.5).epsilon(1e-6)); // it pushes with -0.5 V, which are compensated
    CHECK(axis.wire.learned == 0_m);
    CHECK(axis.box.memory.now().p[0] == 0_m);
    CHECK(axis({1_mm}, 1_mm).value() == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(std::abs(axis.wire.linear.value()) <= 1e-5); // the observer carries it, the integral nothing
    const auto bad = std::nan("") * 1_m;
    axis.track(motion{bad}, 1_mm, 0_V);
    CHECK(axis.faulted());
}

TEST_CASE(
    "emergency stop of a moving axis: ramp, brake, off; the following error trips an axis that is blocked") {
    cascade<boxes> axis{.box = {tuning(), T}};
    axis_enable<> power{
        {.velocity = 0.2_mps, .deceleration = 0.2_mps2, .emergency_deceleration = 1_mps2, .brake_time = 20_ms},
        T};
    following_error<> guard{{.window = 50_um, .per_speed = 5_ms, .patience = 2_ms}, T};
    auto machine = motor();
    position y{};
    int off_at = 0, tripped_at = 0;
    double most = 0;
    const auto sample = [&](const power_request& asked, position stream, bool blocked) {
        auto r = asked;
        r.trip = guard.tripped();
        const position before = power.now().reference, reference = power(r, stream);
        if (power.on()) {
            guard(reference - y, (reference - before) / T);
            const voltage u = axis(reference, y);
            if (!blocked) y = machine(u);
            most = std::max(most, std::abs(u.value()));
        } else {
            guard.reset();
            axis.track(reference, y, 0_V);
        }
    };
    const auto ramp = [](int k) { return 50e-6 * k * 1_m; }; // 0.1 m/s
    for (int k = 0; k < 100; ++k) sample({}, 0_m, false);
    const double start = 400; // the stream waits, then moves off with 1 m/s^2
    const auto stream = [&](int k) { return k < 200 ? 0.5 * k * k * 2.5e-7 * 1_m : ramp(k) - ramp(100); };
    for (int k = 0; k < int(start); ++k) sample({.enable = true}, stream(k), false);
    const position at = power.now().reference;
    for (int k = int(start); power.on(); ++k, ++off_at)
        sample({.enable = true, .emergency_stop = true}, stream(k), false);
    CHECK(std::abs(off_at - (200 + 40 + 1)) <= 1); // 0.1 s of ramp, 20 ms of brake; rounding may add a sample
    CHECK(std::abs((y - at).value() - 0.1 * 0.1 / 2) < 20e-6);
    CHECK(most < 2);
    sample({}, y, false);
    sample({.enable = true}, y, false);
    CHECK(power.on());
    const position held = y;
    for (int k = 0; k < 400 && power.power() != power_state::tripped; ++k, ++tripped_at)
        sample({.enable = true}, held + ramp(k), true);
    CHECK(power.power() == power_state::tripped);
    CHECK(tripped_at < 30);
}

TEST_CASE("another tuning in motion, handed over whole: the command jumps by millivolts, where new boxes would "
          "jump by volts") {
    std::mt19937 random(11);
    const auto about = [&](auto q) { return std::exp(std::uniform_real_distribution(-0.5, 0.5)(random)) * q; };
    double most = 0, most_naive = 0, most_still = 0;
    for (int trial = 0; trial < 40; ++trial) {
        cascade<boxes> axis{.box = {tuning(), T}};
        parameter_swap<boxes> swap(axis.box);
        auto machine = motor();
        position y{};
        const int when = 500 + int(random() % 1000);
        for (int k = 0; k < when; ++k) y = machine(axis(sway(k), y));
        auto p = tuning();
        p.position_gain = about(p.position_gain), p.velocity_gain = about(p.velocity_gain);
        p.velocity_integral = about(p.velocity_integral), p.estimator.corner = about(p.estimator.corner);
        p.acceleration_feedforward = about(p.acceleration_feedforward);
        p.viscous_feedforward = about(p.viscous_feedforward),
        p.coulomb_feedforward = about(p.coulomb_feedforward);
        p.notch.centre = about(p.notch.centre), p.notch.width = about(p.notch.width);
        swap.offer(boxes{p, T});
        cascade<boxes> twin = axis, naive = axis;
        naive.box = {p, T};
        if (const boxes* next = swap.take()) axis.retune(*next);
        CHECK(axis.box.resonance.given().centre == p.notch.centre);
        const double was = twin(sway(when), y).value();
        most = std::max(most, std::abs(axis(sway(when), y).value() - was));
        most_naive = std::max(most_naive, std::abs(naive(sway(when), y).value() - was));
        // In even motion, all wires constant: nothing but the step that the integral makes anyway.
        cascade<boxes> even{.box = {tuning(), T}};
        const auto row = [](int k) { return 10e-6 * k * 1_m; };
        for (int k = 0; k < 4000; ++k) even.track(row(k), row(k - 3), 0.7_V);
        even.retune(boxes{p, T});
        const double step = std::abs((p.velocity_integral * T * even.wire.velocity_error).value());
        most_still = std::max(most_still, std::abs(even(row(4000), row(3997)).value() - 0.7) - step);
    }
    CHECK(most < 0.05); // V, with gains and corners changed by up to 1.65 times
    CHECK(most_naive > 1);
    CHECK(most_still < 1e-9);
}

TEST_CASE("milling_axis: another tuning in motion, observer and friction too") {
    using springs = maxwell_slip<2, signal::velocity, signal::voltage>;
    using observed = milling_axis_boxes<springs, disturbance_observer<signal::voltage>>;
    std::mt19937 random(12);
    const auto about = [&](auto q) { return std::exp(std::uniform_real_distribution(-0.3, 0.3)(random)) * q; };
    const auto draw = [&] {
        observed::parameters p{.position_gain = about(150.0 / 1_s),
                               .velocity_gain = about(60_V / 1_mps),
                               .velocity_integral = about(450_V / 1_m),
                               .estimator_corner = about(150_Hz),
                               .notch = {.centre = about(330_Hz), .width = 0.06},
                               .plant_gain = about(4.26_mps2 / 1_V),
                               .plant_pole = 2.8 / 1_s,
                               .friction = {.curve = {about(0.08_V), 0.13_V, 2_mmps, about(0.2_V / 1_mps)},
                                            .weights = {0.4, 0.6},
                                            .stiffness = {about(50_V / 1_mm), about(10_V / 1_mm)},
                                            .attraction = 1_V / 1_s},
                               .limit = 10_V};
        p.disturbance = {about(20_Hz), axis_model<signal::voltage>{p.plant_gain, p.plant_pole}};
        return p;
    };
    const auto asked = [](int k) {
        const double t = 0.002 * k, w = 4; // rad/s
        return milling_axis<observed>::motion{20_mm * (1 - std::cos(t)), 0.02 * w * std::sin(t) * 1_mps,
                                              0.02 * w * w * std::cos(t) * 1_mps2};
    };
    double most = 0, most_naive = 0;
    for (int trial = 0; trial < 20; ++trial) {
        milling_axis<observed> axis{.box = {draw(), T}};
        auto machine = motor();
        position y{};
        const int when = 500 + int(random() % 1000);
        for (int k = 0; k < when; ++k) y = machine(axis(asked(k), y));
        auto twin = axis, naive = axis;
        const observed next{draw(), T};
        naive.box = next;
        axis.retune(next, asked(when - 1));
        const double was = twin(asked(when), y).value();
        most = std::max(most, std::abs(axis(asked(when), y).value() - was));
        most_naive = std::max(most_naive, std::abs(naive(asked(when), y).value() - was));
        for (int k = when + 1; k < 3000; ++k) y = machine(axis(asked(k), y));
        CHECK(std::abs((asked(2999).position - y).value()) < 30e-6); // and it runs on
    }
    CAPTURE(most);
    CHECK(most < 0.05); // V
    CHECK(most_naive > 1);

    milling_axis<observed> begun{.box = {draw(), T}};
    for (int k = 0; k < 6; ++k) begun(asked(k), asked(k).position); // 1 um
    const auto bent = begun.box.friction.now().elements;
    begun.retune(observed{begun.box}, asked(5));
    for (std::size_t i = 0; i < 2; ++i) // no way counts twice
        CHECK(begun.box.friction.now().elements[i].force == bent[i].force);
    CHECK_FALSE(bent[1].slips);
}

TEST_CASE("homing: the frame of positions moves under a running axis, and no command changes") {
    const auto check = [](auto axis, auto reference) {
        auto homed = axis;
        auto machine = motor();
        position y{};
        double off = 0;
        for (int k = 0; k < 1500; ++k) {
            const position by = k < 700 ? 0_m : -123.456_mm;
            if (k == 700) homed.shift(by);
            const voltage u = axis(reference(sway(k)), y);
            off = std::max(off, std::abs((homed(reference(sway(k) + by), y + by) - u).value()));
            y = machine(u);
        }
        CHECK(off < 1e-8); // V; 1e-17 m over T, twice, through 60 V s/m
        CHECK_FALSE(homed.faulted());
    };
    check(cascade<boxes>{.box = {tuning(), T}}, [](position r) { return r; });
    using observed =
        milling_axis_boxes<absent<signal::velocity, signal::voltage>, disturbance_observer<signal::voltage>>;
    observed::parameters p{.position_gain = 150.0 / 1_s,
                           .velocity_gain = 60_V / 1_mps,
                           .velocity_integral = 450_V / 1_m,
                           .estimator_corner = 150_Hz,
                           .notch = {.centre = 330_Hz, .width = 0.06},
                           .plant_gain = 4.26_mps2 / 1_V,
                           .limit = 10_V};
    p.disturbance = {20_Hz, axis_model<signal::voltage>{4.26_mps2 / 1_V, 2.8 / 1_s}};
    check(milling_axis<observed>{.box = {p, T}}, [](position r) { return milling_axis<observed>::motion{r}; });
}

TEST_CASE("gantry_pair: a push along does not turn a rigid beam, a turn does not move it, and at the limit the "
          "turn comes first") {
    const double mass = 120, inertia = 40, width = 2, share = 0.35; // end 1 carries 35 per cent
    gantry_pair<> beam{{.share = share, .limit = 500_N, .offset = 0.2_mm}, T};
    double x = 0, angle = 0, vx = 0, va = 0;
    const auto ends = [&] { // of the centre of gravity and the angle
        return beam((x + (1 - share) * width * angle + 0.65 * 2e-4) * 1_m,
                    (x - share * width * angle - 0.35 * 2e-4) * 1_m);
    };
    const auto push = [&](auto u, auto w, int samples) {
        for (int k = 0; k < samples; ++k) {
            const auto drive = beam.split(u, w);
            vx += (drive.first + drive.second).value() / mass * 5e-4;
            va += width * ((1 - share) * drive.first - share * drive.second).value() / inertia * 5e-4;
            x += vx * 5e-4, angle += va * 5e-4;
        }
        return ends();
    };
    CHECK(std::abs(ends().skew.value()) <= 1e-15);
    auto seen = push(100_N, 0_N, 200);
    CHECK(std::abs(seen.skew.value()) <= 1e-15);
    CHECK(seen.mean.value() == doctest::Approx(x).epsilon(1e-12));
    CHECK(x > 1e-3);
    vx = 0;
    const double before = seen.mean.value();
    seen = push(0_N, 10_N, 200);
    CHECK(std::abs(seen.mean.value() - before) <= 1e-15);
    CHECK(seen.skew.value() == doctest::Approx(width * angle));
    CHECK(angle > 1e-4);

    std::mt19937 random(4);
    for (int trial = 0; trial < 1000; ++trial) {
        const double u = std::uniform_real_distribution(-3000.0, 3000.0)(random),
                     w = std::uniform_real_distribution(-700.0, 700.0)(random);
        const auto drive = beam.split(u * 1_N, w * 1_N);
        CHECK(std::abs(drive.first.value()) <= 500 * (1 + 1e-12));
        CHECK(std::abs(drive.second.value()) <= 500 * (1 + 1e-12));
        CHECK(drive.skew.value() == std::fmax(-500, std::fmin(500, w)));
        CHECK(drive.mean.value() * u >= 0);
        CHECK(std::abs(drive.mean.value()) <= std::abs(u));
    }
    CHECK(beam.split(1e4 * 1_N, 0_N).mean.value() ==
          doctest::Approx(500 / 0.65)); // and no more is lost than has to be
    CHECK(beam.limited());
    beam(std::nan("") * 1_m, 0_m);
    CHECK(beam.faulted());
    CHECK_THROWS_AS((gantry_pair<>{{.share = 1, .limit = 1_N}, T}), invalid_parameter);
    CHECK_THROWS_AS((gantry_pair<>{{.limit = 0_N}, T}), invalid_parameter);
}

TEST_CASE("gain_schedule: straight between the nodes, held beyond, no jump at a node; in front of a PI the "
          "integral stays") {
    using schedule = gain_schedule<signal::position, signal::velocity, signal::velocity, 3>;
    schedule g{{{0_mm, 100_mm, 400_mm}, {1.0, 3.0, 1.5}}, T};
    CHECK(g(2_mps, 50_mm).value() == doctest::Approx(4));
    CHECK(g(2_mps, 250_mm).value() == doctest::Approx(4.5));
    CHECK(g(2_mps, -1_m).value() == 2);
    CHECK(g(2_mps, 1_m).value() == 3);
    double most = 0;
    for (int k = -100; k < 5000; ++k)
        most = std::max(most, std::abs((g.gain((k + 1.0) * 0.1_mm) - g.gain(double(k) * 0.1_mm)).value()));
    CHECK(most == doctest::Approx(20 * 1e-4)); // the steepest slope, 2 in 100 mm
    proportional_integral<signal::velocity, signal::voltage> loop{{60_V / 1_mps, 450_V / 1_m, 10_V}, T};
    for (int k = 0; k < 100; ++k) loop(g(10_mmps, 0_mm));
    const auto integral = loop.now().integral;
    CHECK(loop(g(0_mps, 100_mm)) == integral); // three times the gains
    CHECK_THROWS_WITH_AS((schedule{{{0_mm, 0_mm, 1_mm}, {1.0, 1.0, 1.0}}, T}),
                         "gain_schedule.at = 0 m: must lie above the one before it (0 m)", invalid_parameter);
}
