// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0::path {

/// Where a spline piece begins or ends: what its neighbour shares, so that the joint is smooth.
struct spline_knot {
    point place;     ///< [m]
    point tangent;   ///< unit vector
    point curvature; ///< vector [1/m], at right angles to the tangent
};

/// Quintic or cubic polynomial piece of a tool path, by its path length s [m] from its start; s beyond an end
/// is held there.
///   r(u) = c0 + c1 u + ... + c5 u^5, u = 0 ... 1;   u(q) = f0 + f1 q + ... + f7 q^7, q = s/L  (feed correction)
/// The feed correction has the exact value, slope and second derivative of u(s) at both ends, so that speed and
/// acceleration do not jump from piece to piece; its two free coefficients are the least squares fit to the
/// measured relation of u and s between. It is an approximation: |dr/ds| is 1 within feed_fluctuation(), and
/// `tangent` and `curvature` are exact for the place they are given at. `part` cuts a piece to make it better;
/// spline_path.hpp does so.
/// Source: [Erkorkmaz2005]; knots with unit tangents and curvature vectors: the nearly arc-length parametrised
/// quintic of [Wang1999].
/// Throws for what is not finite, and where the piece stands still or turns back (no tangent there). Never
/// allocates.
class spline {
public:
    /// r(u) = sum of c[k] u^k, u = 0 ... 1 [m].
    explicit spline(const std::array<point, 6>& c) : c_(c) { parametrise(); }

    /// Through both knots with their tangents and curvatures; its parameter is nearly its path length.
    static spline quintic(const spline_knot& from, const spline_knot& to) {
        return lengthened(from, to, [](const spline_knot& a, const spline_knot& b, double l) {
            const point v0 = l * a.tangent, v1 = l * b.tangent, a0 = l * l * a.curvature,
                        a1 = l * l * b.curvature;
            const point d = b.place - a.place;
            return std::array<point, 6>{a.place,
                                        v0,
                                        0.5 * a0,
                                        10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1,
                                        -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
                                        6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1};
        });
    }
    /// Through both knots with their tangents; the curvature is what comes of it.
    static spline cubic(const spline_knot& from, const spline_knot& to) {
        return lengthened(from, to, [](const spline_knot& a, const spline_knot& b, double l) {
            const point v0 = l * a.tangent, v1 = l * b.tangent, d = b.place - a.place;
            return std::array<point, 6>{a.place, v0, 3 * d - 2 * v0 - v1, v0 + v1 - 2 * d, {}, {}};
        });
    }

    double length() const noexcept { return length_; } ///< [m], above 0
    point start() const noexcept { return c_[0]; }     ///< [m]
    point end() const noexcept { return end_; }        ///< [m]
    point position(double s) const noexcept {          ///< [m]; exact at both ends
        return s <= 0 ? c_[0] : s >= length_ ? end_ : at(parameter(s));
    }
    point tangent(double s) const noexcept { ///< unit vector
        const point v = slope(parameter(s));
        return v / magnitude(v);
    }
    point curvature(double s) const noexcept { ///< vector [1/m], at right angles to the tangent
        const double u = parameter(s);
        const point v = slope(u), a = bend(u);
        const double v2 = dot(v, v);
        return (a - (dot(a, v) / v2) * v) / v2;
    }
    /// Largest | |dr/ds| - 1 | on a grid over the piece: share by which the feed is off at worst.
    double feed_fluctuation() const noexcept { return fluctuation_; }
    /// The piece of the same curve from u0 to u1 (0 <= u0 < u1 <= 1).
    spline part(double u0, double u1) const {
        // Taylor about u0, u = u0 + (u1 - u0) w.
        std::array<point, 6> c = c_;
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t k = 4; k + 1 > i; --k) c[k] += u0 * c[k + 1];
        double scale = 1;
        for (point& each : c) {
            each = scale * each;
            scale *= u1 - u0;
        }
        return spline(c);
    }

private:
    static constexpr std::size_t cells = 16;

    /// A curve that is as long as its own parameter interval; the chord is where the search begins.
    template <class Coefficients>
    static spline lengthened(const spline_knot& from, const spline_knot& to, Coefficients coefficients) {
        double l = distance(from.place, to.place);
        require_positive("spline.chord", l);
        for (int pass = 0; pass < 4; ++pass) l = spline(coefficients(from, to, l), measure_only{}).length_;
        return spline(coefficients(from, to, l));
    }
    struct measure_only {};
    spline(const std::array<point, 6>& c, measure_only) : c_(c) { measure(); }

    point at(double u) const noexcept {
        return c_[0] + u * (c_[1] + u * (c_[2] + u * (c_[3] + u * (c_[4] + u * c_[5]))));
    }
    point slope(double u) const noexcept {
        return c_[1] + u * (2 * c_[2] + u * (3 * c_[3] + u * (4 * c_[4] + u * (5 * c_[5]))));
    }
    point bend(double u) const noexcept {
        return 2 * c_[2] + u * (6 * c_[3] + u * (12 * c_[4] + u * (20 * c_[5])));
    }
    double parameter(double s) const noexcept {
        const double q = std::clamp(s / length_, 0.0, 1.0);
        double u = 0;
        for (std::size_t k = f_.size(); k-- > 0;) u = u * q + f_[k];
        return u;
    }
    double parameter_slope(double q) const noexcept { // du/dq
        double du = 0;
        for (std::size_t k = f_.size(); k-- > 1;) du = du * q + double(k) * f_[k];
        return du;
    }

    /// Path length up to each cell, by Gauss-Legendre with five places a cell.
    std::array<double, cells + 1> measure() {
        constexpr std::array<double, 5> place{-0.906179845938664, -0.5384693101056831, 0, 0.5384693101056831,
                                              0.906179845938664};
        constexpr std::array<double, 5> weight{0.23692688505618908, 0.47862867049936647, 0.5688888888888889,
                                               0.47862867049936647, 0.23692688505618908};
        std::array<double, cells + 1> travelled{};
        double slowest = HUGE_VAL, half = 0.5 / double(cells);
        for (std::size_t i = 0; i < cells; ++i) {
            double sum = 0;
            for (std::size_t k = 0; k < place.size(); ++k) {
                const double speed = magnitude(slope((2 * double(i) + 1 + place[k]) * half));
                slowest = std::min(slowest, speed);
                sum += weight[k] * speed;
            }
            travelled[i + 1] = travelled[i] + half * sum;
        }
        length_ = travelled[cells];
        require_positive("spline.length", length_);
        slowest = std::min({slowest, magnitude(slope(0)), magnitude(slope(1))});
        require(slowest > 1e-6 * length_, "spline.slope", slowest,
                "must not vanish: the curve stands still or turns back");
        return travelled;
    }
    void parametrise() {
        const auto travelled = measure();
        end_ = c_[0] + c_[1] + c_[2] + c_[3] + c_[4] + c_[5];
        // Value, slope and second derivative of u over q = s/L at both ends: quintic Hermite.
        const double L = length_;
        const auto ends = [&](double u, double& du, double& ddu) {
            const point v = slope(u), a = bend(u);
            const double v2 = dot(v, v);
            du = L / std::sqrt(v2);
            ddu = -L * L * dot(v, a) / (v2 * v2);
        };
        double du0 = 0, ddu0 = 0, du1 = 0, ddu1 = 0;
        ends(0, du0, ddu0);
        ends(1, du1, ddu1);
        f_ = {0,
              du0,
              0.5 * ddu0,
              10 - 6 * du0 - 4 * du1 - 1.5 * ddu0 + 0.5 * ddu1,
              -15 + 8 * du0 + 7 * du1 + 1.5 * ddu0 - ddu1,
              6 - 3 * du0 - 3 * du1 - 0.5 * ddu0 + 0.5 * ddu1,
              0,
              0};
        // What may be added without touching the ends: q^3 (1 - q)^3 (a + b q), least squares over the cells.
        double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
        for (std::size_t i = 1; i < cells; ++i) {
            const double q = travelled[i] / L, w = q * q * q * (1 - q) * (1 - q) * (1 - q);
            const double off = double(i) / double(cells) - parameter(travelled[i]);
            aa += w * w, ab += w * w * q, bb += w * w * q * q, ra += w * off, rb += w * q * off;
        }
        const double det = aa * bb - ab * ab, a = (bb * ra - ab * rb) / det, b = (aa * rb - ab * ra) / det;
        f_[3] += a, f_[4] += b - 3 * a, f_[5] += 3 * a - 3 * b, f_[6] += 3 * b - a, f_[7] -= b;
        for (std::size_t i = 0; i <= 4 * cells; ++i) {
            const double q = double(i) / double(4 * cells);
            const double speed = magnitude(slope(parameter(q * L))) * parameter_slope(q) / L;
            fluctuation_ = std::max(fluctuation_, std::abs(speed - 1));
        }
    }

    std::array<point, 6> c_;
    std::array<double, 8> f_{};
    point end_;
    double length_ = 0, fluctuation_ = 0;
};

} // namespace quadrant::inline v0::path
