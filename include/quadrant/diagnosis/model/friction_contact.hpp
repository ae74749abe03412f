// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace quadrant::inline v0::diagnosis {

/// The contact that gives way before it slips: elements in parallel, each a spring that slips at its share of
/// the friction level (Maxwell-slip, [Jamaludin2008] section 3.2). One element is a sticking contact with a
/// little give; four with spread lengths are presliding friction, whose memory of inner loops is Masing's.
struct friction_contact {
    static constexpr std::size_t most = 4;
    std::size_t elements = 1;
    double length =
        0; ///< deflection at which the mean element slips [m], geometric mean; above 0 where friction acts
    double attraction =
        std::numeric_limits<double>::infinity(); ///< C: a spring that slips goes to its share so [N/s]
    double damping = 0; ///< of an element that sticks: force stiffness * damping * velocity, as in LuGre [s]
    double spread = 1;  ///< ratio of the lengths of neighbouring elements
    std::array<double, most> weights{1, 0, 0, 0};    ///< shares of the level
    std::array<double, most> lengths_as_described{}; ///< all above 0: these instead of length and spread

    std::array<double, most> lengths() const {
        if (lengths_as_described[0] > 0) return lengths_as_described;
        std::array<double, most> out{};
        const double middle = 0.5 * (static_cast<double>(elements) - 1);
        for (std::size_t i = 0; i < elements; ++i)
            out[i] = length * std::pow(spread, static_cast<double>(i) - middle);
        return out;
    }
    /// The virgin curve: share of the level after a displacement z from rest.
    double share(double z) const {
        const auto l = lengths();
        double sum = 0;
        for (std::size_t i = 0; i < elements; ++i) sum += weights[i] * std::min(1.0, z / l[i]);
        return sum;
    }
    /// The displacement at which the virgin curve reaches 1 - 1/e of the level: the length of an exponential
    /// (Dahl, LuGre).
    double way_to_63_percent() const {
        constexpr double wanted = 0.6321205588285577;
        double low = 0, high = 0;
        for (double l : lengths()) high = std::max(high, l);
        for (int i = 0; i < 60; ++i) {
            const double z = 0.5 * (low + high);
            (share(z) < wanted ? low : high) = z;
        }
        return 0.5 * (low + high);
    }
    /// Shares and lengths that follow 1 - exp(-z / length): a described length.
    void exponential(double way) {
        elements = most;
        weights.fill(1.0 / static_cast<double>(most));
        spread = 2.2; // the ratio whose four straight pieces lie closest to the exponential
        length = 1;
        length = way / way_to_63_percent();
    }
};

} // namespace quadrant::inline v0::diagnosis
