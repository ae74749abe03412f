// SPDX-License-Identifier: BSL-1.0
// Every block of tests/conformance/blocks.hpp in float and in double: a line "float|notch|bits bits ...",
// outputs in hexadecimal. Run on the host and on the microcontroller; compare.py says how far they are apart.
#include "conformance/blocks.hpp"

#include <bit>
#include <cinttypes>
#include <cstdio>

namespace {
using namespace conformance;

template <class Real, class Block>
void run(const char* number, const char* name, double amplitude, Block block) {
    std::printf("%s|%s|", number, name);
    noise next;
    for (int k = 0; k < 400; ++k) {
        const auto y = block(input_of<Block, Real>::from_value(Real(next(amplitude)))).value();
        if constexpr (sizeof y == 4)
            std::printf("%08" PRIx32 " ", std::bit_cast<std::uint32_t>(y));
        else
            std::printf("%016" PRIx64 " ", std::bit_cast<std::uint64_t>(y));
    }
    std::printf("\n");
}
} // namespace

int main() {
    for_each_block([](const auto& e) {
        run<float>("float", e.name.c_str(), e.amplitude, e(values<float>{}));
        run<double>("double", e.name.c_str(), e.amplitude, e(values<double>{}));
    });
}
