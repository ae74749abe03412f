// SPDX-License-Identifier: BSL-1.0
// The symmetry table by simulation alone: no diagnosis in these cases.
#include "circle_machine.hpp"

#include <doctest/doctest.h>

using namespace circle_machine;

namespace {
bool near(double value, double truth, double relative) {
    return std::abs(value - truth) <= relative * std::abs(truth);
}
machine encoders() {
    machine m;
    m.source = quadrant::diagnosis::circle_source::encoder;
    return m;
}
const auto cos2 = [](double a) { return 2 * std::cos(2 * a); };
const auto sin2 = [](double a) { return 2 * std::sin(2 * a); };
const auto one = [](double) { return 1.0; };
} // namespace

TEST_CASE("circle table: scale is cos 2t and squareness sin 2t, the same both ways and at every feed") {
    machine scale, square;
    scale.geometry = [](double& x, double&, double, double, double) { x *= 1 + 1e-4; };
    square.geometry = [](double& x, double& y, double, double, double) { x -= 1e-4 * y; };
    for (const auto& r : all_runs(scale)) CHECK(near(part(r, cos2), r.radius * 1e-4 / 2, 0.03));
    for (const auto& r : all_runs(square)) CHECK(near(part(r, sin2), -r.radius * 1e-4 / 2, 0.03));
}
TEST_CASE("circle table: servo mismatch is sin 2t, changes its sign with the direction and follows the feed") {
    machine m;
    m.x = lag(50), m.y = lag(60);
    for (const auto& r : all_runs(m))
        CHECK(near(part(r, sin2), r.turning() * r.feed * (1 / 50.0 - 1 / 60.0) / 2, 0.02));
}
TEST_CASE("circle table: the radius changes by v^2/R; lags that differ also make cos 2t of that size, as a "
          "scale does at one feed") {
    machine m;
    m.x = lag(50), m.y = lag(60);
    for (const auto& r : all_runs(m)) {
        const double x = -0.5 / 2500, y = -0.5 / 3600,
                     c = r.feed * r.feed / r.radius; // -tau^2/2, exact to second order
        CHECK(near(part(r, one), c * (x + y) / 2, 0.03));
        CHECK(near(part(r, cos2), c * (x - y) / 2, 0.03));
    }
}
TEST_CASE("circle table: play steps outward by all of it after each reversal and stays; it is mirrored, and "
          "constant with the feed") {
    machine m;
    m.x = with_play(rigid(), 6e-6);
    for (const auto& r : all_runs(m)) {
        const double s = r.turning();
        CHECK(near(at(r, -s * 4) * -1, 3e-6, 0.06)); // before the reversal at x+, whichever way it is passed
        CHECK(near(at(r, s * 6), 3e-6, 0.06));       // after it
        for (const double a : {30.0, 60.0, 120.0})
            CHECK(std::abs(at(r, a) - s * 3e-6 * std::cos(a * pi / 180)) < 1.5e-7);
    }
}
TEST_CASE("circle table: lateral play moves a half turn each way and the other way round clockwise; a bow has "
          "three lobes") {
    machine play, bow;
    play.geometry = [](double&, double& y, double vx, double, double) { y += vx > 0 ? 2e-6 : -2e-6; };
    bow.geometry = [](double& x, double& y, double, double, double) { y += 8e-6 * (1 - x * x / 0.0036); };
    for (const auto& r : all_runs(play)) {
        CHECK(near(at(r, 90), -r.turning() * 2e-6, 0.08));
        CHECK(near(at(r, -90), -r.turning() * 2e-6, 0.08));
        CHECK(std::abs(at(r, 1)) < 2e-7);
    }
    for (const auto& r : all_runs(bow))
        CHECK(near(part(r, [](double a) { return 2 * std::sin(3 * a); }),
                   -8e-6 / 4 * r.radius * r.radius / 0.0036, 0.08));
}
TEST_CASE(
    "circle table: a spike of friction comes after the reversal, outward, both ways, and grows with the feed") {
    machine m = encoders();
    m.x = m.y = mass_with({.coulomb = 0.1}, 100, 200, 8000);
    const auto spike = [&](const circle_run& r,
                           double s) { // the highest of the ten degrees after x+ over the next thirty
        double most = 0;
        for (double a = 1; a < 12; ++a) most = std::max(most, at(r, s * a));
        return most - at(r, s * 40);
    };
    const auto runs = all_runs(m);
    CHECK(spike(runs[0], 1) > 2e-6);
    CHECK(near(spike(runs[0], 1), spike(runs[1], -1), 0.1)); // mirrored
    CHECK(std::abs(at(runs[0], -3) - at(runs[0], -40)) < 3e-7);
    CHECK(spike(runs[2], 1) > 1.15 * spike(runs[0], 1)); // twice the feed
}
TEST_CASE("circle table: an encoder's cyclic error is constant to an instrument, but its own signal shows it "
          "with the feed") {
    // The loop follows what the encoder reads, so the reading hides what is slower than the loop; the table
    // carries it.
    const double period = 4e-3, kv = 60;
    const auto error = [=](double x) { return 2e-6 * std::cos(2 * pi * x / period); };
    const auto amplitude = [&](double feed, bool seen_by_encoder) {
        machine m = encoders();
        m.noise = 0, m.resolution = 0, m.y = lag(kv);
        m.x = [=, loop = lag(kv, error)](double r, double dt) mutable {
            const double reading = loop(r, dt);
            double table = reading;
            for (int k = 0; k < 20; ++k) table = reading - error(table);
            return seen_by_encoder ? reading : table;
        };
        const auto r = drive(m, 0.06, feed, true);
        double cc = 0, c = 0, s = 0;
        for (std::size_t k = 0; k < r.angle.size(); ++k) {
            const double x = r.radius * std::cos(r.angle[k]), along = std::cos(r.angle[k]);
            if (std::abs(along) < 0.1 || std::abs(along) > 0.5)
                continue; // where x is about as fast as the feed
            cc += along * along / 2, c += along * std::cos(2 * pi * x / period) * r.deviation[k];
            s += along * std::sin(2 * pi * x / period) * r.deviation[k];
        }
        return std::hypot(c, s) / cc;
    };
    CHECK(near(amplitude(0.004, false), 2e-6, 0.15));
    CHECK(amplitude(0.004, true) < 0.5e-6);
    CHECK(amplitude(0.2, true) > 1.5e-6);
}
