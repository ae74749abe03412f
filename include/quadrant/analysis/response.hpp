// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// Frequency responses: what `margins.hpp`, `loop.hpp` and the designs take.
namespace quadrant::inline v0::analysis {

/// A value of a frequency response, in SI units of output per input.
using complex = std::complex<double>;

/// Any callable from a frequency [Hz] to a complex number: a model, a measured table, or
/// `[&](frequency f) { return block.response(f); }`.
template <class R>
concept frequency_response = requires(const R& r, frequency f) {
    { r(f) } -> std::convertible_to<complex>;
};

/// s = j 2 pi f in rad/s.
inline complex laplace(frequency f) { return {0, 2 * std::numbers::pi * f.value()}; }

/// A frequency from a bare number of hertz.
inline frequency hertz(double f) { return frequency::from_value(f); }
/// 20 log10 of a magnitude.
inline double decibel(double magnitude) { return 20 * std::log10(magnitude); }

/// Where to look, lines spaced evenly in log f. Both ends above 0.
struct band {
    frequency from, to;
    std::size_t per_decade = 400;
};

/// From..to with both ends, `per_decade` lines to a decade. Throws when the band is none.
inline std::vector<frequency> grid(const band& b) {
    require_positive("band.from", b.from);
    require(std::isfinite(b.to.value()) && b.to > b.from, "band.to", b.to,
            "must be finite and above band.from (" + quadrant::detail::shortest(b.from) + ")");
    require(b.per_decade > 0 && b.per_decade <= 1'000'000, "band.per_decade", double(b.per_decade),
            "must lie between 1 and 1000000");
    const double decades = std::log10(b.to.value() / b.from.value());
    const auto steps = std::size_t(std::ceil(decades * double(b.per_decade)));
    std::vector<frequency> lines;
    for (std::size_t i = 0; i < steps; ++i)
        lines.push_back(hertz(b.from.value() * std::pow(10.0, decades * double(i) / double(steps))));
    lines.push_back(b.to);
    return lines;
}

/// A measured response. Between two lines the magnitude is interpolated in log |R| over log f (exact for any
/// power of f), the phase along the shorter way round; so neighbouring lines must lie less than half a turn
/// apart. Outside the lines it throws instead of guessing.
class tabulated_response {
public:
    /// Lines in rising frequency, at least two, all finite and not zero; throws otherwise.
    tabulated_response(std::vector<frequency> lines, std::vector<complex> values)
        : lines_(std::move(lines)), values_(std::move(values)) {
        require(lines_.size() >= 2 && lines_.size() == values_.size(), "tabulated_response.lines",
                double(lines_.size()),
                "must be two or more, and as many as values (" +
                    quadrant::detail::shortest(double(values_.size())) + ")");
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            require(std::isfinite(lines_[i].value()) && lines_[i].value() >= 0 &&
                        (i == 0 || lines_[i] > lines_[i - 1]),
                    "tabulated_response.lines", lines_[i], "must be finite, not negative, and rise");
            const double size = std::abs(values_[i]);
            require(std::isfinite(size) && size > 0, "tabulated_response.values", size,
                    "must be finite and not zero (at " + quadrant::detail::shortest(lines_[i].value()) +
                        " Hz)");
        }
    }

    complex operator()(frequency f) const {
        require(f >= lines_.front() && f <= lines_.back(), "tabulated_response(f)", f,
                "must lie within the lines (" + quadrant::detail::shortest(lines_.front().value()) + " to " +
                    quadrant::detail::shortest(lines_.back().value()) + " Hz)");
        const auto above = std::lower_bound(lines_.begin(), lines_.end(), f);
        const auto i = std::size_t(above - lines_.begin());
        if (*above == f) return values_[i];
        const double low = lines_[i - 1].value(), high = lines_[i].value();
        const double u = low > 0 ? std::log(f.value() / low) / std::log(high / low) : f.value() / high;
        return values_[i - 1] * std::exp(u * std::log(values_[i] / values_[i - 1]));
    }
    const std::vector<frequency>& lines() const noexcept { return lines_; }
    const std::vector<complex>& values() const noexcept { return values_; }
    band all(std::size_t per_decade = 400) const {
        return {lines_.front() > frequency() ? lines_.front() : lines_[1], lines_.back(), per_decade};
    }

private:
    std::vector<frequency> lines_;
    std::vector<complex> values_;
};

} // namespace quadrant::inline v0::analysis
