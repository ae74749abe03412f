// SPDX-License-Identifier: BSL-1.0
// Long: one block; TEST_CASE() of the random paths checks every limit of the same drive.
#include "count_allocations.hpp"
#include "limits.hpp"

#include <doctest/doctest.h>
#include <quadrant/base/literals.hpp>
#include <quadrant/trajectory/interpolator.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::path;
using namespace quadrant::literals;
using namespace quadrant::trajectory;

namespace {

constexpr double T = 1e-3;
const machine_limits machine{{at_most(0.3, 3, 100), at_most(0.3, 3, 100), at_most(0.3, 3, 100)},
                             at_most(0.3, 2, 50)};

using program = std::vector<move>;
move go(const segment& path, double feed, double tolerance = -1) { // a tolerance: without a stop
    move m{path};
    m.feed = feed;
    if (tolerance >= 0) m.ending = path_ending::continuous, m.tolerance = tolerance;
    return m;
}
struct sample {
    point r, v, a, j;
    std::size_t line;
    bool resting;
};
sample plain(const path_reference& of) {
    sample p{{}, {}, {}, {}, of.line, of.resting};
    for (int i = 0; i < 3; ++i) {
        const motion& m = of.axis[std::size_t(i)];
        p.r[i] = m.position.value(), p.v[i] = m.velocity.value();
        p.a[i] = m.acceleration.value(), p.j[i] = m.jerk.value();
    }
    return p;
}
/// Every sample of a program, lines numbered from 1, the first one at rest at the start.
template <std::size_t Window = 32>
std::vector<sample> driven(program moves, const machine_limits& limits = machine,
                           profile_kind kind = profile_kind::trapezoidal_acceleration) {
    interpolator<Window> drive({limits, kind}, T * 1_s);
    std::vector<sample> all;
    std::size_t next = 0;
    for (;;) {
        for (; !drive.full() && next < moves.size(); ++next) {
            moves[next].line = next + 1;
            drive.push(moves[next]);
        }
        if (all.empty()) all.push_back(plain(drive.now()));
        if (drive.done() && next == moves.size()) return all;
        all.push_back(plain(drive()));
        if (all.size() > 1000000) FAIL("never ends");
    }
}
std::string refused(const program& moves) {
    try {
        driven(moves);
        return "driven";
    } catch (const invalid_parameter& why) {
        return why.what();
    }
}
double from_line(const line& l, point at) {
    const point way = l.end() - l.start();
    return distance(at, l.start() + std::clamp(dot(at - l.start(), way) / dot(way, way), 0.0, 1.0) * way);
}
/// Distance of a place from a line or an arc without rise, by their equations.
double off(const segment& path, point at) {
    if (const auto* l = std::get_if<line>(&path.shape())) return from_line(*l, at);
    const arc& a = std::get<arc>(path.shape());
    const double from = std::atan2(a.start().y - a.centre().y, a.start().x - a.centre().x);
    double turned = std::atan2(at.y - a.centre().y, at.x - a.centre().x) - from;
    const double way = a.sweep() > 0 ? 1 : -1, turn = 2 * std::numbers::pi;
    turned = std::fmod(std::fmod(way * turned, turn) + turn, turn);
    if (turned > std::abs(a.sweep())) return std::min(distance(at, a.start()), distance(at, a.end()));
    return std::hypot(std::hypot(at.x - a.centre().x, at.y - a.centre().y) - a.radius(), at.z - a.start().z);
}

double given(const move& m) { return m.ending == path_ending::continuous ? m.tolerance : 0; }
bool smooth(const program& moves, std::size_t k) { // at the end of move k
    const segment &a = moves[k].path, &b = moves[k + 1].path;
    return given(moves[k]) > 0 && distance(a.tangent(a.length()), b.tangent(0)) < 1e-9 &&
           distance(a.curvature(a.length()), b.curvature(0)) < 1e-3;
}

struct draw {
    std::mt19937 random;
    double operator()(double a, double b) { return a + (b - a) * double(random()) / 4294967296.0; }
    double magnitude(double a, double b) { return std::pow(10, (*this)(a, b)); }
    point direction() {
        for (;;) {
            const point d{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
            if (const double l = quadrant::path::magnitude(d); l > 0.1 && l < 1) return d / l;
        }
    }
    motion_limits limits() { return at_most((*this)(0.05, 0.5), (*this)(0.5, 5), (*this)(10, 200)); }
    /// Lines and arcs from 0.1 mm on, tangent, nearly so or at any angle; stops and tolerances from 1 um on.
    program path() {
        program moves;
        point at{(*this)(-0.1, 0.1), (*this)(-0.1, 0.1), (*this)(-0.1, 0.1)}, ahead = direction();
        for (auto n = 1 + random() % 10; n > 0; --n) {
            if (const double turn = (*this)(0, 1); turn < 0.3)
                ahead = ahead + (*this)(0, 0.3) * direction();
            else if (turn < 0.7)
                ahead = direction();
            ahead = ahead / quadrant::path::magnitude(ahead);
            if ((*this)(0, 1) < 0.6) {
                moves.push_back(go(line(at, at + magnitude(-4, -2) * ahead), 0));
            } else {
                const double r = magnitude(-3.5, -2) * ((*this)(0, 1) < 0.5 ? 1 : -1),
                             along = std::atan2(ahead.y, ahead.x);
                const arc a(at, {at.x - r * std::sin(along), at.y + r * std::cos(along), 0},
                            std::copysign((*this)(0.05, 4), r));
                moves.push_back(go(a, 0));
                ahead = a.tangent(a.length());
            }
            move& last = moves.back();
            last.feed = (*this)(0.02, 0.5);
            last.rapid = (*this)(0, 1) < 0.1;
            last.ending = (*this)(0, 1) < 0.8 ? path_ending::continuous : path_ending::exact_stop;
            last.tolerance = magnitude(-6, -3.5);
            if (last.ending == path_ending::exact_stop && (*this)(0, 1) < 0.2) last.dwell = (*this)(0, 0.01);
            at = last.path.end();
        }
        return moves;
    }
};

} // namespace

TEST_CASE("interpolator: over thousands of random paths every axis stays within its limits and the path within "
          "its tolerance") {
    // Bounds: 1e-9 of a limit for what is reported and for differences of the positions; eight positions in a
    // third difference, each rounded to 1e-16 m or better, are taken off it as 1e-15 m; 1e-10 m for the place.
    double speed = 0, feed = 0, along_path = 0, acceleration = 0, jerk = 0, first = 0, second = 0, third = 0,
           beyond = -1, off_v = 0, off_a = 0;
    std::size_t samples = 0, never_at_end = 0, missed_stops = 0, between_periods = 0;
    for (unsigned n = 0; n < 3000; ++n) {
        draw random{std::mt19937(n)};
        const machine_limits limits{{random.limits(), random.limits(), random.limits()}, random.limits()};
        const program moves = random.path();
        const auto kind =
            n % 4 == 3 ? profile_kind::cubic_acceleration : profile_kind::trapezoidal_acceleration;
        const auto all = driven(moves, limits, kind);
        samples += all.size();
        const bool straight = std::all_of(moves.begin(), moves.end(), [](const move& each) {
            return std::holds_alternative<line>(each.path.shape());
        });
        // The last ramp of acceleration ends on a period: a period before it, the distance left is a third of v
        // T.
        if (kind == profile_kind::trapezoidal_acceleration && std::get_if<line>(&moves.back().path.shape())) {
            const sample& last = all[all.size() - 2 - std::size_t(std::ceil(moves.back().dwell / T))];
            const double left = distance(last.r, all.back().r);
            between_periods += !(std::abs(left - magnitude(last.v) * T / 3) < 1e-6 * left + 1e-15);
        }
        never_at_end += all.back().r != moves.back().path.end() || !all.back().resting;
        std::size_t stopped = 0;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const sample& p = all[k];
            const auto before = [&](std::size_t i) -> const sample& { return all[k < i ? 0 : k - i]; };
            for (int i = 0; i < 3; ++i) {
                const bounds b = plain(limits.axis[std::size_t(i)]);
                const double r0 = p.r[i], r1 = before(1).r[i], r2 = before(2).r[i], r3 = before(3).r[i];
                speed = std::max(speed, std::abs(p.v[i]) / b.velocity);
                acceleration = std::max(acceleration, std::abs(p.a[i]) / b.acceleration);
                jerk = std::max(jerk, std::abs(p.j[i]) / b.jerk);
                first = std::max(first, std::abs(r0 - r1) / T / b.velocity);
                second = std::max(second, std::abs(r0 - 2 * r1 + r2) / (T * T) / b.acceleration);
                third = std::max(third, (std::abs(r0 - 3 * r1 + 3 * r2 - r3) - 1e-15) / (T * T * T) / b.jerk);
                // The mean of a derivative over a period, against what it changed: trapezoidal rule.
                off_v = std::max(off_v, std::abs((r0 - r1) / T - 0.5 * (p.v[i] + before(1).v[i])) -
                                            b.jerk * T * T / 12);
                off_a =
                    std::max(off_a, std::abs((p.v[i] - before(1).v[i]) / T - 0.5 * (p.a[i] + before(1).a[i])) -
                                        b.jerk * T / 4);
            }
            const std::size_t m = p.line - 1;
            const bounds path = plain(limits.path);
            const double fastest = moves[m].rapid ? path.velocity : std::min(path.velocity, moves[m].feed);
            feed = std::max(feed, magnitude(p.v) / fastest);
            if (straight)
                along_path =
                    std::max({along_path, magnitude(p.a) / path.acceleration, magnitude(p.j) / path.jerk});
            if (k == 0) continue;
            // Moves that follow smoothly are one piece; the corners of a piece reach into it and into its
            // neighbours.
            std::size_t low = m, high = m;
            while (low > 0 && smooth(moves, low - 1)) --low;
            while (high + 1 < moves.size() && smooth(moves, high)) ++high;
            const double allowed = std::max(low > 0 ? given(moves[low - 1]) : 0, given(moves[high]));
            if (low > 0) --low;
            while (low > 0 && smooth(moves, low - 1)) --low;
            if (high + 1 < moves.size()) ++high;
            while (high + 1 < moves.size() && smooth(moves, high)) ++high;
            double nearest = 1;
            for (std::size_t other = low; other <= high; ++other)
                nearest = std::min(nearest, off(moves[other].path, p.r));
            beyond = std::max(beyond, nearest - allowed);
            if (p.resting && p.r == moves[m].path.end() && moves[m].ending == path_ending::exact_stop &&
                !(before(1).resting && before(1).line == p.line))
                ++stopped;
        }
        for (const move& each : moves) missed_stops += each.ending == path_ending::exact_stop;
        missed_stops -= stopped;
    }
    CHECK(samples > 1000000);
    CHECK(speed <= 1 + 1e-9);
    CHECK(feed <= 1 + 1e-9);
    CHECK(along_path <= 1 + 1e-9);
    CHECK(along_path > 0.999);
    CHECK(acceleration <= 1 + 1e-9);
    CHECK(jerk <= 1 + 1e-9);
    CHECK(first <= 1 + 1e-9);
    CHECK(second <= 1 + 1e-9);
    CHECK(third <= 1 + 1e-9);
    CHECK(std::max({speed, acceleration, jerk}) > 0.999); // and the limits are used
    CHECK(off_v < 1e-12);
    CHECK(off_a < 1e-9);
    CHECK(beyond < 1e-10);
    CHECK(never_at_end == 0);
    CHECK(missed_stops == 0);
    CHECK(between_periods == 0);
}

TEST_CASE("interpolator: along a spline the limits hold for the positions, and the derivatives agree within "
          "its feed fluctuation") {
    draw random{std::mt19937(5)};
    double first = 0, second = 0, third = 0, reported = 0, off_v = 0;
    for (int n = 0; n < 200; ++n) {
        program moves;
        spline_knot from{{}, random.direction(), {}};
        double fluctuation = 0;
        for (int k = 0; k < 4; ++k) {
            const double length = random.magnitude(-2.5, -1.5);
            const point ahead = from.tangent + 0.4 * random.direction(), t = ahead / magnitude(ahead);
            const spline_knot to{from.place + length * from.tangent + 0.1 * length * random.direction(), t, {}};
            const spline s = spline::quintic(from, to);
            fluctuation = std::max(fluctuation, s.feed_fluctuation());
            moves.push_back(go(s, 0.2, 1e-5));
            from = to;
        }
        const auto all = driven(moves);
        const bounds b = plain(machine.axis[0]);
        for (std::size_t k = 3; k < all.size(); ++k)
            for (int i = 0; i < 3; ++i) {
                const double r0 = all[k].r[i], r1 = all[k - 1].r[i], r2 = all[k - 2].r[i], r3 = all[k - 3].r[i];
                first = std::max(first, std::abs(r0 - r1) / T / b.velocity);
                second = std::max(second, std::abs(r0 - 2 * r1 + r2) / (T * T) / b.acceleration);
                third = std::max(third, (std::abs(r0 - 3 * r1 + 3 * r2 - r3) - 1e-15) / (T * T * T) / b.jerk);
                reported = std::max({reported, std::abs(all[k].v[i]) / b.velocity,
                                     std::abs(all[k].a[i]) / b.acceleration, std::abs(all[k].j[i]) / b.jerk});
                const double v = 0.5 * (all[k].v[i] + all[k - 1].v[i]);
                off_v = std::max(off_v,
                                 std::abs((r0 - r1) / T - v) - 1.1 * fluctuation * 0.2 - b.jerk * T * T / 12);
            }
    }
    CHECK(reported <= 1 + 1e-9);
    CHECK(first <= 1);
    CHECK(second <= 1);
    CHECK(third <= 1);
    CHECK(off_v < 1e-12);
}

TEST_CASE("interpolator: with slow cubic ramps the jerk is the slope of the acceleration, on lines, arcs, "
          "splines and in corners") {
    const motion_limits slow = at_most(0.3, 0.5, 5);
    const arc bow({0.1, 0, 0}, {0.1, 0.05, 0}, 4), back(bow.end(), {0.1, 0.05, 0}, -1);
    const spline s = spline::quintic({back.end(), back.tangent(9), back.curvature(9)},
                                     {{0.3, 0.1, 0.05}, {0, 0.6, 0.8}, {}});
    for (const program& moves :
         {program{go(line({}, {0.1, 0, 0}), 0.2, 1e-4), go(bow, 0.2, 1e-4), go(back, 0.2, 1e-4)},
          program{go(back, 0.1, 1e-4), go(s, 0.1, 1e-4)}}) {
        const auto all = driven(moves, {{slow, slow, slow}, slow}, profile_kind::cubic_acceleration);
        double off_j = 0, most = 0;
        for (std::size_t k = 1; k < all.size(); ++k)
            for (int i = 0; i < 3; ++i) {
                most = std::max(most, std::abs(all[k].j[i]));
                const double before = all[k - 1].j[i], now = all[k].j[i];
                // Where two pieces meet smoothly the jerk may jump within a period.
                off_j = std::max(off_j, std::abs((all[k].a[i] - all[k - 1].a[i]) / T - 0.5 * (before + now)) -
                                            0.5 * std::abs(now - before));
            }
        CHECK(most > 1);
        CHECK(off_j < 0.01 * most); // its slope jumps where a ramp begins or ends
    }
}

TEST_CASE("interpolator: a square corner is rounded within its tolerance, faster with more of it, at full use "
          "of a limit") {
    double slower = 0;
    for (const double tolerance : {1e-6, 1e-5, 1e-4}) {
        const auto all =
            driven({go(line({}, {0.03, 0, 0}), 0.2, tolerance), go(line({0.03, 0, 0}, {0.03, 0.03, 0}), 0.2)});
        double nearest = 1, slowest = 1, hardest = 0, beside = 0;
        for (const sample& p : all) {
            nearest = std::min(nearest, distance(p.r, {0.03, 0, 0}));
            beside = std::max(beside, std::min(std::abs(p.r.y), std::abs(p.r.x - 0.03)));
            if (p.v.x > 1e-6 && p.v.y > 1e-6) {
                slowest = std::min(slowest, magnitude(p.v));
                hardest = std::max(hardest, magnitude(p.j));
            }
        }
        CHECK(nearest <= std::hypot(tolerance, slowest * T)); // a sample need not be the nearest place
        CHECK(nearest > 0.99 * tolerance);                    // all of the tolerance is used
        CHECK(beside <= tolerance / std::numbers::sqrt2 * (1 + 1e-9));
        CHECK(slowest > slower);
        CHECK(hardest == doctest::Approx(50).epsilon(1e-6)); // of the path
        slower = slowest;
    }
}

TEST_CASE("interpolator: a circle in quarters is driven like the circle in one piece") {
    const double r = 0.05;
    program quarters;
    for (int k = 0; k < 4; ++k) {
        const double a = k * std::numbers::pi / 2;
        quarters.push_back(go(arc({r * std::cos(a), r * std::sin(a), 0}, {}, std::numbers::pi / 2), 0.2, 1e-6));
    }
    const auto one = driven({go(arc({r, 0, 0}, {}, 2 * std::numbers::pi), 0.2)}), four = driven(quarters);
    CHECK(std::abs(double(one.size()) - double(four.size())) <= 1);
    double off_radius = 0, slowest = 1;
    for (std::size_t k = 0; k < four.size(); ++k) {
        off_radius = std::max(off_radius, std::abs(std::hypot(four[k].r.x, four[k].r.y) - r));
        if (k > 400 && k + 400 < four.size()) slowest = std::min(slowest, magnitude(four[k].v));
    }
    CHECK(off_radius < 1e-12);
    CHECK(slowest > 0.99 * 0.2);
}

TEST_CASE("interpolator: sides of a diamond from rest to rest last the whole periods that a profile does") {
    const double c = 0.05 / std::numbers::sqrt2;
    const std::vector<point> corners{{0, -c, 0}, {c, 0, 0}, {0, c, 0}, {-c, 0, 0}, {0, -c, 0}};
    program sides;
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
        sides.push_back(go(line(corners[k], corners[k + 1]), 0.2));
    const machine_limits published{{at_most(unlimited), at_most(unlimited), at_most(unlimited)},
                                   at_most(0.2, 2, 50)};
    const auto all = driven(sides, published);
    const profile side({.length = 50_mm, .limits = at_most(0.2, 2, 50)});
    const auto periods = std::size_t(std::lround(side.in_whole_periods(1_ms).lasts().value() / T));
    REQUIRE(all.size() == 4 * periods + 1);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        CHECK(all[k * periods].r == sides[k < 4 ? k : 3].path.position(k < 4 ? 0 : 1));
        CHECK(all[k * periods].resting);
        CHECK(magnitude(all[k * periods].v) == 0);
    }
}

TEST_CASE("interpolator: neither a move nor a period allocates") {
    draw random{std::mt19937(8)};
    const program moves = random.path();
    interpolator<16> drive({machine}, 1_ms);
    const std::size_t before = counted::allocations;
    for (std::size_t next = 0; next < moves.size() || !drive.done(); drive())
        while (!drive.full() && next < moves.size()) drive.push(moves[next++]);
    CHECK(counted::allocations == before);
}

TEST_CASE("interpolator: dwells last whole periods, rounded up, and hold still") {
    program moves{go(line({}, {0.01, 0, 0}), 0.1), go(line({0.01, 0, 0}, {}), 0.1)};
    const std::size_t without = driven(moves).size();
    moves[0].dwell = 0.0125;
    moves[0].dwell_before = 0.003;
    const auto all = driven(moves);
    CHECK(all.size() == without + 13 + 3);
    for (std::size_t k = 0; k <= 3; ++k) CHECK(all[k].r == point{});
    CHECK(all[4].r.x > 0);
}

TEST_CASE("interpolator: a stop on a straight line is one, whatever follows smoothly") {
    const auto piece = [](int k) { return line({k * 0.01, 0, 0}, {(k + 1) * 0.01, 0, 0}); };
    const auto all =
        driven({go(piece(0), 0.1), go(piece(1), 0.1, 1e-5), go(piece(2), 0.1, 1e-5), go(piece(3), 0.1)});
    std::size_t stops = 0;
    for (const sample& p : all) stops += p.resting && p.r == point{0.01, 0, 0};
    CHECK(stops == 1);
}

TEST_CASE("interpolator: a straight line in a thousand pieces is nearly as fast as in one") {
    program pieces;
    for (int k = 0; k < 1000; ++k)
        pieces.push_back(go(line({k * 5e-4, 0, 0}, {(k + 1) * 5e-4, 0, 0}), 0.2, 1e-6));
    const double whole = double(driven({go(line({}, {0.5, 0, 0}), 0.2)}).size());
    CHECK(double(driven<64>(pieces).size()) < 1.2 * whole);
    CHECK(double(driven<128>(pieces).size()) < 1.02 * whole);
}

TEST_CASE("interpolator: where moves come too late it stops in time, and goes on when they come") {
    interpolator<8> drive({machine}, 1_ms);
    const auto piece = [](int k) { return go(line({k * 0.01, 0, 0}, {(k + 1) * 0.01, 0, 0}), 0.2, 1e-5); };
    double hardest = 0;
    for (int k = 0; k < 5; ++k) {
        drive.push(piece(k));
        for (int i = 0; i < 400; ++i) hardest = std::max(hardest, std::abs(plain(drive()).j.x));
        CHECK(plain(drive.now()).r == point{(k + 1) * 0.01, 0, 0});
        CHECK(drive.done());
    }
    CHECK(hardest <= 50 * (1 + 1e-9));
    drive.settle({1, 2, 3});
    CHECK(plain(drive()).r == point{1, 2, 3});
}

TEST_CASE("interpolator: limits that a profile cannot keep are refused, without them every kind arrives") {
    machine_limits free{{at_most(0.3), at_most(0.3), at_most(0.3)}, at_most(0.2, 2)};
    using drive = interpolator<8>;
    CHECK_THROWS_WITH_AS((drive({machine, profile_kind::constant_acceleration}, 1_ms)),
                         "interpolator.path.jerk = 50 m/s^3: must be infinite: only trapezoidal and cubic "
                         "acceleration keep such a limit",
                         invalid_parameter);
    CHECK_THROWS_AS((drive({free, profile_kind::constant_velocity}, 1_ms)), invalid_parameter);
    CHECK_THROWS_AS((drive({machine}, 0_ms)), invalid_parameter);
    const program moves{go(line({}, {0.02, 0, 0}), 0.1, 1e-4), go(line({0.02, 0, 0}, {0.02, 0.02, 0}), 0.1)};
    CHECK(driven(moves, free, profile_kind::constant_acceleration).back().r == point{0.02, 0.02, 0});
    free.path = at_most(0.2);
    const auto all = driven(moves, free, profile_kind::constant_velocity);
    CHECK(all.size() == 401);
    CHECK(all.back().r == point{0.02, 0.02, 0});
}

TEST_CASE("interpolator: what cannot be driven is refused with its line") {
    const line there({}, {0.01, 0, 0}), up({0.01, 0, 0}, {0.01, 0.01, 0}),
        elsewhere({0.02, 0, 0}, {0.01, 0.01, 0});
    CHECK(refused({go(there, 0.1, 0), go(up, 0.1)}) == "line = 1: the path turns by 90 degrees at its end: it "
                                                       "must stop there or have a corner tolerance above 0");
    CHECK(refused({go(there, 0.1), go(elsewhere, 0.1)}) ==
          "line = 2: the move must begin where the last one ended, not 0.01 m from it");
    CHECK(refused({go(there, 0)}) == "line = 1: the feed must be above 0");
    CHECK(refused({go(there, 0.1, 0), go(line({0.01, 0, 0}, {0.02, 0, 0}), 0.1)}) == "driven");
}
