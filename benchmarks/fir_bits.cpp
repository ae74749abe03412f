// SPDX-License-Identifier: BSL-1.0
// usage: fir_bits     fails unless the sum of a FIR filter has the bits of four plain sums, however this file
//                     was compiled without fused products; callgrind.sh does with AVX, where clang++ names the
//                     register
#include <quadrant/base/signal.hpp>
#include <quadrant/memory/fir.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <type_traits>

namespace {
using namespace quadrant;

template <std::size_t Taps, class Value> int differ(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    const auto next = [&] { return any(random) * std::exp2(20 * any(random)); };
    detail::fir_taps<double, Taps> taps;
    constexpr std::size_t size = decltype(taps)::size;
    detail::fir_window<Value, size> window;
    for (std::size_t i = 0; i < Taps; ++i) taps[i] = next();
    int different = 0;
    for (int k = 0; k < 5000; ++k) {
        const double x = next();
        if constexpr (std::is_same_v<Value, double>)
            window.put(x);
        else
            window.put(Value::from_value(x));
        double s[4] = {};
        for (std::size_t i = 0; i < size; i += 4)
            for (std::size_t j = 0; j < 4; ++j)
                s[j] += taps[size - 1 - i - j] * detail::bare(window.oldest()[i + j]);
        const double plain = (s[0] + s[2]) + (s[1] + s[3]), sum = detail::bare(taps(window.oldest()));
        different += std::bit_cast<std::uint64_t>(plain) != std::bit_cast<std::uint64_t>(sum);
        window.advance();
    }
    return different;
}
} // namespace

int main() {
    std::mt19937 random(1);
    using length = quantity_of<signal::position, double>;
    const int different = differ<4, double>(random) + differ<61, double>(random) + differ<90, double>(random) +
                          differ<5, length>(random) + differ<61, length>(random) + differ<90, length>(random);
    if (different != 0) std::fprintf(stderr, "%d of 30000 sums of a FIR filter have other bits\n", different);
    return different != 0;
}
