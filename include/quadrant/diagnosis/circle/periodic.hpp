// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit_circles.hpp"

#include <complex>

/// What is periodic along an axis (a cyclic error) or in time (a vibration), sought in what the other errors leave.
namespace quadrant::diagnosis::detail {

/// Sample by sample of every run.
using residuals = std::vector<std::vector<double>>;

/// A sum of squares of noise with so many degrees of freedom stays below this many times its mean in all of `places` places,
/// but for one record in a thousand [Laurent2000].
inline double noise_peak(double freedom, double places) {
    const double l = std::log(1000 * places);
    return 1 + 2 * std::sqrt(l / freedom) + 2 * l / freedom;
}
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Mean power of noise around place k of a spectrum, from the larger of both sides' medians: what is smooth there is no peak.
/// Without enough neighbours infinite.
inline double around(const std::vector<double>& power, std::size_t k, std::size_t next, std::size_t many) {
    if (k < next + many / 2 || k + next + many / 2 >= power.size()) return HUGE_VAL;
    const auto at = [&](std::size_t i) { return power.begin() + static_cast<std::ptrdiff_t>(i); };
    const double below = median({at(k - std::min(k, next + many)), at(k - next)}),
                 above = median({at(k + next + 1), at(std::min(power.size(), k + next + many + 1))});
    return std::max({below, above, 1e-300});
}

struct periodic_error {
    bool there = false;
    int axis = 0;                 ///< 0: x, 1: y
    double period = 0;            ///< along the axis [m], or the frequency [Hz]
    double energy = 0;            ///< what it takes out of the sum of squares
    double threshold = 0;         ///< amplitude that would have been found
    std::vector<double> amplitude, error; ///< one a run, with its standard error
    std::vector<double> phase;
    double common = 1; ///< share of the energy that one amplitude and phase for all runs explains
};

/// e = A cos(2 pi p/period + phase) of one axis at its place p, which r sees as e cos t (of y: e sin t). Each run has its own
/// amplitude and phase, so that a force (cogging), whose effect changes with the feed, is found too.
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
            if (const double above = energy[k] / around(energy, k, 6, 40); above > most_above) most_above = above, best = k;
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
    /// Of all runs, for frequencies `step` apart: the phasor of each cell turns on by the same angle every time.
    std::vector<double> energies(int axis, const std::vector<double>& frequency, double step) const {
        std::vector<double> out(frequency.size());
        for (std::size_t j = 0; j < runs_.size() && !frequency.empty(); ++j) {
            std::vector<normal_equations> all(frequency.size());
            for (const cell& k : cells_[j]) {
                const double along = axis == 0 ? std::cos(k.angle) : std::sin(k.angle),
                             place = two_pi * runs_[j].radius * along;
                double c = along * std::cos(place * frequency[0]), s = along * std::sin(place * frequency[0]);
                const double dc = std::cos(place * step), ds = std::sin(place * step);
                for (normal_equations& at : all) {
                    at.add(c, s, k.value);
                    const double next = c * dc - s * ds;
                    s = c * ds + s * dc, c = next;
                }
            }
            for (std::size_t i = 0; i < out.size(); ++i) out[i] += all[i].solve(0).energy;
        }
        return out;
    }

    const std::vector<circle_run>& runs_;
    double shortest_;
    std::vector<std::vector<cell>> cells_;
};

/// A tone of fixed frequency, from the mean power of half-second pieces (Hann) of every run: it must stand out of its neighbours
/// in each group of feeds, for what moves in frequency with the feed is none.
class vibration_search {
public:
    vibration_search(const std::vector<circle_run>& runs, const residuals& left,
                     const std::vector<std::size_t>& group_of_run)
        : runs_(runs), left_(left), groups_(group_of_run) {}

    periodic_error operator()() const {
        double slowest = 0, shortest = HUGE_VAL;
        for (const circle_run& r : runs_)
            slowest = std::max(slowest, r.period_s),
            shortest = std::min(shortest, double(r.angle.size()) * r.period_s);
        const double piece = std::min(0.5, shortest / 4), spacing = 1 / piece;
        const double top = std::min(0.45 / slowest, 400.0);
        std::vector<double> frequency;
        for (double f = 5 * spacing; f < top; f += spacing) frequency.push_back(f);
        periodic_error out;
        if (frequency.size() < 40) return out;
        const std::size_t groups = *std::max_element(groups_.begin(), groups_.end()) + 1;
        std::vector<std::vector<double>> power(groups, std::vector<double>(frequency.size()));
        std::vector<double> pieces(groups);
        for (std::size_t j = 0; j < runs_.size(); ++j) {
            for (std::size_t k = 0; k < frequency.size(); ++k) {
                const auto found = pieces_of(j, piece, frequency[k]);
                for (const auto& p : found) power[groups_[j]][k] += std::norm(p);
                if (k == 0) pieces[groups_[j]] += double(found.size());
            }
        }
        std::size_t best = 0;
        double highest = 0;
        for (std::size_t k = 0; k < frequency.size(); ++k) {
            double least = HUGE_VAL; // over the groups: how far above its neighbours, of what noise may be
            for (std::size_t g = 0; g < groups; ++g) {
                const double mean = neighbours(power[g], k);
                least = std::min(least, power[g][k] / mean / noise_peak(pieces[g], double(frequency.size())));
            }
            if (least > highest) highest = least, best = k;
        }
        out.there = highest > 1;
        out.period = frequency[best];
        double sum = 0, noise = 0;
        for (std::size_t g = 0; g < groups; ++g)
            sum += pieces[g], noise += std::min(neighbours(power[g], best), power[g][best]) * noise_peak(pieces[g], double(frequency.size()));
        out.threshold = std::sqrt(2 * noise / sum);
        if (out.there) settle(out, piece, spacing);
        return out;
    }

    /// What a tone is in run j: amplitude and phase of each piece on its own.
    std::vector<double> in(std::size_t j, double frequency) const {
        const circle_run& r = runs_[j];
        const auto length = std::max<std::size_t>(8, static_cast<std::size_t>(4 / (frequency * r.period_s)));
        std::vector<double> out(r.angle.size());
        for (std::size_t from = 0; from < out.size(); from += length) {
            const std::size_t end = std::min(out.size(), from + length);
            const auto tone = [&](std::size_t k) { return std::polar(1.0, two_pi * frequency * double(k) * r.period_s); };
            std::complex<double> sum = 0;
            for (std::size_t k = from; k < end; ++k) sum += left_[j][k] * std::conj(tone(k));
            for (std::size_t k = from; k < end; ++k)
                out[k] = 2 / double(end - from) * std::real(sum * tone(k));
        }
        return out;
    }

private:
    static double neighbours(const std::vector<double>& power, std::size_t k) {
        return around(power, k, 2, 12) / 0.69; // of an exponential law: mean over median; wider with few pieces
    }
    /// Complex amplitude of each half-overlapping piece.
    std::vector<std::complex<double>> pieces_of(std::size_t j, double piece, double frequency) const {
        const circle_run& r = runs_[j];
        const auto length = static_cast<std::size_t>(piece / r.period_s);
        std::vector<std::complex<double>> out;
        std::vector<double> real(length), imaginary(length); // the tone under its window
        for (std::size_t k = 0; k < length; ++k) {
            const double window = (1 - std::cos(two_pi * double(k) / double(length))) * 2 / double(length),
                         turn = two_pi * frequency * double(k) * r.period_s;
            real[k] = window * std::cos(turn), imaginary[k] = -window * std::sin(turn);
        }
        for (std::size_t from = 0; from + length <= left_[j].size(); from += length / 2) {
            double a = 0, b = 0;
            for (std::size_t k = 0; k < length; ++k)
                a += left_[j][from + k] * real[k], b += left_[j][from + k] * imaginary[k];
            out.emplace_back(a, b);
        }
        return out;
    }
    void settle(periodic_error& out, double piece, double spacing) const {
        const auto power = [&](double f) {
            double sum = 0;
            for (std::size_t j = 0; j < runs_.size(); ++j)
                for (const auto& p : pieces_of(j, piece, f)) sum += std::norm(p);
            return sum;
        };
        double now = power(out.period);
        for (double step = spacing / 2; step > spacing / 40; step /= 2)
            for (const double to : {out.period - step, out.period + step})
                if (const double there = power(to); there > now) now = there, out.period = to;
        struct piece_size {
            std::size_t run;
            double along_x, square; ///< cos^2 t in its middle
        };
        std::vector<piece_size> sizes;
        for (std::size_t j = 0; j < runs_.size(); ++j) {
            const auto found = pieces_of(j, piece, out.period);
            const auto half = static_cast<std::size_t>(piece / runs_[j].period_s) / 2;
            for (std::size_t p = 0; p < found.size(); ++p)
                sizes.push_back({j, std::pow(std::cos(runs_[j].angle[(p + 1) * half]), 2), std::norm(found[p])});
        }
        double xx = 0, xy = 0, yy = 0, xb = 0, yb = 0; // amplitude^2 = a_x^2 cos^2 t + a_y^2 sin^2 t
        for (const piece_size& s : sizes) {
            const double c = s.along_x, d = 1 - c;
            xx += c * c, xy += c * d, yy += d * d, xb += c * s.square, yb += d * s.square;
        }
        const double det = xx * yy - xy * xy, x = (xb * yy - yb * xy) / det, y = (yb * xx - xb * xy) / det;
        out.axis = !(det > 1e-6 * xx * yy) ? 2 : x > 4 * std::max(y, 0.0) ? 0 : y > 4 * std::max(x, 0.0) ? 1 : 2;
        for (std::size_t j = 0; j < runs_.size(); ++j) {
            double weights = 0, sum = 0, spread = 0;
            const auto part = [&](const piece_size& s) {
                return out.axis == 2 ? 1.0 : out.axis == 0 ? s.along_x : 1 - s.along_x;
            };
            for (const piece_size& s : sizes)
                if (s.run == j) weights += part(s) * part(s), sum += part(s) * s.square;
            const double square = sum / std::max(weights, 1e-300), size = std::sqrt(square);
            for (const piece_size& s : sizes)
                if (s.run == j) spread += std::pow(part(s) * (s.square - square * part(s)), 2);
            out.amplitude.push_back(size);
            out.error.push_back(std::sqrt(spread) / std::max(weights, 1e-300) / std::max(2 * size, 1e-300));
            out.energy += 0.5 * square * double(left_[j].size()) * (out.axis == 2 ? 1 : 0.5);
        }
    }

    const std::vector<circle_run>& runs_;
    const residuals& left_;
    const std::vector<std::size_t>& groups_;
};

} // namespace quadrant::diagnosis::detail
