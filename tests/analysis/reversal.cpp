// SPDX-License-Identifier: BSL-1.0
#include "quadrant_reproduce/thesis.hpp"

#include <quadrant/analysis/judge_compensation.hpp>
#include <quadrant/analysis/reversal.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace thesis;
using namespace quadrant::analysis;

namespace {
/// What is wrong with the compensation: its scale, and by how much it comes late.
struct fault {
    double scale = 1, late = 0;
    double noise = 1e-3; ///< V, on the command
};
struct run_log {
    std::vector<quantity<si::length>> reference, position;
    std::vector<quantity<si::electric_potential>> compensation;
};
/// Friction of the plant: bristles of 120 N/um, or the springs of the thesis. Of the compensation: the static
/// curve, with other levels.
lugre<>::parameters bristles() {
    return {.curve = {130_N, 150_N, 3_mmps, 1000_N / 1_mps}, .stiffness = newtons_per_um(120)};
}
/// Follows the sinusoid of 100 mm/s; compensate(velocity of the reference, `late` ago) [V] is added to the
/// command.
template <class Friction, class Compensate>
run_log simulate(const Friction& friction, const fault& wrong, double cycles, Compensate&& compensate) {
    using motor = linear_motor<typename Friction::block>;
    const axis& a = x;
    milling_axis<milling_axis_boxes<>> loop{.box = {{.position_gain = position_gain,
                                                     .velocity_gain = a.kp,
                                                     .velocity_integral = a.ki,
                                                     .estimator_corner = estimator_corner,
                                                     .notch = notch_of(a),
                                                     .plant_gain = 1.02 * a.B,
                                                     .plant_pole = a.A_gms,
                                                     .limit = 10_V},
                                                    period}};
    motor plant({.mass = a.kf / a.B,
                 .force_constant = a.kf,
                 .friction = friction.parameters,
                 .delay = 0.4_ms,
                 .encoder_step = 0.25_um,
                 .substeps = 10},
                period);
    const double amplitude = 0.03, w = 0.1 / amplitude;
    std::mt19937 random(5);
    std::normal_distribution<double> gauss;
    run_log out;
    quantity<si::length> measured{};
    for (int k = 0; k < int(cycles * 2 * pi_ / w / 5e-4); ++k) {
        const double t = k * 5e-4;
        const auto reference = amplitude * (1 - std::cos(w * t)) * 1_m;
        const auto c = wrong.scale * compensate(amplitude * w * std::sin(w * (t - wrong.late))) * 1_V;
        out.reference.push_back(reference), out.position.push_back(measured), out.compensation.push_back(c);
        const auto u = loop(
            {reference, amplitude * w * std::sin(w * t) * 1_mps, amplitude * w * w * std::cos(w * t) * 1_mps2},
            measured);
        measured = plant(u + c + wrong.noise * gauss(random) * 1_V);
    }
    return out;
}
/// With the static curve: 135 N and what falls to it.
template <class Friction> run_log simulate(const Friction& friction, const fault& wrong, double cycles = 4) {
    return simulate(friction, wrong, cycles, [](double v) {
        const double s = 135 + 12 * std::exp(-std::abs(v) / 2e-3);
        return (v > 0 ? s : v < 0 ? -s : 0) / 1450;
    });
}
struct lugre_friction {
    using block = lugre<>;
    lugre<>::parameters parameters = bristles();
};
struct gms_friction {
    using block = maxwell_slip<4>;
    maxwell_slip<4>::parameters parameters = gms<signal::force>(x, gain_of<signal::force, signal::force>(1.0));
};
/// Position per volt of the nominal loop, B off by so much.
auto nominal(double off = 0.95) {
    const analysis::rigid_axis_model<> plant{x.A_gms, off * x.B, x.delay};
    return [loop = loop_around(plant, x)](frequency f) {
        return loop.compliance(f, gain_of<signal::force, signal::voltage>::from_value(1));
    };
}
auto judge(const run_log& log, double off = 0.95) {
    return judge_compensation<>(log.reference, log.position, log.compensation, nominal(off), period,
                                {.settle = 0.5_s});
}
double glitch_of(const run_log& log) {
    return 1e6 * largest_glitch(quadrant_glitches(log.reference, log.position, period, {0.1_s, 0.5_s})).value();
}
using size = compensation_size;
using when = compensation_time;
} // namespace

TEST_CASE("reversal spikes: height, width and time of a triangle of 12 um, 20 ms after each reversal, 30 ms "
          "wide at half height") {
    std::vector<quantity<si::length>> reference, position;
    for (int k = 0; k < 8000; ++k) {
        const double t = k * 5e-4, since = std::fmod(t, 1.0); // reverses at 1, 2, 3 s
        const double way = int(t) % 2 == 0 ? 1 : -1;
        const double e =
            t < 1 ? 2e-6
                  : 2e-6 + way * std::max(0.0, since < 0.02 ? since / 0.02 : 1 - (since - 0.02) / 0.04) * 12e-6;
        const double r = way > 0 ? since : 1 - since;
        reference.push_back(r * 1_m), position.push_back((r - e) * 1_m);
    }
    const auto spikes = reversal_spikes(reference, position, period, {0.2_s, {}});
    REQUIRE(spikes.size() == 3);
    for (const auto& each : spikes) {
        CHECK(each.height.value() == doctest::Approx(each.found.direction * 12e-6).epsilon(1e-6).scale(0));
        CHECK(each.offset.value() == doctest::Approx(0.02));
        CHECK(each.width.value() == doctest::Approx(0.03).epsilon(1e-3).scale(0));
    }
    CHECK(reversal_spikes(reference, reference, period, {0.2_s, {}})[0].width == 0_s);
}
TEST_CASE("friction compensation: too weak, right, too strong, wrong sign, not at all, on bristles and on "
          "Maxwell-slip springs") {
    const auto check = [](const auto& friction) {
        CHECK(judge(simulate(friction, {.scale = 1})).size == size::right);
        CHECK(judge(simulate(friction, {.scale = 0.5})).size == size::too_weak);
        CHECK(judge(simulate(friction, {.scale = 1.5})).size == size::too_strong);
        CHECK(judge(simulate(friction, {.scale = -1})).size == size::wrong_sign);
        const auto none = judge(simulate(friction, {.scale = 0}));
        CHECK(none.size == size::not_at_all);
        CHECK(none.time == when::cannot_tell);
        CHECK(none.why.empty());
        // 135 to 147 N from the static curve, 130 to 150 and 122 to 177 in the plants
        CHECK(1450 * none.needed.value.value() == doctest::Approx(135).epsilon(0.1));
    };
    check(lugre_friction{});
    check(gms_friction{});
}
TEST_CASE("friction compensation: the scale is that of the simulation within 8 %") {
    for (const double scale : {0.5, 1.0, 1.5}) {
        const auto found = judge(simulate(lugre_friction{}, {.scale = scale}));
        CHECK(found.scale.value == doctest::Approx(scale).epsilon(0.08).scale(0));
        CHECK(found.explained > 0.98);
        CHECK(found.reversals == 7);
    }
}
TEST_CASE("friction compensation: too early and too late; where it is judged right the glitch is smaller than "
          "beside it") {
    // Friction that needs some displacement to turn comes after the sign of the reference: bristles by about
    // 2 ms, the springs by 4.
    const auto check = [](const auto& friction, double best) {
        const auto early = simulate(friction, {.late = best - 0.006}),
                   right = simulate(friction, {.late = best}),
                   late = simulate(friction, {.late = best + 0.006});
        CHECK(judge(early).time == when::too_early);
        CHECK(judge(right).time == when::right);
        CHECK(judge(late).time == when::too_late);
        CHECK(judge(right).text() == "right, at the right time");
        CHECK(glitch_of(right) < glitch_of(early));
        CHECK(glitch_of(right) < glitch_of(late));
    };
    check(lugre_friction{}, 0.002);
    check(gms_friction{}, 0.004);
}
TEST_CASE("friction compensation: Maxwell-slip springs fed forward, not those of the plant, are right and in "
          "time without a shift") {
    auto p = gms<signal::voltage>(x, 1.0 / x.kf);
    for (std::size_t i = 0; i < 4; ++i) p.stiffness[i] *= i % 2 == 0 ? 1.2 : 0.8;
    p.curve.static_level *= 0.97;
    p.curve.coulomb *= 1.03;
    maxwell_slip<4, signal::velocity, signal::voltage> springs(p, period);
    const auto found =
        judge(simulate(gms_friction{}, {}, 4, [&](double v) { return springs(v * 1_mps).value(); }));
    CHECK(found.text() == "right, at the right time");
    CHECK(found.late.low > 0_ms); // by the delay, which is no preview: within the tolerance, but seen
}
TEST_CASE("friction compensation: with a nominal plant 30 % off what is right is still right, what is wrong "
          "still wrong") {
    for (const double off : {0.7, 1.3}) {
        CAPTURE(off);
        const auto right = judge(simulate(lugre_friction{}, {.late = 0.002}), off);
        CHECK(right.size == size::right);
        CHECK(right.time == when::right);
        CHECK(judge(simulate(lugre_friction{}, {.scale = 0.5}), off).size == size::too_weak);
        CHECK(judge(simulate(lugre_friction{}, {.scale = 1.5}), off).size == size::too_strong);
    }
}
TEST_CASE("friction compensation: gives no answer from too few reversals, from noise alone, from an error of "
          "another kind") {
    auto log = simulate(lugre_friction{}, {}, 2);
    const auto few = judge(log);
    CHECK(few.size == size::cannot_tell);
    CHECK(few.why.find("fewer than 4") != std::string::npos);

    log = simulate(lugre_friction{}, {});
    std::mt19937 random(3);
    std::normal_distribution<double> gauss;
    auto quiet = log;
    for (std::size_t i = 0; i < quiet.position.size(); ++i) {
        quiet.position[i] = quiet.reference[i] + 0.2e-6 * gauss(random) * 1_m;
        quiet.compensation[i] = 0_V;
    }
    CHECK(judge(quiet).size == size::cannot_tell);
    CHECK_FALSE(judge(quiet).why.empty());

    auto shaken = log; // 20 um at 40 Hz on top
    for (std::size_t i = 0; i < shaken.position.size(); ++i)
        shaken.position[i] += 20e-6 * std::sin(2 * pi_ * 40 * double(i) * 5e-4) * 1_m;
    CHECK(judge(shaken).size == size::cannot_tell);
    CHECK(judge(shaken).text().find("do not explain") != std::string::npos);
}
TEST_CASE("friction compensation: refuses wires of unequal length, not finite, a window too short") {
    auto log = simulate(lugre_friction{}, {}, 1);
    const auto judged = [&](const compensation_options& o) {
        return judge_compensation<>(log.reference, log.position, log.compensation, nominal(), period, o);
    };
    CHECK_THROWS_AS(judged({.window = 5_ms}), invalid_parameter);
    CHECK_THROWS_AS(judged({.scale_tolerance = 0}), invalid_parameter);
    log.compensation[10] = double(NAN) * 1_V;
    CHECK_THROWS_AS(judge(log), invalid_parameter);
    log.compensation.pop_back();
    CHECK_THROWS_AS(judge(log), invalid_parameter);
}
