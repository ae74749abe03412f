// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "least_squares.hpp"
#include "response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis::detail {

/// The fit of one number of modes: x = A/fastest, ln B, Td fastest, then ln w, ln zeta, share for each mode.
class modal_search {
public:
    struct point {
        complex s, value;
        double weight; ///< 1/spread
    };
    modal_search(std::vector<point> points, double period, std::vector<double> rigid)
        : x(std::move(rigid)), points_(std::move(points)), period_(period), slowest_(points_.front().s.imag()),
          fastest_(points_.back().s.imag()) {
        for (const point& p : points_) sampled_.push_back(p.value);
    }

    /// Puts a mode where it takes most of the misfit away: each line of the band as centre and four dampings
    /// are tried, the best share is then linear.
    void add_mode() {
        std::vector<complex> off(points_.size()), rigid(points_.size());
        std::vector<double> weight(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const point& p = points_[i];
            rigid[i] = shape(p.s, x);
            off[i] = p.value / (factor(p.s, x) * rigid[i]) - 1.0;
            weight[i] = p.weight / std::abs(1.0 + off[i]);
        }
        double most = -1;
        std::array<double, 3> best{};
        for (const point& centre : points_)
            for (const double damping : {0.003, 0.01, 0.03, 0.1}) {
                const double w = centre.s.imag();
                double with = 0, own = 0;
                for (std::size_t i = 0; i < points_.size(); ++i) {
                    const complex d = weight[i] * pole_pair(points_[i].s, w, damping) / rigid[i];
                    with += (std::conj(d) * off[i]).real() * weight[i];
                    own += std::norm(d);
                }
                if (with * with / own > most)
                    most = with * with / own, best = {std::log(w), std::log(damping), with / own};
            }
        x.insert(x.end(), best.begin(), best.end());
    }

    /// Of a sampled plant what the model says of roll-off and aliases is divided out of the lines, which
    /// settles at once.
    void run() {
        for (int round = 0; round < (period_ > 0 ? 3 : 1); ++round) {
            for (std::size_t i = 0; i < points_.size(); ++i)
                points_[i].value = sampled_[i] / sampling(points_[i].s);
            descend();
        }
    }

    std::vector<double> variances() const { return equations(0).solve().inverse_diagonal; }
    double misfit() const {
        double sum = 0;
        for (const point& p : points_) sum += std::norm(off(p, x)) / double(points_.size());
        return std::sqrt(sum);
    }
    /// Of two numbers a line; a mode counts as four unknowns, because its place was picked among all lines:
    /// with three, one record of noise in ten is given a mode.
    double information() const {
        const std::size_t modes = x.size() / 3 - 1;
        const double n = 2 * double(points_.size());
        return n * std::log(cost / n) + double(x.size() + modes) * std::log(n);
    }
    double surprise() const { return cost / double(2 * points_.size() - x.size()); }

    std::vector<double> x;
    double cost = HUGE_VAL;
    bool converged = false;

private:
    /// Gauss-Newton with Marquardt's damping; steps out of bounds are refused like steps uphill.
    void descend() {
        cost = squares(x);
        converged = false;
        double damping = 1e-3;
        for (int round = 0; round < 200 && !converged; ++round) {
            const auto step = equations(damping).solve().x;
            auto next = x;
            double largest = 0;
            for (std::size_t i = 0; i < x.size(); ++i)
                next[i] += step[i], largest = std::max(largest, std::abs(step[i]) / (1 + std::abs(x[i])));
            const double more = inside(next) ? squares(next) : HUGE_VAL;
            if (more <= cost) {
                converged = cost - more <= 1e-10 * cost;
                x = std::move(next);
                cost = more;
                damping = std::max(1e-9, damping * 0.2);
            } else {
                converged = largest < 1e-10; // at the bottom, to rounding
                damping *= 8;
            }
        }
    }

    /// What a hold and sampling make of the plant: sum over k of G(s + k ws) sinc(f_k T), over G. Its first
    /// five aliases.
    complex sampling(complex s) const {
        if (!(period_ > 0)) return 1;
        complex sum = 0;
        for (int k = -5; k <= 5; ++k) {
            const complex alias(0, s.imag() + 2 * std::numbers::pi * k / period_);
            const double half = 0.5 * alias.imag() * period_;
            sum += factor(alias, x) * shape(alias, x) * std::sin(half) / half;
        }
        return sum / (factor(s, x) * shape(s, x));
    }
    static complex pole_pair(complex s, double w, double damping) {
        return 1.0 / (s * s + 2 * damping * w * s + w * w);
    }
    /// G without B and delay.
    complex shape(complex s, const std::vector<double>& at) const {
        complex sum = 1.0 / (s * (s + at[0] * fastest_));
        for (std::size_t i = 3; i < at.size(); i += 3)
            sum += at[i + 2] * pole_pair(s, std::exp(at[i]), std::exp(at[i + 1]));
        return sum;
    }
    complex factor(complex s, const std::vector<double>& at) const {
        return std::exp(at[1] - s * at[2] / fastest_);
    }
    complex off(const point& p, const std::vector<double>& at) const {
        return std::log(factor(p.s, at) * shape(p.s, at) / p.value); // phase in (-pi, pi]
    }
    double squares(const std::vector<double>& at) const {
        double sum = 0;
        for (const point& p : points_) sum += p.weight * p.weight * std::norm(off(p, at));
        return sum;
    }
    bool inside(const std::vector<double>& at) const {
        for (std::size_t i = 3; i < at.size(); i += 3)
            if (at[i] < std::log(slowest_) || at[i] > std::log(fastest_) || at[i + 1] < std::log(1e-4) ||
                at[i + 1] > 0)
                return false;
        return at[0] > -slowest_ / fastest_;
    }
    least_squares equations(double damping) const {
        least_squares out(x.size());
        std::vector<complex> slope(x.size());
        std::vector<double> re(x.size()), im(x.size()), norm(x.size());
        for (const point& p : points_) {
            const complex g = shape(p.s, x), rigid = p.s + x[0] * fastest_;
            slope[0] = -fastest_ / (p.s * rigid * rigid) / g;
            slope[1] = 1;
            slope[2] = -p.s / fastest_;
            for (std::size_t i = 3; i < x.size(); i += 3) {
                const double w = std::exp(x[i]), z = std::exp(x[i + 1]);
                const complex d = pole_pair(p.s, w, z), by = -x[i + 2] * d * d / g;
                slope[i] = by * (2 * z * w * p.s + 2 * w * w);
                slope[i + 1] = by * (2 * z * w * p.s);
                slope[i + 2] = d / g;
            }
            const complex e = off(p, x);
            for (std::size_t i = 0; i < x.size(); ++i) {
                re[i] = p.weight * slope[i].real(), im[i] = p.weight * slope[i].imag();
                norm[i] += p.weight * p.weight * std::norm(slope[i]);
            }
            out.add(re, -p.weight * e.real());
            out.add(im, -p.weight * e.imag());
        }
        for (std::size_t i = 0; damping > 0 && i < x.size(); ++i) {
            std::vector<double> row(x.size());
            row[i] = std::sqrt(damping * norm[i]);
            out.add(row, 0);
        }
        return out;
    }

    std::vector<point> points_;
    std::vector<complex> sampled_; ///< their values as measured
    double period_;
    double slowest_, fastest_; ///< [rad/s]
};

} // namespace quadrant::inline v0::analysis::detail
