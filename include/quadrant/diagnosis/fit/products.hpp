// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/lanes.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0::diagnosis {

/// Signals of which the sums of products over blocks of rows are asked for.
struct products_input {
    const double* const* signal = nullptr; ///< each holds all rows
    std::size_t signals = 0;
    std::size_t from = 0; ///< the first signal whose products with itself and all before it are asked for
    const std::size_t* first_of =
        nullptr;                      ///< row at which each block begins; null: they lie one behind the other
    std::size_t blocks = 0, rows = 0; ///< of a block
    double* out = nullptr;            ///< of each block a row of `signals` means for each signal from `from` on
};

namespace detail {

/// Sums of the products of one stretch of `a` with four others; four sums at a time keep the adders busy.
template <class Real>
void four_products(const double* a, const std::array<const double*, 4>& b, std::size_t rows,
                   std::array<double, 4>& out) {
    constexpr std::size_t width = lane_count<Real>;
    std::array<Real, 4> sum{};
    std::size_t k = 0;
    for (; k + width <= rows; k += width) {
        const Real x = Real::read(a + k);
        for (std::size_t i = 0; i < 4; ++i) sum[i] += x * Real::read(b[i] + k);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const auto each = sum[i].each();
        out[i] = 0;
        for (const double s : each) out[i] += s;
        for (std::size_t rest = k; rest < rows; ++rest) out[i] += a[rest] * b[i][rest];
    }
}

/// Mean products, block by block, so that what a block needs stays in the nearest cache.
template <class Real> void products(const products_input& in) {
    const double inverse = 1 / static_cast<double>(in.rows);
    double* out = in.out;
    for (std::size_t block = 0; block < in.blocks; ++block) {
        const std::size_t first = in.first_of ? in.first_of[block] : block * in.rows;
        for (std::size_t i = in.from; i < in.signals; ++i, out += in.signals)
            for (std::size_t j = 0; j <= i; j += 4) {
                std::array<const double*, 4> others;
                for (std::size_t l = 0; l < 4; ++l) others[l] = in.signal[j + l <= i ? j + l : i] + first;
                std::array<double, 4> sums;
                four_products<Real>(in.signal[i] + first, others, in.rows, sums);
                for (std::size_t l = 0; l < 4 && j + l <= i; ++l) out[j + l] = sums[l] * inverse;
            }
    }
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
