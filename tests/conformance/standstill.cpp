// SPDX-License-Identifier: BSL-1.0
// After a rest nothing computes with subnormal numbers: the processor itself says so, by the flags that it
// raises.
#include "blocks.hpp"

#include <doctest/doctest.h>

#include <cfenv>
#include <cmath>
#include <limits>
#ifdef __SSE2__
#    include <xmmintrin.h>
#endif

using namespace conformance;

namespace {
/// Did an operation take or give a subnormal number since `clear`?
struct subnormal_flags {
    static void clear() {
        std::feclearexcept(FE_ALL_EXCEPT);
#ifdef __SSE2__
        _mm_setcsr(_mm_getcsr() & ~0x3fu);
#endif
    }
    static bool raised() {
#ifdef __SSE2__
        return (_mm_getcsr() & 0x12u) != 0; // a subnormal operand, an underflow
#else
        return std::fetestexcept(FE_UNDERFLOW) != 0;
#endif
    }
};

/// 200 samples of noise, then a rest until everything has died out that ever will, then 1000 samples that are
/// watched.
template <class Real> void rests_cleanly(double at) {
    for_each_block([&](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<Real>{});
        using in = input_of<decltype(block), Real>;
        if constexpr (!requires { block.settle(in()); })
            if (at != 0) return; // a plant under a force moves: no rest
        noise input(7);
        for (int k = 0; k < 200; ++k) block(in::from_value(Real(input(e.amplitude))));
        const in rest = in::from_value(Real(at * e.amplitude));
        Real last(0);
        for (int k = 0; k < 60'000; ++k) last = block(rest).value();
        subnormal_flags::clear();
        for (int k = 0; k < 1000; ++k) last = block(rest).value();
        const bool raised = subnormal_flags::raised();
        CHECK_FALSE(raised);
        CHECK_FALSE((last != Real(0) && std::abs(detail::plain(last)) < std::numeric_limits<Real>::min()));
    });
}
} // namespace

TEST_CASE("the flags see a subnormal number when there is one") {
    volatile double x = 1e-300;
    subnormal_flags::clear();
    CHECK_FALSE(subnormal_flags::raised());
    x = x * 1e-10;
    CHECK(subnormal_flags::raised());
}
TEST_CASE_TEMPLATE("every block: after a rest at zero no state is subnormal", Real, double, float) {
    rests_cleanly<Real>(0);
}
TEST_CASE_TEMPLATE("every block: after a rest away from zero no state is subnormal", Real, double, float) {
    rests_cleanly<Real>(0.375);
}
