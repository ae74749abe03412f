// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../../analysis/frf.hpp"
#include "../../fit/fit.hpp"
#include "../../log/signals.hpp"
#include "candidate.hpp"

#include <bit>
#include <numbers>
#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// A tone, or one whose frequency changes evenly: a cos phase + b sin phase + c, the phase
/// 2 pi (frequency t + sweep t^2 / 2), t from the middle of the rows.
struct swept_tone {
    double frequency = 0, sweep = 0, a = 0, b = 0, c = 0, middle = 0;

    double phase(double t) const {
        const double s = t - middle;
        return 2 * std::numbers::pi * (frequency * s + 0.5 * sweep * s * s);
    }
    double at(double t) const { return a * std::cos(phase(t)) + b * std::sin(phase(t)) + c; }
};

class tone_finder {
public:
    explicit tone_finder(const added_signal& s) : s_(s) {
        // Above five times the noise something is added. Before and behind, the signal is at its usual level.
        const double zero = quantile(s.values, 0.5);
        const auto loud = [&](double v) { return std::abs(v - zero) > 5 * s.noise; };
        const auto first = std::find_if(s.values.begin(), s.values.end(), loud);
        const auto last = std::find_if(s.values.rbegin(), s.values.rend(), loud);
        if (first == s.values.end()) return;
        begin_ = static_cast<std::size_t>(first - s.values.begin());
        end_ = static_cast<std::size_t>(s.values.size()) - static_cast<std::size_t>(last - s.values.rbegin());
        usable_ = end_ > begin_ + 32;
    }
    std::optional<waveform_candidate> tone() const {
        if (!usable_) return {};
        swept_tone t;
        t.middle = middle();
        t.frequency = peak(begin_, end_);
        for (int i = 0; i < 6; ++i) refine(t, begin_, end_, false);
        return candidate(t, waveform_form::tone);
    }
    /// From a fit to the middle eighth of the rows to one of all of them, the frequency and its change with
    /// them.
    std::optional<waveform_candidate> chirp() const {
        constexpr std::size_t windows = 8;
        const std::size_t length = (end_ - begin_) / windows;
        if (!usable_ || length < 32) return {};
        double sum_f = 0, slope = 0, size = 0;
        for (std::size_t i = 0; i < windows; ++i) {
            const double f = peak(begin_ + i * length, begin_ + (i + 1) * length),
                         x = static_cast<double>(i) - 3.5;
            sum_f += f;
            slope += f * x;
            size += x * x;
        }
        swept_tone t;
        t.middle = middle();
        t.frequency = sum_f / windows;
        t.sweep = slope / size / (static_cast<double>(length) * s_.period);
        const std::size_t centre = (begin_ + end_) / 2;
        for (const std::size_t part : {8u, 4u, 2u, 1u}) {
            const std::size_t half = (end_ - begin_) / 2 / part;
            for (int i = 0; i < 6; ++i) refine(t, centre - half, centre + half, true);
        }
        return candidate(t, waveform_form::chirp);
    }

private:
    double middle() const { return 0.5 * (s_.time(begin_) + s_.time(end_)); }

    /// Frequency of the largest line of some rows [Hz].
    double peak(std::size_t from, std::size_t to) const {
        double mean = 0;
        for (std::size_t k = from; k < to; ++k) mean += s_.values[k] / static_cast<double>(to - from);
        std::vector<analysis::complex> x(std::bit_ceil(2 * (to - from)));
        for (std::size_t k = from; k < to; ++k) x[k - from] = s_.values[k] - mean;
        analysis::fft(x);
        std::size_t best = 1;
        for (std::size_t i = 2; i < x.size() / 2; ++i)
            if (std::norm(x[i]) > std::norm(x[best])) best = i;
        return static_cast<double>(best) / (static_cast<double>(x.size()) * s_.period);
    }
    /// One Gauss-Newton step on some rows.
    void refine(swept_tone& t, std::size_t from, std::size_t to, bool sweeps) const {
        const Eigen::Index n = sweeps ? 5 : 4;
        const double length = static_cast<double>(to - from) * s_.period; // makes the columns of one size
        Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n), column(n);
        const auto sum = [&](auto fill) {
            h.setZero();
            g.setZero();
            for (std::size_t k = from; k < to; ++k) {
                const double time = s_.time(k), p = t.phase(time), c = std::cos(p), s = std::sin(p);
                fill(time, c, s);
                h += column * column.transpose();
                g += column * (s_.values[k] - t.at(time));
            }
            h.diagonal().array() += 1e-9 * h.diagonal().maxCoeff();
            return solved(h, g);
        };
        column.setZero();
        Eigen::VectorXd step = sum([&](double, double c, double s) { column.head(3) << c, s, 1; });
        t.a += step[0], t.b += step[1], t.c += step[2];
        const double size = std::hypot(t.a, t.b);
        if (!(size > 0)) return;
        step = sum([&](double time, double c, double s) {
            const double x = 2 * std::numbers::pi * (time - t.middle) / length;
            column.head(3) << c, s, 1;
            column[3] = x * (t.b * c - t.a * s) / size;
            if (sweeps) column[4] = 0.5 * x * column[3];
        });
        t.a += step[0], t.b += step[1], t.c += step[2];
        // Never more than half a turn over the rows at once: beyond that the fit is not linear.
        t.frequency += std::clamp(step[3] / size, -0.5, 0.5) / length;
        if (sweeps) t.sweep += 2 * std::numbers::pi * std::clamp(step[4] / size, -0.5, 0.5) / (length * length);
    }
    /// The rows on which it is there: where it begins and ends the sum of squares is least.
    std::pair<std::size_t, std::size_t> rows_of(const swept_tone& t) const {
        const double quarter =
            0.25 / std::max(std::abs(t.frequency), 1 / (static_cast<double>(end_) * s_.period));
        const auto margin = static_cast<std::size_t>(quarter / s_.period) + 1;
        const auto gain = [&](std::size_t k) { // of the tone over nothing
            const double left = s_.values[k] - t.at(s_.time(k)), without = s_.values[k] - t.c;
            return without * without - left * left;
        };
        std::size_t from = begin_, to = end_;
        double best = 0, sum = 0;
        const std::size_t low = begin_ - std::min(begin_, margin),
                          high = std::min(end_ + margin, s_.values.size());
        for (std::size_t k = begin_; k-- > low;)
            if ((sum += gain(k)) > best) best = sum, from = k;
        best = sum = 0;
        for (std::size_t k = end_; k < high; ++k)
            if ((sum += gain(k)) > best) best = sum, to = k + 1;
        return {from, to};
    }
    std::optional<waveform_candidate> candidate(const swept_tone& t, waveform_form form) const {
        const double f0 = t.frequency + t.sweep * (s_.time(begin_) - t.middle),
                     f1 = t.frequency + t.sweep * (s_.time(end_) - t.middle), nyquist = 0.5 / s_.period;
        if (!(f0 > 0 && f1 > 0 && f0 < nyquist && f1 < nyquist)) return {};
        const auto [from, to] = rows_of(t);
        const auto turns = t.frequency * static_cast<double>(to - from) * s_.period;
        if (turns < 2) return {}; // a part of one turn is no tone
        waveform_candidate out;
        out.columns.assign(2, std::vector<double>(s_.values.size(), 0.0));
        for (std::size_t k = from; k < to; ++k) {
            out.columns[0][k] = std::sin(t.phase(s_.time(k)));
            out.columns[1][k] = std::cos(t.phase(s_.time(k)));
        }
        added_waveform& w = out.form;
        w.form = form;
        w.from_s = s_.time(from);
        w.to_s = s_.time(to);
        w.from_start = from == 0;
        w.to_end = to == s_.values.size();
        w.amplitude = std::hypot(t.a, t.b);
        w.frequency_Hz = t.frequency + t.sweep * (w.from_s - t.middle);
        w.sweep_Hz_per_s = t.sweep;
        w.phase_rad = std::remainder(std::atan2(t.a, t.b) + t.phase(w.from_s), 2 * std::numbers::pi);
        out.numbers =
            (form == waveform_form::chirp ? 2u : 1u) + (w.from_start ? 0u : 1u) + (w.to_end ? 0u : 1u);
        return out;
    }

    const added_signal& s_;
    std::size_t begin_ = 0, end_ = 0;
    bool usable_ = false;
};

} // namespace quadrant::inline v0::diagnosis::detail
