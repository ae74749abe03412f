// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

/// Repeatable numbers for what is claimed over a million trials: so many with `all`, a tenth of it by default.
namespace stated {

inline const int trials = [] {
    const char* const tests = std::getenv("QUADRANT_TESTS");
    return tests && std::string_view(tests) == "all" ? 1'000'000 : 100'000;
}();

class dice {
public:
    std::uint64_t bits() {
        x_ = x_ * 6364136223846793005u + 1442695040888963407u;
        return x_ ^ (x_ >> 29);
    }
    double operator()(double low, double high) { return low + (high - low) * (double(bits() >> 11) * 0x1p-53); }
    double decades(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
    double any_number() { return std::bit_cast<double>(bits()); } ///< of any size, also infinite, also none
    bool often() { return bits() >> 62 != 0; }

private:
    std::uint64_t x_ = 20080615;
};

} // namespace stated
