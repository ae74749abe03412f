// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"

#include <array>
#include <cstddef>

/// An FIR filter of several lanes that step together: its samples and its coefficients.
namespace quadrant::inline v0::detail {

/// The last Size inputs of W lanes as plain numbers, each lane for itself: oldest first and never wrapped
/// around; see `fir_window`.
template <std::size_t W, std::size_t Size> struct lane_window {
    struct alignas(64) ring {
        std::array<double, 2 * Size> x{};
    };
    std::array<ring, W> lane{};
    std::size_t next = 0; ///< where the coming one goes

    template <class Real> void put(const Real& newest) noexcept {
        const std::size_t now = next; // a number may be written anywhere: not read again
        next = now + 1 == Size ? 0 : now + 1;
        scatter(newest, [&](std::size_t i) { return &lane[i].x[now]; });
        scatter(newest, [&](std::size_t i) { return &lane[i].x[now + Size]; });
    }
    template <class Real> void fill(const Real& all) noexcept {
        for (std::size_t k = 0; k < 2 * Size; ++k) scatter(all, [&](std::size_t i) { return &lane[i].x[k]; });
    }
    const double* oldest(std::size_t i) const noexcept { return &lane[i].x[next]; } ///< of the last Size inputs
    template <class Real> Real ago(std::size_t samples) const noexcept {            ///< 1 ... Size
        return gathered<Real>([&](std::size_t i) { return &lane[i].x[next + Size - samples]; });
    }
};

/// FIR coefficients for each lane, and their sum over a window of the samples before and the newest, which
/// never goes through memory. Lanes with the same coefficients load them once. Eight partial sums: off by at
/// most (Size/8 + 4) half units in the last place of sum |c| |x|.
template <class Real, std::size_t Taps> class lane_taps {
    static constexpr std::size_t W = lane_count<Real>, before = Taps - 1;
    using quad = typename Real::template of_width<4>;

public:
    static constexpr std::size_t size = before == 0 ? 8 : (before + 7) / 8 * 8; ///< of the window

    void set(const std::array<Real, Taps>& c) noexcept {
        newest_ = c[0];
        alike_ = true;
        for (std::size_t k = 1; k < Taps; ++k)
            for (std::size_t i = 0; i < W; ++i) {
                c_[i].x[size - k] = c[k][i];
                alike_ = alike_ && c[k][i] == c[k][0];
            }
    }
    bool alike() const noexcept { return alike_; } ///< all lanes have the coefficients of the first
    /// The sum for lanes that are alike.
    [[gnu::always_inline]] Real alike(const lane_window<W, size>& window, const Real& newest) const noexcept {
        if constexpr (before == 0) return newest_ * newest;
        return over<true>(window) + newest_ * newest;
    }
    /// For any lanes. Apart, so that a compiler does not weave both into one.
    [[gnu::noinline]] Real each(const lane_window<W, size>& window, const Real& newest) const noexcept {
        if constexpr (before == 0) return newest_ * newest;
        return over<false>(window) + newest_ * newest;
    }
    Real sum() const noexcept {
        Real all = newest_;
        for (std::size_t i = 0; i < W; ++i) {
            double one = 0;
            for (const double c : c_[i].x) one += c;
            all.set(i, all[i] + one);
        }
        return all;
    }

private:
    template <bool Alike> [[gnu::always_inline]] Real over(const lane_window<W, size>& window) const noexcept {
        std::array<quad, W> even{}, odd{};
        std::array<const double*, W> x;
        for (std::size_t i = 0; i < W; ++i) x[i] = window.oldest(i);
#pragma GCC unroll 16
        for (std::size_t k = 0; k < size; k += 8) {
            quad c = quad::read(&c_[0].x[k]), d = quad::read(&c_[0].x[k + 4]);
            for (std::size_t i = 0; i < W; ++i) {
                if (!Alike && i > 0) c = quad::read(&c_[i].x[k]), d = quad::read(&c_[i].x[k + 4]);
                even[i] += c * quad::read(x[i] + k);
                odd[i] += d * quad::read(x[i] + k + 4);
            }
        }
        for (std::size_t i = 0; i < W; ++i) even[i] += odd[i];
        return row_sums<Real>(even);
    }

    struct alignas(64) row {
        std::array<double, size> x{};
    };
    Real newest_{};
    std::array<row, W> c_{};
    bool alike_ = true;
};

} // namespace quadrant::inline v0::detail
