// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "../result/result.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Whether a force that repeats in time does so near a frequency at which the axis itself moves, with a tenth
/// of the energy of its velocity or more: then it may be any force of the motion.
inline bool repeats_with_the_motion(const axis_record& r, const cause& named) {
    for (const parameter_estimate& p : named.parameters)
        if (p.key == "process.fundamental_Hz") {
            const estimate& f = p.values.front();
            const auto below = [&](double Hz) { return zero_phase(r.velocity, Hz, r.period); };
            auto there = below(1.4 * f.high);
            if (f.low > 0) {
                const auto slower = below(0.7 * f.low);
                for (std::size_t k = 0; k < there.size(); ++k) there[k] -= slower[k];
            }
            return square(rms(there)) > 0.1 * square(rms(r.velocity));
        }
    return false;
}

} // namespace quadrant::inline v0::diagnosis::detail
