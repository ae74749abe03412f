// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/units.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quadrant::inline v0 {

/// The angle of something that turns at constant speed, sampled for days: counted in 2^-64 of a turn in an
/// integer that wraps by itself, so that nothing drifts, nothing grows and whole turns are exact.
/// An increment is off by at most 2^-65 of a turn: 1e-10 of a turn after 100 years at 2 kHz.
class turning_phase {
public:
    turning_phase() = default;
    turning_phase(frequency speed, duration period)
        : speed_(speed),
          step_(counts(static_cast<long double>(speed.value()) * static_cast<long double>(period.value()))) {}

    /// Counts in the fraction of so many turns.
    static std::uint64_t counts(long double turns) noexcept {
        const long double whole = std::ldexp(1.0L, 64);
        const long double scaled = std::round((turns - std::floor(turns)) * whole);
        return scaled < whole ? static_cast<std::uint64_t>(scaled) : 0;
    }
    /// Radians in -pi ... pi of a count.
    static double angle(std::uint64_t count) noexcept {
        constexpr double radians = std::numbers::pi / 9223372036854775808.0; // 2 pi / 2^64
        return static_cast<double>(static_cast<std::int64_t>(count)) * radians;
    }
    double angle() const noexcept { return angle(at_); }
    std::uint64_t count() const noexcept { return at_; }
    std::uint64_t increment() const noexcept { return step_; } ///< counts per sample
    void advance() noexcept { at_ += step_; }
    /// Where it is t after it was at zero.
    void settle(duration t) noexcept {
        at_ = counts(static_cast<long double>(speed_.value()) * static_cast<long double>(t.value()));
    }

private:
    frequency speed_{};
    std::uint64_t at_ = 0, step_ = 0;
};

} // namespace quadrant::inline v0
