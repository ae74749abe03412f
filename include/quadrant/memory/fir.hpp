// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

/// What a FIR filter of many taps is made of so that compilers use SIMD without being asked: inputs side by
/// side, several sums that do not wait for each other.
namespace quadrant::inline v0::detail {

#if defined(__AVX__) && defined(__clang__)
/// The four sums in one register, by name: left to itself clang++ 14 puts two into each of two registers, and
/// takes twice as many instructions. g++ takes one by itself, and more instructions where it is named.
using four_sums [[gnu::vector_size(32)]] = double;
#endif

/// The last Size inputs, oldest first and never wrapped around: each is written twice, Size apart. Oldest
/// first, so that a sum comes last to what was just written.
template <class Value, std::size_t Size> struct fir_window {
    std::array<Value, 2 * Size> x{};
    std::size_t next = 0; ///< where the coming one goes

    /// Takes the place of the oldest; put again instead of `advance`, the one that was put is forgotten.
    void put(Value newest) noexcept { x[next] = x[next + Size] = newest; }
    void advance() noexcept { next = next + 1 == Size ? 0 : next + 1; }
    const Value* oldest() const noexcept { return &x[next + 1]; } ///< behind a `put`
    const Value& ago(std::size_t samples) const noexcept { return x[next + Size - samples]; }
};

/// Coefficients and their sum over a window. From four taps on as four partial sums: y = ((s0 + s2) + (s1 +
/// s3)), padded in front with zeros. In every number type off by at most (size/4 + 2) half units in the last
/// place of sum |c| |x|, where the plain sum is off by Taps of them.
template <class Real, std::size_t Taps> class fir_taps {
public:
    static constexpr std::size_t sums = Taps < 4 ? 1 : 4;
    static constexpr std::size_t size = (Taps + sums - 1) / sums * sums; ///< of the window

    /// [0] is of the newest.
    constexpr Real& operator[](std::size_t tap) noexcept { return c_[size - 1 - tap]; }
    constexpr const Real& operator[](std::size_t tap) const noexcept { return c_[size - 1 - tap]; }

    template <class Value> constexpr Value operator()(const Value* oldest) const noexcept {
        Value s0{};
        if constexpr (sums == 1) {
            for (std::size_t i = 0; i < size; ++i) s0 += c_[i] * oldest[i];
            return s0;
        }
#if defined(__AVX__) && defined(__clang__)
        else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(bare(s0))>, double> &&
                           std::is_same_v<Real, double>) {
            four_sums s{};
            for (std::size_t i = 0; i < size; i += 4)
                s += four_sums{c_[i], c_[i + 1], c_[i + 2], c_[i + 3]} *
                     four_sums{bare(oldest[i]), bare(oldest[i + 1]), bare(oldest[i + 2]), bare(oldest[i + 3])};
            const double y = (s[0] + s[2]) + (s[1] + s[3]);
            if constexpr (std::is_same_v<Value, double>)
                return y;
            else
                return Value::from_value(y);
        }
#endif
        else { // four lines, not an inner loop: without SIMD (Cortex-M) that would stay a loop
            Value s1{}, s2{}, s3{};
            for (std::size_t i = 0; i < size; i += 4) {
                s0 += c_[i] * oldest[i];
                s1 += c_[i + 1] * oldest[i + 1];
                s2 += c_[i + 2] * oldest[i + 2];
                s3 += c_[i + 3] * oldest[i + 3];
            }
            return (s0 + s2) + (s1 + s3);
        }
    }
    Real sum() const noexcept {
        Real all(0);
        for (const Real& each : c_) all += each;
        return all;
    }

private:
    std::array<Real, size> c_{};
};

} // namespace quadrant::inline v0::detail
