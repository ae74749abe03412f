// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "finite_bits.hpp"
#include "portable.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// A number as text, for messages.
namespace quadrant::inline v0::detail {

#ifdef __cpp_exceptions
/// The shortest text that reads back as the same number.
template <class Isa = isa::here> number_text digits(double x) {
#    ifdef __cpp_lib_to_chars
    number_text out;
    std::to_chars(out.text.data(), out.text.data() + out.text.size() - 1, x);
    return out;
#    else
    return shortest_digits<Isa>(x);
#    endif
}
#else
/// Nine significant digits at most, without the standard library, whose to_chars brings in an unwinder and
/// files.
template <class Isa = isa::here> number_text digits(double x) {
    number_text out;
    char* at = out.text.data();
    const auto word = [&](const char* w) {
        while (*w != '\0') *at++ = *w++;
        return out;
    };
    if (is_nan(x)) return word("nan");
    if (bits_as<std::uint64_t>(x) >> 63 != 0) *at++ = '-', x = -x;
    if (x == 0) return word("0");
    if (!is_finite(x)) return word("inf");
    int exponent = 0;
    for (; x >= 10; ++exponent) x /= 10;
    for (; x < 1; --exponent) x *= 10;
    auto rounded = static_cast<std::uint32_t>(std::lround(x * 1e8));
    if (rounded == 1'000'000'000) rounded /= 10, ++exponent;
    std::array<char, 9> digit{};
    for (int i = 8; i >= 0; --i, rounded /= 10) digit[std::size_t(i)] = char('0' + rounded % 10);
    int count = 9;
    while (count > 1 && digit[std::size_t(count - 1)] == '0') --count;
    const bool power = exponent < -4 || exponent >= 9;
    const int point = power ? 0 : exponent; // the digit that the point follows
    if (point < 0) word("0.");
    for (int i = point; i < -1; ++i) *at++ = '0';
    for (int i = 0; i < count || i <= point; ++i) {
        if (i > 0 && i == point + 1) *at++ = '.';
        *at++ = i < count ? digit[std::size_t(i)] : '0';
    }
    if (!power) return out;
    word(exponent < 0 ? "e-" : "e+");
    const int size = exponent < 0 ? -exponent : exponent;
    if (size >= 100) *at++ = char('0' + size / 100);
    *at++ = char('0' + size / 10 % 10);
    *at++ = char('0' + size % 10);
    return out;
}
#endif

} // namespace quadrant::inline v0::detail
