// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// How a drive goes from one set-point to the next.
///   hold     the newest set-point until the next one arrives
///   linear   from the previous set-point to the newest within one period: one period late
///   cubic    a cubic between the two set-points before the newest, with the slopes of their neighbours: two periods late, no
///            step of the velocity
enum class interpolation { hold, linear, cubic };

/// The set-points of a drive as its loops see them: what a bus delivers every few servo periods, drawn as a
/// line.
///   hold     y(p) = r0
///   linear   y(p) = r1 + p (r0 - r1)
///   cubic    y(p) = Hermite through r2 and r1 with the slopes (r1 - r3)/2 and (r0 - r2)/2 a period
/// r0 is the newest set-point, r1 the one before; p = 0 ... 1 is the time since r0 arrived, in periods.
/// Source: CiA 402-2, interpolated position mode (linear) and cyclic synchronous position with the cubic that
/// drives offer.
/// Ports: arrive(state, set-point) once a period; line(state, p), slope(state, p) and velocity(state, p) [a
/// period] in between. A lost set-point arrives as the previous one.
/// State: the last four set-points, given and returned by the caller; `state::at(x)`: as if x had been asked
/// for ever.
/// Range: 0 <= p <= 1. NaN and infinities pass on. Throws nothing. Runs in lanes.
/// Cost: 10 multiplications for the cubic. Motion with bounded acceleration between points: `interpolator`.
template <class Real = double> class set_point_line {
public:
    /// The last set-points, the newest first.
    struct state {
        std::array<Real, 4> last{};

        static state at(Real x) noexcept { return {{x, x, x, x}}; }
    };

    explicit set_point_line(interpolation kind = interpolation::hold) noexcept : kind_(kind) {}

    void arrive(state& s, Real newest) const noexcept {
        for (std::size_t i = s.last.size() - 1; i > 0; --i) s.last[i] = s.last[i - 1];
        s.last[0] = newest;
    }
    Real operator()(const state& s, Real p) const noexcept {
        const auto& r = s.last;
        if (kind_ == interpolation::hold) return r[0];
        if (kind_ == interpolation::linear) return r[1] + p * (r[0] - r[1]);
        const Real a = Real(0.5) * (r[1] - r[3]), b = Real(0.5) * (r[0] - r[2]), d = r[1] - r[2];
        return r[2] + p * (a + p * (Real(3) * d - Real(2) * a - b + p * (a + b - Real(2) * d)));
    }
    /// Its derivative, a period of the set-points; 0 while they are held.
    Real slope(const state& s, Real p) const noexcept {
        const auto& r = s.last;
        if (kind_ == interpolation::hold) return Real(0);
        if (kind_ == interpolation::linear) return r[0] - r[1];
        const Real a = Real(0.5) * (r[1] - r[3]), b = Real(0.5) * (r[0] - r[2]), d = r[1] - r[2];
        return a + p * (Real(2) * (Real(3) * d - Real(2) * a - b) + p * Real(3) * (a + b - Real(2) * d));
    }

    /// What a feedforward takes for the velocity [a period]: the slope; of held set-points, which have none,
    /// the last step.
    Real velocity(const state& s, Real p) const noexcept {
        return kind_ == interpolation::hold ? s.last[0] - s.last[1] : slope(s, p);
    }

private:
    interpolation kind_;
};

} // namespace quadrant::inline v0
