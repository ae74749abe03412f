// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::analysis {

/// One crossing of the open loop, and what is left there.
struct margin {
    double value; ///< gain margin in dB (below 0: the gain must rise to come back), phase margin in degrees
    frequency at;
};

/// How far an open loop L is from -1 in a band.
///   gain margin  -20 log10 |L| where L crosses the negative real axis
///   phase margin 180 deg + arg L where |L| crosses one, in (-180, 180]
///   modulus margin  min |1 + L| = 1 / max |S|
/// Source: [Jamaludin2008] ch. 2; [Astrom1995] ch. 4 (sensitivity).
/// All crossings are kept, in rising frequency; the margin usually quoted is the first. Margins speak of
/// stability only for a loop that is stable when closed; they do not prove it.
struct stability_margins {
    band searched;
    std::vector<margin> gain_crossings;  ///< gain margins: one for each phase of -180 degrees (mod 360)
    std::vector<margin> phase_crossings; ///< phase margins: one for each |L| = 1
    margin modulus;                      ///< value: min |1 + L|, as a number

    std::optional<margin> gain() const { return first(gain_crossings); }
    std::optional<margin> phase() const { return first(phase_crossings); }
    /// The one nearest to -1, when there are several.
    std::optional<margin> smallest_gain() const { return smallest(gain_crossings); }
    std::optional<margin> smallest_phase() const { return smallest(phase_crossings); }

    /// One line per margin; says "none" and why.
    std::string text() const {
        const std::string where = " between " + quadrant::detail::shortest(searched.from.value()) + " and " +
                                  quadrant::detail::shortest(searched.to.value()) + " Hz\n";
        const auto line = [&](const char* name, const char* unit, const std::vector<margin>& all,
                              const char* absent) {
            std::string out = name;
            if (all.empty()) return out + ": none, " + absent + where;
            for (std::size_t i = 0; i < all.size(); ++i)
                out += (i == 0 ? ": " : "; ") + digits(all[i].value) + unit + " at " +
                       digits(all[i].at.value()) + " Hz";
            return out + "\n";
        };
        return line("gain margin", " dB", gain_crossings, "the phase does not pass -180 degrees") +
               line("phase margin", " deg", phase_crossings, "the gain does not pass one") +
               "modulus margin: " + digits(modulus.value) + " at " + digits(modulus.at.value()) + " Hz\n";
    }

private:
    static std::string digits(double x) { return quadrant::detail::shortest(std::round(x * 1000) / 1000); }
    static std::optional<margin> first(const std::vector<margin>& all) {
        if (all.empty()) return std::nullopt;
        return all.front();
    }
    static std::optional<margin> smallest(const std::vector<margin>& all) {
        const auto least = std::min_element(all.begin(), all.end(), [](const margin& a, const margin& b) {
            return std::abs(a.value) < std::abs(b.value);
        });
        if (least == all.end()) return std::nullopt;
        return *least;
    }
};

namespace detail {
inline double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// A response on a log grid, made denser where it turns more than 30 degrees or grows by more than 1.5 from
/// line to line (a lightly damped mode between two lines), six halvings deep.
struct sampled {
    frequency f;
    complex value;
};
template <frequency_response R> std::vector<sampled> sample(const R& r, const band& b) {
    const auto at = [&](frequency f) {
        const complex value = r(f);
        require(std::isfinite(value.real()) && std::isfinite(value.imag()), "response at f", f,
                "must be finite in the whole band");
        return sampled{f, value};
    };
    std::vector<sampled> out;
    const auto between = [&](auto&& self, const sampled& low, const sampled& high, int depth) -> void {
        const double size = std::abs(low.value) * std::abs(high.value);
        const complex turn = high.value * std::conj(low.value);
        const double ratio = std::abs(high.value) / std::abs(low.value);
        if (depth < 6 && size > 0 && (turn.real() < 0.866 * size || ratio > 1.5 || ratio < 1 / 1.5)) {
            const sampled middle = at(hertz(std::sqrt(low.f.value() * high.f.value())));
            self(self, low, middle, depth + 1);
            self(self, middle, high, depth + 1);
        } else {
            out.push_back(high);
        }
    };
    const auto lines = grid(b);
    sampled last = at(lines.front());
    out.push_back(last);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const sampled next = at(lines[i]);
        between(between, last, next, 0);
        last = next;
    }
    return out;
}

/// The f between low and high where `sign` changes; to rounding.
template <class Sign> frequency bisect(const Sign& sign, frequency low, frequency high) {
    const bool start = sign(low);
    for (int i = 0; i < 60; ++i) {
        const frequency middle = 0.5 * (low + high);
        (sign(middle) == start ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Least of `size` around sample i, by golden section between its neighbours.
template <class Size> frequency least_near(const Size& size, const std::vector<sampled>& all, std::size_t i) {
    constexpr double golden = 0.6180339887498949;
    frequency low = all[i == 0 ? 0 : i - 1].f, high = all[std::min(i + 1, all.size() - 1)].f;
    for (int n = 0; n < 60; ++n) {
        const frequency a = high - golden * (high - low), b = low + golden * (high - low);
        if (size(a) < size(b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}
} // namespace detail

/// Margins of an open loop. A zero or an undamped pole of L turns its phase by a jump: that is no crossing.
/// Cost: some 400 responses a decade and 60 a crossing. Throws when the band is none or L is not finite in it.
template <frequency_response Loop> stability_margins margins(const Loop& loop, const band& b) {
    const auto all = detail::sample(loop, b);
    stability_margins out{b, {}, {}, {}};
    const auto below = [&](frequency f) { return std::imag(complex(loop(f))) < 0; };
    const auto strong = [&](frequency f) { return std::abs(complex(loop(f))) >= 1; };
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (std::abs(1.0 + all[i].value) < std::abs(1.0 + all[nearest].value)) nearest = i;
        if (i == 0) continue;
        const frequency low = all[i - 1].f, high = all[i].f;
        if ((all[i - 1].value.imag() < 0) != (all[i].value.imag() < 0)) {
            const frequency f = detail::bisect(below, low, high);
            // Through the origin or infinity the sign changes too: seen close by, the two sides are then
            // opposed.
            const double apart = std::max(1e-9 * f.value(), 1e-6 * (high - low).value());
            const complex before = loop(hertz(std::max(f.value() - apart, b.from.value()))),
                          after = loop(hertz(std::min(f.value() + apart, b.to.value())));
            if (before.real() < 0 && after.real() < 0)
                out.gain_crossings.push_back({-decibel(std::abs(complex(loop(f)))), f});
        }
        if ((std::abs(all[i - 1].value) >= 1) != (std::abs(all[i].value) >= 1)) {
            const frequency f = detail::bisect(strong, low, high);
            out.phase_crossings.push_back({detail::degrees(std::arg(-complex(loop(f)))), f});
        }
    }
    const frequency f =
        detail::least_near([&](frequency at) { return std::abs(1.0 + complex(loop(at))); }, all, nearest);
    out.modulus = {std::abs(1.0 + complex(loop(f))), f};
    return out;
}

/// Every frequency where |R| crosses `level` while rising (from below), in rising order.
template <frequency_response R>
std::vector<frequency> rising_crossings(const R& r, double level, const band& b) {
    require_positive("rising_crossings.level", level);
    const auto all = detail::sample(r, b);
    std::vector<frequency> out;
    const auto high = [&](frequency f) { return std::abs(complex(r(f))) >= level; };
    for (std::size_t i = 1; i < all.size(); ++i)
        if (std::abs(all[i - 1].value) < level && std::abs(all[i].value) >= level)
            out.push_back(detail::bisect(high, all[i - 1].f, all[i].f));
    return out;
}

/// Bandwidth: the first frequency where a sensitivity comes up through -3 dB (1 / sqrt 2) from below; none when
/// it lies above already where the band begins, or never reaches it. Which S is meant is the caller's choice:
/// the bandwidths of [Jamaludin2008] are those of eq. (2.33), `loop.hpp` sensitivity().
template <frequency_response Sensitivity>
std::optional<frequency> sensitivity_bandwidth(const Sensitivity& s, const band& b) {
    const auto all = rising_crossings(s, std::numbers::sqrt2 / 2, b);
    if (all.empty()) return std::nullopt;
    if (std::abs(complex(s(b.from))) >= std::numbers::sqrt2 / 2) return std::nullopt;
    return all.front();
}

/// The least |R| of a band and where: minimum dynamic stiffness.
template <frequency_response R> margin least(const R& r, const band& b) {
    const auto all = detail::sample(r, b);
    std::size_t i = 0;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (std::abs(all[k].value) < std::abs(all[i].value)) i = k;
    const frequency f = detail::least_near([&](frequency at) { return std::abs(complex(r(at))); }, all, i);
    return {std::abs(complex(r(f))), f};
}

} // namespace quadrant::inline v0::analysis
