// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <quadrant/base/literals.hpp>
#include <quadrant/process/milling_force.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
using four = milling_force<4>;
const auto N_per_mm2 = 1e6 * 1_N / (1_m * 1_m);
const auto N_per_mm = 1e3 * 1_N / 1_m;

/// The real cut of [Jamaludin2008] Table 5.6: 16 mm, 4 edges, 0.1 mm a tooth, 4 mm deep, 1 mm wide, 5 mm/s, so
/// 12.5 turns a second; coefficients as for a hard aluminium.
const four::parameters contour{.spindle = 12.5_Hz,
                               .diameter = 16_mm,
                               .feed_per_tooth = 0.1_mm,
                               .axial_depth = 4_mm,
                               .radial_depth = 1_mm,
                               .tangential = 800.0 * N_per_mm2,
                               .radial = 170.0 * N_per_mm2,
                               .edge_tangential = 28.0 * N_per_mm,
                               .edge_radial = 31.0 * N_per_mm};
four::parameters slot() {
    auto p = contour;
    p.radial_depth = p.diameter;
    return p;
}
struct pair {
    double x = 0, y = 0;
};
template <class Force> std::vector<pair> record(Force f, int samples, double direction = 0) {
    std::vector<pair> out;
    for (int k = 0; k < samples; ++k) {
        const auto now = f(direction);
        out.push_back({now.x.value(), now.y.value()});
    }
    return out;
}
pair mean(const std::vector<pair>& forces) {
    pair sum;
    for (const pair& f : forces) sum.x += f.x / double(forces.size()), sum.y += f.y / double(forces.size());
    return sum;
}
/// The mean over a turn in closed form, [Altintas2012] chapter 2, in SI.
pair closed_form(const four::parameters& p, double from, double to) {
    const double n = 4, a = p.axial_depth.value(), c = p.feed_per_tooth.value(), kt = p.tangential.value(),
                 kr = p.radial.value(), kte = p.edge_tangential.value(), kre = p.edge_radial.value();
    const auto x = [&](double phi) {
        return n * a * c / (8 * pi) * (kt * std::cos(2 * phi) - kr * (2 * phi - std::sin(2 * phi))) +
               n * a / (2 * pi) * (-kte * std::sin(phi) + kre * std::cos(phi));
    };
    const auto y = [&](double phi) {
        return n * a * c / (8 * pi) * (kt * (2 * phi - std::sin(2 * phi)) + kr * std::cos(2 * phi)) -
               n * a / (2 * pi) * (kte * std::cos(phi) + kre * std::sin(phi));
    };
    return {x(to) - x(from), y(to) - y(from)};
}
/// A cutter drawn edge by edge: radial places of all paths ever cut, no formula for the chip. Force at one
/// moment, x along the feed; phi0 of edge 0.
pair drawn(const four::parameters& p, double turns, double from, double to) {
    const double c = p.feed_per_tooth.value(), a = p.axial_depth.value(), e = p.runout.value();
    pair sum;
    for (int j = 0; j < 4; ++j) {
        double phi = 2 * pi * (turns + j / 4.0);
        phi -= 2 * pi * std::floor(phi / (2 * pi));
        if (phi < from || phi > to) continue;
        const auto reach = [&](int edge,
                               double teeth_ago) { // along the ray phi, seen from the tool's place now
            return e * std::cos(2 * pi * edge / 4 - p.runout_angle) - teeth_ago * c * std::sin(phi);
        };
        double surface = -1;
        for (int ago = 1; ago <= 40; ++ago) surface = std::max(surface, reach((j + ago) % 4, ago));
        const double h = reach(j, 0) - surface;
        if (h <= 0) continue;
        const double ft = a * (p.tangential.value() * h + p.edge_tangential.value()),
                     fr = a * (p.radial.value() * h + p.edge_radial.value());
        sum.x += -ft * std::cos(phi) - fr * std::sin(phi);
        sum.y += ft * std::sin(phi) - fr * std::cos(phi);
    }
    return sum;
}
double line(const std::vector<pair>& f, double hertz) { // of x
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < f.size(); ++k)
        sum += f[k].x * std::polar(2.0 / double(f.size()), -2 * pi * hertz * double(k) * T.value());
    return std::abs(sum);
}
} // namespace

TEST_CASE("milling_force: each sample is the mean of a cutter drawn edge by edge, with and without runout, up "
          "and down") {
    for (const milling way : {milling::up, milling::down})
        for (const auto& runout : {0_um, 20_um, 150_um}) {
            auto p = contour;
            p.way = way, p.runout = runout, p.runout_angle = 0.7, p.substeps = 16;
            const four f{p, T};
            const auto got = record(f, 320); // two turns
            double off = 0;
            for (int k = 0; k < 320; ++k) {
                pair sum;
                for (int i = 0; i < 16; ++i) {
                    const pair at =
                        drawn(p, 12.5 * T.value() * (k + (i + 0.5) / 16), f.entry_angle(), f.exit_angle());
                    sum.x += at.x / 16, sum.y += at.y / 16;
                }
                off = std::max(
                    {off, std::abs(sum.x - got[std::size_t(k)].x), std::abs(sum.y - got[std::size_t(k)].y)});
            }
            CHECK(off < 1e-9); // of some 200 N
        }
}

TEST_CASE(
    "milling_force: the mean of a slot is N a c Kr/4 + N a Kre/pi against the feed, the same with Kt across") {
    auto p = slot();
    p.substeps = 50;
    const pair m = mean(record(four{p, T}, 160));
    CHECK(m.x == Approx(-(4 * 4e-3 * 1e-4 * 170e6 / 4 + 4 * 4e-3 * 31e3 / pi)).epsilon(1e-3));
    CHECK(m.y == Approx(4 * 4e-3 * 1e-4 * 800e6 / 4 + 4 * 4e-3 * 28e3 / pi).epsilon(1e-3));
}

TEST_CASE("milling_force: the mean of a narrow cut is the closed form between its angles, up and down") {
    const double arc = std::acos(1 - 2.0 / 16);
    for (const milling way : {milling::up, milling::down}) {
        auto p = contour;
        p.way = way, p.substeps = 200;
        const four f{p, T};
        const bool up = way == milling::up;
        const double from = up ? 0 : pi - arc, to = up ? arc : pi;
        CHECK(f.entry_angle() == Approx(from).epsilon(1e-12));
        CHECK(f.exit_angle() == Approx(to).epsilon(1e-12));
        const pair m = mean(record(f, 160)), exact = closed_form(p, from, to);
        CHECK(m.x == Approx(exact.x).epsilon(2e-3)); // the edge of the cut within 1/200 of a sample
        CHECK(m.y == Approx(exact.y).epsilon(2e-3));
    }
}

TEST_CASE("milling_force: runout moves force from edge to edge, the mean of a slot stays while all edges cut") {
    auto p = slot();
    p.edge_tangential = p.edge_radial = 0.0 * N_per_mm; // rubs only where it cuts
    p.substeps = 20;
    const pair even = mean(record(four{p, T}, 160));
    p.runout = 5_um, p.runout_angle = 0.3;
    const pair uneven = mean(record(four{p, T}, 160));
    CHECK(uneven.x ==
          Approx(even.x).epsilon(5e-3)); // at either end of the slot the chip is thinner than the runout
    CHECK(uneven.y == Approx(even.y).epsilon(5e-3));
}

TEST_CASE("milling_force: repeats with the tooth, 50 Hz; with runout with the spindle, 12.5 Hz, only") {
    auto p = contour;
    auto even = record(four{p, T}, 1600);
    CHECK(line(even, 50) > 10);
    for (const double f : {12.5, 25.0, 37.5}) CHECK(line(even, f) < 1e-9);
    p.runout = 20_um;
    const auto uneven = record(four{p, T}, 1600);
    CHECK(line(uneven, 12.5) > 1);
    double by_tooth = 0, by_turn = 0;
    for (std::size_t k = 0; k + 160 < uneven.size(); ++k) {
        by_tooth = std::max(by_tooth, std::abs(uneven[k].x - uneven[k + 40].x));
        by_turn = std::max(by_turn, std::abs(uneven[k].x - uneven[k + 160].x));
    }
    CHECK(by_tooth > 10);
    CHECK(by_turn < 1e-9);
}

TEST_CASE(
    "milling_force: in the thesis' contour cut one edge cuts for 32 % of the time, its chip 48.4 um at most") {
    auto p = contour;
    p.edge_tangential = p.edge_radial = 0.0 * N_per_mm;
    p.substeps = 1;
    const auto f = record(four{p, 10_us}, 8000); // one turn
    double most = 0;
    int busy = 0;
    for (const pair& each : f) {
        const double size = std::hypot(each.x, each.y);
        most = std::max(most, size);
        if (size > 0) ++busy;
    }
    CHECK(busy / 8000.0 == Approx(4 * std::acos(0.875) / (2 * pi)).epsilon(2e-3));
    // One edge: |F| = depth h hypot(Kt, Kr).
    CHECK(most / (4e-3 * std::hypot(800e6, 170e6)) == Approx(48.4e-6).epsilon(2e-3).scale(0));
    CHECK(most == Approx(158.4).epsilon(2e-3));
}

TEST_CASE("milling_force: turning the direction turns the force, and never its size") {
    auto along = record(four{contour, T}, 200), turned = record(four{contour, T}, 200, 2.1);
    for (std::size_t k = 0; k < along.size(); ++k) {
        CHECK(turned[k].x == Approx(along[k].x * std::cos(2.1) - along[k].y * std::sin(2.1)).epsilon(1e-12));
        CHECK(turned[k].y == Approx(along[k].x * std::sin(2.1) + along[k].y * std::cos(2.1)).epsilon(1e-12));
    }
    CHECK(mean(record(four{slot(), T}, 160)).x < 0);     // against the motion of the table,
    CHECK(mean(record(four{slot(), T}, 160, pi)).x > 0); // whichever way it goes
}

TEST_CASE("milling_force: enters the cut within `entry`; a direction that is not finite holds the force and "
          "the spindle") {
    auto p = contour;
    p.entry = 100_ms;
    four f{p, T}, full{contour, T};
    f.settle(0_s, false);
    f.engage(true);
    for (int k = 0; k < 400; ++k) {
        const double ramp = std::min(1.0, k / 200.0);
        const auto at = f(), whole = full();
        CHECK(at.x.value() == Approx(ramp * whole.x.value()).epsilon(1e-9));
    }
    const auto held = f();
    const auto turn = f.now().turn.count();
    CHECK(f(std::nan("")).x == held.x);
    CHECK(f.faulted());
    CHECK(f.now().turn.count() == turn);
    f.reset();
    CHECK_FALSE(f.faulted());
    f.settle(std::numeric_limits<double>::infinity() * 1_s);
    CHECK(f.faulted());
}

TEST_CASE("milling_force: refuses what no cutter could do") {
    const auto refuse = [](auto change, const char* words) {
        auto p = contour;
        change(p);
        CHECK_THROWS_WITH_AS((four{p, T}), words, invalid_parameter);
    };
    refuse([](auto& p) { p.radial_depth = 17_mm; },
           "milling_force.radial_depth = 0.017 m: must not be beyond the diameter (0.016 m)");
    refuse([](auto& p) { p.spindle = 250_Hz; },
           "milling_force.spindle = 250 Hz: must lie between 0 and half the "
           "sampling rate by the number of edges (250 Hz)");
    refuse([](auto& p) { p.axial_depth = 0_mm; },
           "milling_force.axial_depth = 0 m: must be finite and above 0");
    refuse([](auto& p) { p.feed_per_tooth = -1_mm; },
           "milling_force.feed_per_tooth = -0.001 m: must be finite and above 0");
    refuse([](auto& p) { p.radial = -1.0 * N_per_mm2; },
           "milling_force.radial = -1e+06 N/m^2: must be finite and not below 0");
    refuse([](auto& p) { p.runout = -1_um; },
           "milling_force.runout = -1e-06 m: must be finite and not below 0");
    refuse([](auto& p) { p.entry = -1_ms; }, "milling_force.entry = -0.001 s: must be finite and not below 0");
    refuse([](auto& p) { p.substeps = 0; }, "milling_force.substeps = 0: must lie between 1 and 1000");
}
