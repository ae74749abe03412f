// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/presliding.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

/// Ways to move a friction law that remembers, as a plant does: after(v, h), become(next).
namespace hysteresis {

using namespace quadrant;
using namespace quadrant::literals;

inline const duration Ts = 500_us;
constexpr double bad_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double um = 1e-6;

inline auto mps(double v) { return quantity<si::velocity>::from_value(v); }
inline auto seconds(double t) { return duration::from_value(t); }
inline auto newtons(double f) { return quantity<si::force>::from_value(f); }
inline auto per_um(double k) { return gain_rate_of<signal::force, signal::velocity>::from_value(k * 1e6); }

/// One step of the law at v for h; the force after it.
template <class Law> double step(Law& law, double v, double h) {
    const auto to = law.after(mps(v), seconds(h));
    law.become(to.next);
    return to.force.value();
}
/// Moves the law by `way` [m] in equal steps of h each; the force [N] at the end.
template <class Law> double go(Law& law, double way, int steps = 100, double h = 1e-3) {
    double f = 0;
    for (int k = 0; k < steps; ++k) f = step(law, way / (steps * h), h);
    return f;
}

/// Equal to a share of the larger one, however small they are (doctest::Approx adds one to the scale).
inline bool alike(double a, double b, double share) {
    return std::abs(a - b) <= share * std::max(std::abs(a), std::abs(b));
}

class dice {
public:
    explicit dice(std::uint64_t seed = 20080615) : x_(seed) {}
    double operator()(double low, double high) { return low + (high - low) * next(); }
    double decades(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
    bool often() { return next() < 0.7; }

private:
    double next() {
        x_ = x_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(x_ >> 11) * 0x1p-53;
    }
    std::uint64_t x_;
};

/// A bad velocity gives the last force and moves nothing; it is reported until settle or reset.
template <class Law> void check_bad_velocities(const Law& fresh) {
    for (const double bad : {bad_number, infinite, -infinite}) {
        Law law = fresh;
        const auto last = law(2_mmps);
        auto twin = law;
        CHECK(law(mps(bad)) == last);
        CHECK(law.faulted());
        CHECK_FALSE(twin.faulted());
        for (int k = 0; k < 10; ++k) CHECK(law(-3_mmps) == twin(-3_mmps));
        CHECK(law.faulted());
        law.settle(0_mps);
        CHECK_FALSE(law.faulted());
        CHECK(law(0_mps) == 0_N);
        law.settle(mps(bad));
        CHECK(law.faulted());
        law.reset();
        CHECK_FALSE(law.faulted());
        CHECK(law(mps(bad)) == 0_N);
    }
}

/// What the constructor says to changed parameters; "taken" when nothing.
template <class Law, class Change>
std::string refusal(typename Law::parameters p, Change change, duration period = Ts) {
    change(p);
    try {
        Law{p, period};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "taken";
}

} // namespace hysteresis
