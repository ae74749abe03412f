// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "math.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// Cosine and sine of an angle given in turns.
template <class Real> struct on_circle { Real cosine, sine; };

/// cos(2 pi t) and sin(2 pi t) in lanes for |t| <= 4: the nearest quarter turn is taken off exactly, and the
/// rest, at most an eighth of a turn, goes through the polynomials of Cephes' sin and cos (S. Moshier, netlib).
/// One reduction and no
/// multiplication by pi before it: within 2e-16 of the true values, and the same on every instruction set.
/// Found by its argument's namespace, so that what uses it needs no include of lanes.
template <std::size_t W, class Isa> on_circle<lanes<W, Isa>> circle_of_turns(const lanes<W, Isa>& t) noexcept {
    using number = lanes<W, Isa>;
    const number quarters = floor(number(4) * t + number(0.5));
    const number x = (t - number(0.25) * quarters) * number(6.283185307179586), z = x * x, z2 = z * z;
    // In pairs of terms, so that no multiplication waits for all of those before it.
    const auto pair = [&z](double low, double high) { return number(low) + z * number(high); };
    number s = (pair(-1.66666666666666307295e-1, 8.33333333332211858878e-3) +
                z2 * pair(-1.98412698295895385996e-4, 2.75573136213857245213e-6)) +
               (z2 * z2) * pair(-2.50507477628578072866e-8, 1.58962301576546568060e-10);
    s = x + x * z * s;
    number c = (pair(4.16666666666665929218e-2, -1.38888888888730564116e-3) +
                z2 * pair(2.48015872888517045348e-5, -2.75573141792967388112e-7)) +
               (z2 * z2) * pair(2.08757008419747316778e-9, -1.13585365213876817300e-11);
    c = number(1) - number(0.5) * z + z2 * c;
    // Quarter turns: (c, s), (-s, c), (-c, -s), (s, -c).
    const number quarter = quarters - number(4) * floor(number(0.25) * quarters);
    const auto odd = either(equal(quarter, number(1)), equal(quarter, number(3)));
    const number cosine = select(odd, s, c), sine = select(odd, c, s);
    const auto cosine_turned = either(equal(quarter, number(1)), equal(quarter, number(2)));
    const auto sine_turned = greater_equal(quarter, number(2));
    return {select(cosine_turned, -cosine, cosine), select(sine_turned, -sine, sine)};
}

} // namespace quadrant::inline v0
