// SPDX-License-Identifier: BSL-1.0
// Compiled with -O3 -ffast-math, by which a compiler may take it that there is no NaN and no infinity.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/edge_velocity.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/observer/maxwell_slip_observer.hpp>
#include <quadrant/plant/flexible_modes.hpp>

#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

namespace {
/// Numbers that the compiler cannot know.
const double no_number = std::strtod("nan", nullptr), infinity = std::strtod("inf", nullptr);
const duration T = 500_us;
template <class F> bool refuses(F&& make) {
    try {
        make();
        return false;
    } catch (const invalid_parameter&) {
        return true;
    }
}
/// A bad sample gives the last output, raises the fault and changes no state.
template <class Block> bool holds(Block block, double bad) {
    using in = typename Block::argument;
    for (int k = 0; k < 20; ++k) block(in::from_value(k % 3 - 0.7));
    const auto last = block(in::from_value(0.4));
    auto twin = block;
    const auto given = block(in::from_value(bad));
    const double off = (block(in::from_value(0.1)) - twin(in::from_value(0.1))).value();
    return given == last && block.faulted() && off * off < 1e-24;
}
} // namespace

TEST_CASE("-ffast-math: every rule refuses a NaN, and an infinity where it has to be finite") {
    for (const double bad : {no_number, -no_number}) {
        CHECK(refuses([&] { require_finite("a.b", bad); }));
        CHECK(refuses([&] { require_positive("a.b", bad); }));
        CHECK(refuses([&] { require_not_negative("a.b", bad); }));
        CHECK(refuses([&] { require_below_nyquist("a.b", bad * 1_Hz, T); }));
        CHECK(refuses([&] { require(bad > 0, "a.b", bad, "must be above 0"); }));
        CHECK(refuses([&] { notch<s::force>({330_Hz, bad}, T); }));
        CHECK(refuses([&] { butterworth<s::force>({bad * 1_Hz}, T); }));
        CHECK(refuses([&] { limiter<s::force>({bad * 1_N, 1_N}, T); }));
        CHECK(refuses([&] { limiter<s::force>({-1_N, bad * 1_N}, T); }));
        CHECK(refuses([&] { proportional_integral<s::velocity, s::force>({1_N / 1_mps, {}, bad * 1_N}, T); }));
    }
    CHECK(refuses([&] { require_finite("a.b", infinity); }));
    CHECK(refuses([&] { require_positive("a.b", infinity); }));
    CHECK(refuses([&] { butterworth<s::force>({infinity * 1_Hz}, T); }));
    require_positive("a.b", 3.0);
    const auto learning_up_to = [&](double highest) { // times the believed level of the friction
        using observer = maxwell_slip_observer<1>;
        observer::parameters p;
        p.friction = {{122_N, 177_N, 22_mmps, 850_N / 1_mps}, {1.0}, {}, {6.1e6 * 1_N / 1_m}, 4000_N / 1_s};
        p.settles_in = 300_ms;
        p.highest = highest;
        observer(p, T);
    };
    CHECK_FALSE(refuses([&] { learning_up_to(2); }));
    CHECK(refuses([&] { learning_up_to(no_number); }));
    CHECK(refuses([&] { learning_up_to(infinity); }));
}
TEST_CASE("-ffast-math: a NaN and an infinity change no state, and a derivative that is not finite is caught") {
    using D = dual<2>;
    for (const double bad : {no_number, infinity, -infinity}) {
        CHECK(holds(notch<s::force>({330_Hz, 0.1}, T), bad));
        CHECK(holds(butterworth<s::force>({100_Hz}, T), bad));
        CHECK(holds(lowpass<s::force>({100_Hz}, T), bad));
        CHECK(holds(limiter<s::force>({-1_N, 1_N}, T), bad));
        CHECK(holds(edge_velocity<s::position, s::velocity>({1_um, 5_ms, 50_ms}, T), bad));
        CHECK(holds(edge_velocity<s::position, s::velocity, float>({1_um, 5_ms, 50_ms}, T), float(bad)));
        CHECK(holds(flexible_modes<1>({340_kg, {{{47_Hz, 0.1, 0.2}}}}, T), bad));
        CHECK(holds(
            disturbance_observer<s::voltage>({60_Hz, axis_model<s::voltage>{4_mps2 / 1_V, 20.0 / 1_s}}, T),
            bad));
        D x(1);
        x.partial[1] = bad;
        CHECK_FALSE(finite(x));
        CHECK_FALSE(finite(bad));
        CHECK_FALSE(finite(float(bad)));
        CHECK_FALSE(finite(1.0, bad, 2.0));
        notch<s::force, D> n({quantity<hertz_unit, D>::from_value(330), 0.1}, T);
        n(quantity_of<s::force, D>::from_value(x));
        CHECK(n.faulted());
    }
    CHECK(finite(D(3), D(4)));
}
namespace {
/// One sample of an encoder's estimate, always by the same piece of code.
template <class Block, class Real> [[gnu::noinline]] Real speed_at(Block& block, Real x, Real age) {
    return block(Block::argument::from_value(x), Block::time::from_value(age)).value();
}
/// Bit for bit: of two numbers of which one may be a NaN, == may say anything.
template <class Real> bool same(Real a, Real b) { return std::memcmp(&a, &b, sizeof a) == 0; }
/// A slow axis that starts, runs, turns round and stands still: samples with an edge, between edges, at a
/// reversal and after rest. At sample `bad_at` one of both inputs, or each, is bad; true when output, flag,
/// state and all that follows are as if that sample had not come.
template <class Real> bool no_trace(int bad_at, Real bad_x, Real bad_age) {
    using block = edge_velocity<s::position, s::velocity, Real>;
    const Real count = Real(1e-6);
    block one({1_um, 2_ms, 20_ms}, T), twin = one;
    Real last = 0;
    const auto same_state = [&] {
        const auto &a = one.now(), &b = twin.now();
        return same(a.reading.value(), b.reading.value()) && same(a.reference.value(), b.reference.value()) &&
               same(a.v.value(), b.v.value()) && same(a.part, b.part) && same(a.late, b.late) &&
               a.since_reference == b.since_reference && a.since_edge == b.since_edge && a.side == b.side;
    };
    for (int k = 0; k < 200; ++k) {
        const int counts = k < 80 ? k / 3 : k < 120 ? 26 - (k - 80) / 4 : 16; // rests from sample 120 on
        const Real x = Real(counts) * count, age = Real(2e-4);
        if (k == bad_at) {
            const Real given = speed_at(one, finite(bad_x) ? x : bad_x, finite(bad_age) ? age : bad_age);
            if (!finite(given) || !same(given, last) || !one.faulted() || !same_state()) return false;
        }
        const Real y = speed_at(one, x, age), z = speed_at(twin, x, age);
        if (!finite(y) || !same(y, z) || !same_state()) return false;
        last = z;
    }
    return true;
}
template <class Real> void no_trace_anywhere() {
    for (int bad_at = 1; bad_at < 200; ++bad_at)
        for (const double bad : {no_number, -no_number, infinity, -infinity}) {
            CAPTURE(bad_at);
            CHECK(no_trace<Real>(bad_at, Real(bad), 0));
            CHECK(no_trace<Real>(bad_at, 0, Real(bad)));
            CHECK(no_trace<Real>(bad_at, Real(bad), Real(bad)));
        }
}
} // namespace

TEST_CASE(
    "-ffast-math: edge_velocity: a reading or an age that is no number leaves no trace, at whichever sample") {
    no_trace_anywhere<double>();
    no_trace_anywhere<float>();
}
TEST_CASE("-ffast-math: a constant passes a slow float section to the last bit") {
    using F = quantity_of<s::force, float>;
    notch<s::force, float> n({0.5_Hz, 1}, 50_us);
    butterworth<s::force, float> b({0.5_Hz}, 50_us);
    float y = 0, z = 0;
    for (int k = 0; k < 2'000'000; ++k)
        y = n(F::from_value(100.1f)).value(), z = b(F::from_value(100.1f)).value();
    CHECK(y == 100.1f);
    CHECK(z == 100.1f);
}
