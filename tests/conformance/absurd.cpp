// SPDX-License-Identifier: BSL-1.0
// Parameters that are finite and that no machine has: a block refuses them with block, field, value and rule,
// or it computes with them. What its number type cannot hold does not become a zero or an infinity inside.
#include "blocks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>

using namespace conformance;

namespace {
/// "block.field = 1e-320 kg: must ...", or a design's words: "discretize.denominator = 1: has a pole ...".
bool is_of_the_house(const std::string& message) {
    const std::size_t dot = message.find('.'), equals = message.find(" = "), colon = message.find(": ");
    return dot != message.npos && dot < equals && equals < colon && colon + 2 < message.size();
}
/// A block with its parameter i replaced; none where it is refused, and then `why` is the message.
template <class Real, class Entry>
auto with(const Entry& e, std::size_t i, double x, std::string& why)
    -> std::optional<decltype(e(values<Real>{}))> {
    try {
        return e(values<Real>{.replaced = i, .by = x});
    } catch (const invalid_parameter& refused) {
        why = refused.what();
        return {};
    }
}
template <class Real> void holds_or_refuses(std::initializer_list<double> sizes) {
    constexpr double largest = double(std::numeric_limits<Real>::max());
    std::size_t refusals = 0, accepted = 0;
    for_each_block([&](const auto& e) {
        values<Real> counter;
        e.make(counter);
        for (std::size_t i = 0; i < counter.calls; ++i)
            for (const double size : sizes)
                for (const double x : {size, -size}) {
                    CAPTURE(e.name);
                    CAPTURE(i);
                    CAPTURE(x);
                    std::string why;
                    auto block = with<Real>(e, i, x, why);
                    if (!block) {
                        ++refusals;
                        CAPTURE(why);
                        CHECK(is_of_the_house(why));
                        continue;
                    }
                    ++accepted;
                    using in = input_of<std::remove_reference_t<decltype(*block)>, Real>;
                    for (int k = 0; k < 50; ++k) one_sample(*block, in());
                    CHECK_FALSE(block->faulted()); // nothing inside is infinite: 0 times that is a NaN
                    // Neither at work, where what comes out is not beyond all numbers.
                    noise input(7);
                    double most = 0;
                    bool held = true;
                    for (int k = 0; k < 100; ++k) {
                        const double u = input(e.amplitude) * std::min(1.0, 1 / size);
                        const double y = double(one_sample(*block, in::from_value(Real(u))).value());
                        held = held && finite(y);
                        most = std::max(most, std::abs(y));
                    }
                    CHECK(held);
                    const double reached = most * std::max(size, 1 / size); // in one sample more
                    if constexpr (!requires { block->range(); })            // which says beyond what it holds
                        CHECK((!block->faulted() || reached > 1e-9 * largest));
                }
    });
    if (std::tuple_size_v<decltype(blocks)> < 10) return; // one.py: a few blocks may have no parameter
    CHECK(refusals > 100);                                // both kinds were tried
    CHECK(accepted > 100);
}
} // namespace

TEST_CASE("every block: an absurd parameter is refused by name or held, in double") {
    holds_or_refuses<double>({1e-320, 1e-300, 1e-150, 1e150, 1e300});
}
TEST_CASE("every block: an absurd parameter is refused by name or held, in float") {
    holds_or_refuses<float>({1e-320, 1e-42, 1e-37, 1e-20, 1e20, 1e37, 1e40, 1e300});
}
