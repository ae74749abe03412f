// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL gap_rows long_gaps(std::span<const unsigned char> left_out, double response_rows,
                                           std::size_t skip) {
    gap_rows out;
    const std::size_t n = left_out.size();
    for (std::size_t first = 0; first < n;) {
        std::size_t last = first;
        while (last < n && left_out[last]) ++last;
        if (static_cast<double>(last - first) > response_rows) {
            out.gap.resize(n, 0);
            out.settling.resize(n, 0);
            std::fill(out.gap.begin() + static_cast<std::ptrdiff_t>(first),
                      out.gap.begin() + static_cast<std::ptrdiff_t>(last), static_cast<unsigned char>(1));
            std::fill(out.settling.begin() + static_cast<std::ptrdiff_t>(first),
                      out.settling.begin() + static_cast<std::ptrdiff_t>(std::min(n, last + skip)),
                      static_cast<unsigned char>(1));
        }
        first = last + 1;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<std::size_t>
lay_blocks(std::size_t block, std::size_t skip, const std::vector<unsigned char>& settling, std::size_t rows) {
    std::vector<std::size_t> out;
    for (std::size_t first = skip; first + block <= rows;) {
        std::size_t clear = first + block;
        while (!settling.empty() && clear > first && !settling[clear - 1]) --clear;
        if (!settling.empty() && clear > first) {
            first = clear; // behind the last row of it that is not judged
            continue;
        }
        out.push_back(first);
        first += block;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<unsigned char> around(const std::vector<unsigned char>& rows) {
    std::vector<unsigned char> out = rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k]) {
            if (k > 0) out[k - 1] = 1;
            if (k + 1 < rows.size()) out[k + 1] = 1;
        }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
