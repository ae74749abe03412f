// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis::detail {

/// One move, bare: places in pitches.
struct cogging_record {
    std::vector<double> turns, command, velocity;
    int direction;
};

/// The least squares of `identify_cogging`: unknowns offset, Coulomb level, viscous slope if velocities are
/// there, cosine and sine of each order, then of each friction order times the direction. Normal equations:
/// with the pitch covered the harmonics are nearly orthogonal.
class cogging_fit {
public:
    struct noise {
        double variance; ///< of a sample, if the residual were white at the level that it has around here
        double freedom;  ///< of that estimate
    };
    struct harmonic_result {
        double amplitude, phase, amplitude_deviation, phase_deviation, freedom;
        double chance;          ///< that noise alone gives such an amplitude or more
        double half_difference; ///< amplitude by which the directions differ, either way
    };

    cogging_fit(const std::vector<cogging_record>& records, unsigned highest,
                const std::vector<unsigned>& friction_orders)
        : highest_(highest), friction_orders_(friction_orders),
          first_(!records.empty() && !records[0].velocity.empty() ? 3 : 2),
          size_(first_ + 2 * (std::size_t(highest) + friction_orders.size())), differences_(highest) {
        for (const int direction : {1, -1}) check_covered(records, direction);
        std::size_t samples = 0, forward = 0;
        for (const auto& r : records) {
            samples += r.turns.size();
            if (r.direction > 0) forward += r.turns.size();
        }
        require(samples > size_ + 2, "identify_cogging.samples", double(samples),
                "must be more than unknowns (" + quadrant::detail::shortest(double(size_ + 2)) + ")");
        solve(records);
        double sum = 0;
        for (const auto& r : records) sum += look_at_residual(r);
        residual_ = std::sqrt(sum / double(samples - size_));
        // The common harmonic takes from either direction what the other has more samples.
        for (auto& each : differences_)
            each *= 0.5 * double(samples) / (double(forward) * double(samples - forward));
        for (std::size_t i = 0; i < friction_orders.size(); ++i) {
            const auto [a, b] = friction(i);
            differences_[friction_orders[i] - 1] = {a, b};
        }
    }

    double x(std::size_t i) const { return x_[i]; }
    double residual() const { return residual_; }
    noise level_noise() const { return noise_around(0); }
    double level_deviation(std::size_t i) const {
        return std::sqrt(noise_around(0).variance * inverse_[i * size_ + i]);
    }
    /// Cosine and sine of the friction order at place i of their list.
    std::pair<double, double> friction(std::size_t i) const {
        const std::size_t c = first_ + 2 * (highest_ + i);
        return {x_[c], x_[c + 1]};
    }
    harmonic_result harmonic(unsigned order) const {
        const std::size_t c = first_ + 2 * (std::size_t(order) - 1), s = c + 1;
        const double a = x_[c], b = x_[s], size = std::hypot(a, b);
        const noise n = noise_around(order);
        const double cc = n.variance * inverse_[c * size_ + c], cs = n.variance * inverse_[c * size_ + s],
                     ss = n.variance * inverse_[s * size_ + s];
        harmonic_result h{size, std::atan2(a, b), 0, 0, n.freedom, 1, std::abs(differences_[order - 1])};
        const double u = size > 0 ? a / size : 1, v = size > 0 ? b / size : 0;
        h.amplitude_deviation = std::sqrt(u * u * cc + 2 * u * v * cs + v * v * ss);
        h.phase_deviation = size > 0 ? std::sqrt(v * v * cc - 2 * u * v * cs + u * u * ss) / size : HUGE_VAL;
        // Two numbers against their spread: F with 2 and `freedom` degrees, whose tail has a closed form.
        const double w = (a * a * ss - 2 * a * b * cs + b * b * cc) / (cc * ss - cs * cs);
        h.chance = n.variance > 0 ? std::pow(1 + w / n.freedom, -n.freedom / 2) : size > 0 ? 0 : 1;
        return h;
    }

private:
    void check_covered(const std::vector<cogging_record>& records, int direction) const {
        const char* name = direction > 0 ? "identify_cogging.forward runs" : "identify_cogging.backward runs";
        std::vector<double> places;
        for (const auto& r : records)
            if (r.direction == direction)
                for (const double t : r.turns) places.push_back(t - std::floor(t));
        require(!places.empty(), name, 0, "must be there: friction drops out of both directions only");
        std::sort(places.begin(), places.end());
        double gap = places.front() + 1 - places.back();
        for (std::size_t i = 1; i < places.size(); ++i) gap = std::max(gap, places[i] - places[i - 1]);
        const double half_wave = 0.5 / double(highest_);
        require(
            gap <= half_wave, name, gap,
            "(largest gap, in pitches) must cover a whole pitch without a gap above half the shortest wave (" +
                quadrant::detail::shortest(half_wave) + "): move further, or look for fewer harmonics");
    }
    void fill(const cogging_record& r, std::size_t i, std::vector<double>& row) const {
        row[0] = 1, row[1] = r.direction;
        if (first_ == 3) row[2] = r.velocity[i];
        const std::complex<double> one =
            std::polar(1.0, 2 * std::numbers::pi * std::remainder(r.turns[i], 1.0));
        std::complex<double> z = one;
        for (std::size_t h = 0; h < highest_; ++h, z *= one) {
            const std::size_t j = first_ + 2 * h;
            row[j] = z.real(), row[j + 1] = z.imag();
        }
        for (std::size_t f = 0; f < friction_orders_.size(); ++f) {
            const std::size_t j = first_ + 2 * (highest_ + f),
                              of = first_ + 2 * std::size_t(friction_orders_[f] - 1);
            row[j] = r.direction * row[of], row[j + 1] = r.direction * row[of + 1];
        }
    }
    void solve(const std::vector<cogging_record>& records) {
        std::vector<double> m(size_ * size_), row(size_);
        x_.assign(size_, 0);
        for (const auto& r : records)
            for (std::size_t k = 0; k < r.turns.size(); ++k) {
                fill(r, k, row);
                for (std::size_t i = 0; i < size_; ++i) {
                    for (std::size_t j = 0; j <= i; ++j) m[i * size_ + j] += row[i] * row[j];
                    x_[i] += row[i] * r.command[k];
                }
            }
        // Cholesky, in place.
        for (std::size_t i = 0; i < size_; ++i) {
            const double whole = m[i * size_ + i];
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = m[i * size_ + j];
                for (std::size_t k = 0; k < j; ++k) sum -= m[i * size_ + k] * m[j * size_ + k];
                if (i != j)
                    m[i * size_ + j] = sum / m[j * size_ + j];
                else {
                    require(
                        sum > 1e-9 * whole, "identify_cogging.unknown", double(i),
                        "must not be a combination of the others (velocity beside direction: vary the speed)");
                    m[i * size_ + i] = std::sqrt(sum);
                }
            }
        }
        const auto solved = [&](std::vector<double> b) {
            for (std::size_t i = 0; i < size_; ++i) {
                for (std::size_t k = 0; k < i; ++k) b[i] -= m[i * size_ + k] * b[k];
                b[i] /= m[i * size_ + i];
            }
            for (std::size_t i = size_; i-- > 0;) {
                for (std::size_t k = i + 1; k < size_; ++k) b[i] -= m[k * size_ + i] * b[k];
                b[i] /= m[i * size_ + i];
            }
            return b;
        };
        x_ = solved(x_);
        inverse_.resize(size_ * size_);
        for (std::size_t i = 0; i < size_; ++i) {
            std::vector<double> e(size_);
            e[i] = 1;
            e = solved(std::move(e));
            std::copy(e.begin(), e.end(), inverse_.begin() + std::ptrdiff_t(i * size_));
        }
    }
    /// Periodogram of what is left of a run, at waves per pitch that are independent over its length; its sum
    /// of squares.
    double look_at_residual(const cogging_record& r) {
        const auto [low, high] = std::minmax_element(r.turns.begin(), r.turns.end());
        const double passes = std::max(*high - *low, 0.1);
        const auto lines = std::size_t(std::floor((double(highest_) + reach + 0.5) * passes));
        std::vector<std::complex<double>> sums(lines);
        std::vector<double> row(size_);
        double squares = 0;
        for (std::size_t k = 0; k < r.turns.size(); ++k) {
            fill(r, k, row);
            double e = r.command[k];
            for (std::size_t j = 0; j < size_; ++j) e -= row[j] * x_[j];
            squares += e * e;
            for (std::size_t h = 0; h < highest_; ++h)
                differences_[h] +=
                    r.direction * e * std::complex<double>(row[first_ + 2 * h], row[first_ + 2 * h + 1]);
            const std::complex<double> one =
                std::polar(1.0, 2 * std::numbers::pi * (r.turns[k] - *low) / passes);
            std::complex<double> z = one;
            for (auto& each : sums) each += e * z, z *= one;
        }
        for (std::size_t j = 0; j < lines; ++j)
            lines_.emplace_back(double(j + 1) / passes, std::norm(sums[j]) / double(r.turns.size()));
        return squares;
    }
    /// Each line carries two degrees of freedom; each harmonic that was fitted took two.
    noise noise_around(unsigned order) const {
        double sum = 0, freedom = 0;
        for (const auto& [waves, power] : lines_)
            if (waves > 0.5 && std::abs(waves - double(order)) < reach + 0.5) sum += power, freedom += 2;
        const double low = std::max(1.0, double(order) - reach),
                     high = std::min(double(highest_), double(order) + reach);
        for (const unsigned f : friction_orders_)
            if (f >= low && f <= high) freedom -= 2;
        freedom = std::max(1.0, freedom - 2 * (high - low + 1));
        return {2 * sum / freedom, freedom};
    }

    static constexpr double reach = 5; ///< orders to either side that share a level of noise
    unsigned highest_;
    std::vector<unsigned> friction_orders_;
    std::size_t first_, size_; ///< place of the first harmonic; unknowns
    std::vector<double> x_, inverse_;
    std::vector<std::pair<double, double>> lines_; ///< waves per pitch, power
    std::vector<std::complex<double>>
        differences_; ///< by order: cosine, sine of half the difference of the directions
    double residual_ = 0;
};

} // namespace quadrant::inline v0::analysis::detail
