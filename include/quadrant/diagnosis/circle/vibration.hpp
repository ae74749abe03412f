// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "periodic.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// A tone of fixed frequency, from the mean power of half-second pieces (Hann) of every run: it must stand out
/// of its neighbours in each group of feeds, for what moves in frequency with the feed is none.
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
            sum += pieces[g], noise += std::min(neighbours(power[g], best), power[g][best]) *
                                       noise_peak(pieces[g], double(frequency.size()));
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
            const auto tone = [&](std::size_t k) {
                return std::polar(1.0, two_pi * frequency * double(k) * r.period_s);
            };
            std::complex<double> sum = 0;
            for (std::size_t k = from; k < end; ++k) sum += left_[j][k] * std::conj(tone(k));
            for (std::size_t k = from; k < end; ++k) out[k] = 2 / double(end - from) * std::real(sum * tone(k));
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
                sizes.push_back(
                    {j, std::pow(std::cos(runs_[j].angle[(p + 1) * half]), 2), std::norm(found[p])});
        }
        double xx = 0, xy = 0, yy = 0, xb = 0, yb = 0; // amplitude^2 = a_x^2 cos^2 t + a_y^2 sin^2 t
        for (const piece_size& s : sizes) {
            const double c = s.along_x, d = 1 - c;
            xx += c * c, xy += c * d, yy += d * d, xb += c * s.square, yb += d * s.square;
        }
        const double det = xx * yy - xy * xy, x = (xb * yy - yb * xy) / det, y = (yb * xx - xb * xy) / det;
        out.axis = !(det > 1e-6 * xx * yy)    ? 2
                   : x > 4 * std::max(y, 0.0) ? 0
                   : y > 4 * std::max(x, 0.0) ? 1
                                              : 2;
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

} // namespace quadrant::inline v0::diagnosis::detail
