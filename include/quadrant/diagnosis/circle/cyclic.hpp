// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "periodic.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// e = A cos(2 pi p/period + phase) of one axis at its place p, which r sees as e cos t (of y: e sin t). Each
/// run has its own amplitude and phase, so that a force (cogging), whose effect changes with the feed, is found
/// too.
class cyclic_search {
public:
    cyclic_search(const std::vector<circle_run>& runs, const residuals& left, double shortest)
        : runs_(runs), shortest_(shortest) {
        for (const circle_run& r : runs) shortest_ = std::max(shortest_, 3 * r.feed * r.period_s);
        const double width = shortest_ / 6;
        for (std::size_t j = 0; j < runs.size(); ++j) {
            const circle_run& r = runs[j];
            const auto cells = static_cast<std::size_t>(std::ceil(two_pi * r.radius / width));
            std::vector<cell> sums(cells);
            for (std::size_t k = 0; k < r.angle.size(); ++k) {
                const double turn = r.angle[k] / two_pi - std::floor(r.angle[k] / two_pi);
                cell& c = sums[std::min(cells - 1, static_cast<std::size_t>(turn * double(cells)))];
                c.angle += turn * two_pi, c.value += left[j][k], ++c.count;
            }
            std::erase_if(sums, [](const cell& c) { return c.count == 0; });
            for (cell& c : sums) c.angle /= c.count, c.value /= c.count;
            cells_.push_back(std::move(sums));
        }
    }
    periodic_error operator()(int axis) const {
        double least = HUGE_VAL, most = 0;
        for (const circle_run& r : runs_) least = std::min(least, r.radius), most = std::max(most, r.radius);
        const double finest = 1 / (6 * most);
        std::vector<double> frequency;
        for (double f = 2.5 / least; f < 1 / shortest_; f += finest) frequency.push_back(f);
        const auto energy = energies(axis, frequency, finest);
        periodic_error out;
        out.axis = axis;
        if (energy.size() < 20) return out;
        std::size_t best = 0;
        double most_above = 0;
        for (std::size_t k = 0; k < energy.size(); ++k)
            if (const double above = energy[k] / around(energy, k, 6, 40); above > most_above)
                most_above = above, best = k;
        const double peak = noise_peak(2 * double(runs_.size()), double(energy.size())),
                     usual = std::min(around(energy, best, 6, 40), energy[best]);
        double f = frequency[best], step = finest / 2, now = energy[best];
        for (; step > finest / 64; step /= 2)
            for (const double to : {f - step, f + step}) {
                double sum = 0;
                for (std::size_t j = 0; j < runs_.size(); ++j) sum += fit(j, axis, to).energy;
                if (sum > now) now = sum, f = to;
            }
        out.period = 1 / f, out.energy = now, out.there = most_above > peak;
        double rows = 0;
        for (const auto& c : cells_) rows += double(c.size());
        double samples = 0;
        for (const circle_run& r : runs_) samples += double(r.angle.size());
        out.energy *= samples / rows;
        out.threshold = 2 * std::sqrt(peak * usual / rows); // cos^2 t and the sine: a quarter of A^2 a row
        std::complex<double> product = 0;
        double own = 0, inverse = 0;
        for (std::size_t j = 0; j < runs_.size(); ++j) {
            const one_run s = fit(j, axis, f);
            const auto n = double(cells_[j].size());
            const double left_over = std::max(0.0, s.total - s.energy) / std::max(1.0, n - 2);
            out.amplitude.push_back(std::abs(s.amplitude)), out.phase.push_back(std::arg(s.amplitude));
            out.error.push_back(std::sqrt(4 * left_over / n));
            product += n * s.amplitude, own += n * std::norm(s.amplitude), inverse += n;
        }
        out.common = own > 0 ? std::norm(product) / (inverse * own) : 1;
        return out;
    }

    /// What it is in run j at an angle.
    static double at(const periodic_error& e, std::size_t j, double radius, double angle) {
        const double along = e.axis == 0 ? std::cos(angle) : std::sin(angle);
        return e.amplitude[j] * along * std::cos(two_pi * radius * along / e.period + e.phase[j]);
    }

private:
    struct cell {
        double angle = 0, value = 0, count = 0;
    };
    struct one_run {
        std::complex<double> amplitude;
        double energy, total;
    };
    /// Least squares of a cos + b sin along an axis.
    struct normal_equations {
        double cc = 0, cs = 0, ss = 0, rc = 0, rs = 0;
        void add(double c, double s, double value) {
            cc += c * c, cs += c * s, ss += s * s, rc += c * value, rs += s * value;
        }
        one_run solve(double total) const {
            const double det = cc * ss - cs * cs;
            if (!(det > 1e-6 * cc * ss)) return {0, 0, total};
            const double a = (rc * ss - rs * cs) / det, b = (rs * cc - rc * cs) / det;
            return {{a, -b}, a * rc + b * rs, total};
        }
    };
    one_run fit(std::size_t j, int axis, double f) const {
        normal_equations all;
        double total = 0;
        for (const cell& k : cells_[j]) {
            const double along = axis == 0 ? std::cos(k.angle) : std::sin(k.angle),
                         place = two_pi * f * runs_[j].radius * along;
            all.add(along * std::cos(place), along * std::sin(place), k.value);
            total += k.value * k.value;
        }
        return all.solve(total);
    }
    /// Of all runs, for frequencies `step` apart, as if cosine and sine were orthogonal, which over many
    /// periods they are: the phasor of each cell turns on by the same angle every time.
    std::vector<double> energies(int axis, const std::vector<double>& frequency, double step) const {
        std::vector<double> out(frequency.size());
        struct phasor {
            double c, s, dc, ds, value;
        };
        for (std::size_t j = 0; j < runs_.size() && !frequency.empty(); ++j) {
            std::vector<phasor> all;
            double whole = 0;
            for (const cell& k : cells_[j]) {
                const double along = axis == 0 ? std::cos(k.angle) : std::sin(k.angle),
                             place = two_pi * runs_[j].radius * along;
                all.push_back({along * std::cos(place * frequency[0]), along * std::sin(place * frequency[0]),
                               std::cos(place * step), std::sin(place * step), k.value});
                whole += along * along / 2;
            }
            for (double& energy : out) {
                double c = 0, s = 0;
                for (phasor& p : all) {
                    c += p.c * p.value, s += p.s * p.value;
                    const double next = p.c * p.dc - p.s * p.ds;
                    p.s = p.c * p.ds + p.s * p.dc, p.c = next;
                }
                energy += (c * c + s * s) / std::max(whole, 1e-300);
            }
        }
        return out;
    }

    const std::vector<circle_run>& runs_;
    double shortest_;
    std::vector<std::vector<cell>> cells_;
};

} // namespace quadrant::inline v0::diagnosis::detail
