// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/quadrant_glitch.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/friction_feedforward.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using block = friction_feedforward<stribeck<>, signal::voltage>;
/// x axis of [Jamaludin2008], turned over within 0.5 mm/s.
block::parameters x_axis(at_rest rest = at_rest::off) {
    return {.law = {122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps},
            .force_constant = 1450_N / 1_V,
            .width = 0.5_mmps,
            .scale = 1,
            .rest = rest};
}
quantity<si::velocity> mps(double v) { return quantity<si::velocity>::from_value(v); }
std::string refusal(const block::parameters& p) {
    try {
        block{p, Ts};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "";
}

/// Largest glitch [um] of the thesis' x axis on a plant with LuGre friction (a memory, levels 10 % off), 30 mm
/// at `peak`.
template <class Friction> double glitch(const typename Friction::parameters& p, quantity<si::velocity> peak) {
    using boxes = milling_axis_boxes<Friction>;
    using axis = milling_axis<boxes>;
    axis control{.box = {{.position_gain = 150.0 / 1_s,
                          .velocity_gain = 60_V / 1_mps,
                          .velocity_integral = 450_V / 1_m,
                          .estimator_corner = 942.5 / (2 * pi) * 1_Hz,
                          .notch = {330_Hz, 0.0606},
                          .plant_gain = 4.526_mps2 / 1_V,
                          .plant_pole = 2.5_per_s,
                          .friction = p,
                          .disturbance = {},
                          .memory = {},
                          .limit = 10_V,
                          .dac_step = {}},
                         Ts}};
    linear_motor<lugre<>> motor{{.mass = 320.4_kg,
                                 .force_constant = 1450_N / 1_V,
                                 .friction = {.curve = {110_N, 160_N, 2.5_mmps, 801_N / 1_mps},
                                              .stiffness = 3e7 * 1_N / 1_m,
                                              .damping = 1000_N / 1_mps,
                                              .damping_velocity = 2_mmps},
                                 .delay = 0.4_ms},
                                Ts};
    preview<2, typename axis::motion> look{{0.65_ms}, Ts};
    const double w = peak.value() / 0.03;
    std::vector<quantity<si::length>> reference, position;
    auto y = 0_m;
    for (int k = 0; k < int(2.2 * 2 * pi / w / 5e-4); ++k) {
        const double t = k * 5e-4;
        const auto r = look({0.03 * (1 - std::cos(w * t)) * 1_m, 0.03 * w * std::sin(w * t) * 1_mps,
                             0.03 * w * w * std::cos(w * t) * 1_mps2});
        reference.push_back(r.reference.position), position.push_back(y);
        y = motor(control(r.reference, r.ahead, y));
    }
    return 1e6 * analysis::largest_glitch(
                     analysis::quadrant_glitches(reference, position, Ts, {.window = 0.2_s, .settle = 1_s}))
                     .value();
}
} // namespace

TEST_CASE(
    "friction_feedforward: outside the width it is the law over the force constant: 132.111 N are 91.111 mV at "
    "10 mm/s") {
    for (const at_rest rest : {at_rest::off, at_rest::held}) {
        block f{x_axis(rest), Ts};
        stribeck<> law{x_axis().law, Ts};
        CHECK(f(10_mmps).value() == doctest::Approx(132.111 / 1450).epsilon(1e-6));
        for (double v = 0.5e-3; v < 0.3; v *= 1.1)
            for (const double s : {1.0, -1.0})
                CHECK(f(mps(s * v)).value() == doctest::Approx(law(mps(s * v)).value() / 1450).epsilon(1e-12));
    }
}
TEST_CASE(
    "friction_feedforward: the bare law jumps by 354 N within 1 nm/s of rest, this by less than 1 mN of it") {
    stribeck<> law{x_axis().law, Ts};
    CHECK((law(1_mmps * 1e-6) - law(-1_mmps * 1e-6)).value() == doctest::Approx(354).epsilon(1e-5));
    for (const at_rest rest : {at_rest::off, at_rest::held}) {
        block f{x_axis(rest), Ts};
        f(5_mmps);
        auto last = f(1_mmps * 1e-6);
        CHECK(std::abs((f(-1_mmps * 1e-6) - last).value()) < 2 * 354.0 / 1450 * 1e-6 / 0.5);
        double step = 0; // along a whole reversal and back, in steps of a thousandth of the width
        last = f(1_mmps);
        for (int k = 0; k < 8000; ++k) {
            const auto now = f(mps((k < 4000 ? 2000 - k : k - 6000) * 0.5e-6));
            if (k > 0) step = std::max(step, std::abs((now - last).value()));
            last = now;
        }
        CHECK(step < (2 * 177e-3 + (55 * 450 + 950) * 0.5e-6) / 1450 *
                         1.0001); // 2 Fs over the width, and the curve's own slope
    }
}
TEST_CASE("friction_feedforward: off fades to nothing at rest, held keeps the sign of the last motion") {
    block off{x_axis(), Ts}, held{x_axis(at_rest::held), Ts};
    for (const double sign : {1.0, -1.0}) {
        for (int k = 10; k >= 0; --k) off(mps(sign * 1e-4 * k)), held(mps(sign * 1e-4 * k));
        CHECK(off(0_mps) == 0_V);
        CHECK(held(0_mps).value() == doctest::Approx(sign * 177 / 1450)); // the level at rest
    }
    held.reset();
    CHECK(held(0_mps) == 0_V); // no motion yet: no sign
}
TEST_CASE(
    "friction_feedforward: off is linear in velocity within the width: half the level at half the width") {
    auto p = x_axis();
    p.law = {122_N, 122_N, 1_mmps, {}};
    block f{p, Ts};
    CHECK(f(0.25_mmps).value() == doctest::Approx(61.0 / 1450).scale(0));
    CHECK(f(-0.125_mmps).value() == doctest::Approx(-30.5 / 1450).scale(0));
}
TEST_CASE("friction_feedforward: held turns over between rest and the width of the new direction") {
    auto p = x_axis(at_rest::held);
    p.law = {122_N, 122_N, 1_mmps, {}};
    block f{p, Ts};
    f(5_mmps);
    CHECK(f(0.1_mmps).value() == doctest::Approx(122.0 / 1450).scale(0)); // slowing down: nothing yet
    CHECK(f(-0.25_mmps).value() == doctest::Approx(0).scale(1));
    CHECK(f(-0.375_mmps).value() == doctest::Approx(-61.0 / 1450).scale(0));
    CHECK(f(-0.3_mmps).value() ==
          doctest::Approx(-61.0 / 1450).scale(0)); // and not back while it goes the same way
    CHECK(f(-0.5_mmps).value() == doctest::Approx(-122.0 / 1450).scale(0));
}
TEST_CASE("friction_feedforward: held does not follow a reference that dithers by less than half the width") {
    block f{x_axis(at_rest::held), Ts};
    f(5_mmps);
    f(-0.24_mmps);
    const auto s = f.now().side;
    for (int k = 0; k < 100; ++k) {
        f(mps((k % 2 ? 1 : -1) * 0.24e-3));
        CHECK(f.now().side == s);
    }
    block off{x_axis(), Ts}; // which off does
    CHECK(off(0.24_mmps) == -off(-0.24_mmps));
}
TEST_CASE("friction_feedforward: scale takes a share, and a law in volts needs no force constant but 1") {
    auto p = x_axis();
    p.scale = 0.8;
    block f{p, Ts}, whole{x_axis(), Ts};
    CHECK(f(7_mmps).value() == doctest::Approx(0.8 * whole(7_mmps).value()));
    using in_volts = coulomb_viscous<signal::velocity, signal::voltage>;
    friction_feedforward<in_volts> v{
        {.law = {84_V / 1000.0, {}}, .force_constant = 1.0, .width = 1_mmps, .scale = 1, .rest = at_rest::off},
        Ts};
    CHECK(v(-20_mmps).value() == doctest::Approx(-0.084));
}
TEST_CASE("friction_feedforward: names the field that it refuses; the law refuses in its own name") {
    auto p = x_axis();
    p.force_constant = {};
    CHECK(refusal(p) == "friction_feedforward.force_constant = 0 N/V: must be finite and above 0");
    p = x_axis(), p.width = 0_mps;
    CHECK(refusal(p) == "friction_feedforward.width = 0 m/s: must be finite and above 0");
    p = x_axis(), p.scale = -1;
    CHECK(refusal(p) == "friction_feedforward.scale = -1: must be finite and not below 0");
    p = x_axis(), p.law.static_level = 100_N;
    CHECK(refusal(p).find("stribeck.static_level") == 0);
    CHECK(refusal(x_axis()) == "");
}
TEST_CASE("friction_feedforward: on a plant with LuGre friction and other levels it takes more than half of "
          "the glitch at "
          "100 mm/s, held more than off, and off more than the bare law") {
    auto p = x_axis(), held = x_axis(at_rest::held);
    p.law.viscous = held.law.viscous = {}; // the drag box has it
    p.width = held.width = 1_mmps;
    const double none = glitch<absent<signal::velocity, signal::voltage>>({}, 100_mmps);
    const double bare = glitch<stribeck<signal::velocity, signal::voltage>>(
        {122_V / 1450.0, 177_V / 1450.0, 1_mps / 450.0, {}}, 100_mmps);
    const double off = glitch<block>(p, 100_mmps), hold = glitch<block>(held, 100_mmps);
    CHECK(off < 0.5 * none);  // 16.4, 6.4
    CHECK(hold < 0.5 * none); // 5.7
    CHECK(off < bare);        // 7.3
    CHECK(hold < off);
}
