// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Radix-2 FFT in place, sum x[n] e^{-j 2 pi n k / size}; the size must be a power of two.
inline void fft(std::vector<complex>& x) {
    const std::size_t n = x.size();
    require(n >= 2 && (n & (n - 1)) == 0, "fft.size", double(n), "must be a power of two, 2 or more");
    for (std::size_t i = 1, j = 0; i < n; ++i) { // bit reversal
        std::size_t bit = n / 2;
        for (; j & bit; bit /= 2) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(x[i], x[j]);
    }
    std::vector<complex> turns(n / 2); // of every stage: a shorter one takes every other of them, or fewer
    for (std::size_t k = 0; k < n / 2; ++k)
        turns[k] = std::polar(1.0, -2 * std::numbers::pi / double(n) * double(k));
    for (std::size_t width = 2, apart = n / 2; width <= n; width *= 2, apart /= 2)
        for (std::size_t i = 0; i < n; i += width)
            for (std::size_t k = 0; k < width / 2; ++k) {
                const complex turn = turns[k * apart], even = x[i + k], odd = x[i + k + width / 2];
                const complex w{turn.real() * odd.real() - turn.imag() * odd.imag(),
                                turn.real() * odd.imag() + turn.imag() * odd.real()};
                x[i + k] = even + w;
                x[i + k + width / 2] = even - w;
            }
}

/// A measured response with what is known about its error.
struct measured_frf {
    /// The response at one frequency, and how far it can be trusted there.
    struct line {
        frequency f;
        complex value;    ///< H1, SI units of out per in
        double coherence; ///< 0 ... 1
        double spread;    ///< standard deviation of value over |value|, each of real and imaginary part
    };
    std::vector<line> lines; ///< rising; without standstill; without those where the input was silent
    std::size_t averages = 0;

    /// The lines of a band with enough coherence, as a response; throws when fewer than two are left.
    tabulated_response response(frequency from, frequency to, double least_coherence = 0) const {
        std::vector<frequency> f;
        std::vector<complex> value;
        for (const line& each : lines)
            if (each.f >= from && each.f <= to && each.coherence >= least_coherence && each.value != 0.0)
                f.push_back(each.f), value.push_back(each.value);
        return {std::move(f), std::move(value)};
    }
    tabulated_response response() const { return response(frequency(), hertz(1e300)); }
};

enum class window { hann, none }; ///< none: only when the excitation repeats with the window
enum class trend { keep, mean, line };

/// Frequency response from two logged wires, while they are logged: H1 = Sxy/Sxx over windows that overlap.
///   coherence = |Sxy|^2/(Sxx Syy);   spread = sqrt((1 - coherence)/(2 coherence averages))
/// Source: [Jamaludin2008] ch. 2 (H1, Hann, 2048 samples at 2 kHz); the spread is that of
/// Bendat and Piersol, Random Data, ch. 9, with Welch's count of windows that overlap.
/// H1 is right when noise is on the output only. In a closed loop noise on the output comes back through the
/// input and
/// H1 is biased: measure both wires against the injected excitation and divide, `ratio`.
/// `add` takes one sample of each wire and allocates nothing. A bad sample (not finite) drops the window that
/// it is in.
template <signal_tag In, signal_tag Out> class frf {
public:
    /// Length of a window: its resolution is the sampling rate / samples. How windows overlap, are weighed and
    /// freed of a trend.
    struct parameters {
        std::size_t samples = 2048; ///< of a window, a power of two, 8 or more
        double overlap = 0.5;       ///< 0 ... 0.9 of the window
        window shape = window::hann;
        trend remove = trend::mean; ///< of every window
    };
    frf(const parameters& p, duration period)
        : given_(p), period_(period), x_(p.samples), y_(p.samples), work_(p.samples), shape_(p.samples),
          sums_(p.samples / 2 + 1) {
        require_positive("frf.period", period);
        require(p.samples >= 8 && (p.samples & (p.samples - 1)) == 0, "frf.samples", double(p.samples),
                "must be a power of two, 8 or more");
        require(p.overlap >= 0 && p.overlap <= 0.9, "frf.overlap", p.overlap, "must lie between 0 and 0.9");
        hop_ = std::max<std::size_t>(1, std::size_t(std::lround(double(p.samples) * (1 - p.overlap))));
        for (std::size_t n = 0; n < p.samples; ++n)
            shape_[n] = p.shape == window::none
                            ? 1
                            : 0.5 * (1 - std::cos(2 * std::numbers::pi * double(n) / double(p.samples)));
    }

    void add(quantity_of<In> x, quantity_of<Out> y) {
        if (!std::isfinite(x.value()) || !std::isfinite(y.value())) {
            held_ = 0;
            return;
        }
        x_[held_] = x.value(), y_[held_] = y.value();
        if (++held_ < given_.samples) return;
        take();
        std::copy(x_.begin() + std::ptrdiff_t(hop_), x_.end(), x_.begin());
        std::copy(y_.begin() + std::ptrdiff_t(hop_), y_.end(), y_.begin());
        held_ = given_.samples - hop_;
    }
    void reset() {
        held_ = windows_ = 0;
        std::fill(sums_.begin(), sums_.end(), sum{});
    }

    std::size_t windows() const noexcept { return windows_; }
    /// Throws before the first whole window.
    measured_frf result() const {
        require(windows_ > 0, "frf.windows", 0.0,
                "must be one or more: log at least " + quadrant::detail::shortest(double(given_.samples)) +
                    " samples without a gap");
        measured_frf out{{}, windows_};
        double loudest = 0;
        for (const sum& s : sums_) loudest = std::max(loudest, s.xx);
        const double averages = effective();
        for (std::size_t k = 1; k < sums_.size(); ++k) {
            const sum& s = sums_[k];
            if (!(s.xx > 1e-24 * loudest)) continue; // nothing was put in at this line
            const double coherence = s.yy > 0 ? std::min(1.0, std::norm(s.xy) / (s.xx * s.yy)) : 0;
            const double spread =
                coherence > 0 ? std::sqrt((1 - coherence) / (2 * coherence * averages)) : HUGE_VAL;
            out.lines.push_back({hertz(double(k) / (double(given_.samples) * period_.value())), s.xy / s.xx,
                                 coherence, spread});
        }
        return out;
    }

private:
    struct sum {
        double xx = 0, yy = 0;
        complex xy = 0;
    };
    void level(std::vector<double>& from, bool imaginary) {
        const double n = double(given_.samples), middle = 0.5 * (n - 1);
        double mean = 0, slope = 0;
        if (given_.remove != trend::keep)
            for (const double each : from) mean += each / n;
        if (given_.remove == trend::line) {
            for (std::size_t i = 0; i < from.size(); ++i) slope += (double(i) - middle) * (from[i] - mean);
            slope /= n * (n * n - 1) / 12;
        }
        for (std::size_t i = 0; i < from.size(); ++i) {
            const double value = shape_[i] * (from[i] - mean - slope * (double(i) - middle));
            imaginary ? work_[i].imag(value) : work_[i].real(value);
        }
    }
    void take() {
        level(x_, false), level(y_, true); // both in one transform: x is its even part, y its odd one
        fft(work_);
        for (std::size_t k = 0; k < sums_.size(); ++k) {
            const complex a = work_[k], b = std::conj(work_[k == 0 ? 0 : given_.samples - k]);
            const complex x = 0.5 * (a + b), y = complex(0, -0.5) * (a - b);
            sums_[k].xx += std::norm(x);
            sums_[k].yy += std::norm(y);
            sums_[k].xy += std::conj(x) * y;
        }
        ++windows_;
    }
    /// Windows that share samples are not independent: Welch's sum of squared correlations.
    double effective() const {
        double own = 0, shared = 1;
        for (const double w : shape_) own += w * w;
        for (std::size_t lag = hop_, i = 1; lag < given_.samples && i < windows_; lag += hop_, ++i) {
            double with = 0;
            for (std::size_t n = lag; n < given_.samples; ++n) with += shape_[n] * shape_[n - lag];
            shared += 2 * (1 - double(i) / double(windows_)) * (with / own) * (with / own);
        }
        return double(windows_) / shared;
    }

    parameters given_;
    duration period_;
    std::vector<double> x_, y_;
    std::vector<complex> work_;
    std::vector<double> shape_;
    std::vector<sum> sums_;
    std::size_t hop_ = 1, held_ = 0, windows_ = 0;
};

/// Response from one wire to another in a closed loop, both measured against the same excitation: over / under.
/// The two must have the same lines. Its coherence is the lower one, its spread both (as if independent).
inline measured_frf ratio(const measured_frf& over, const measured_frf& under) {
    require(over.lines.size() == under.lines.size(), "ratio.lines", double(over.lines.size()),
            "must be those of the other response (" + quadrant::detail::shortest(double(under.lines.size())) +
                ")");
    measured_frf out{{}, std::min(over.averages, under.averages)};
    for (std::size_t i = 0; i < over.lines.size(); ++i) {
        const auto &a = over.lines[i], &b = under.lines[i];
        require(a.f == b.f, "ratio.lines", a.f, "must be those of the other response");
        out.lines.push_back(
            {a.f, a.value / b.value, std::min(a.coherence, b.coherence), std::hypot(a.spread, b.spread)});
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
