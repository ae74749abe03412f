// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "lanes/instruction_set.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <type_traits>
#include <version>
#ifdef __cpp_exceptions
#    include <charconv>
#    include <string>
#endif

/// What a C++20 library may lack (libc++ 13, as emscripten 3.1.6 has it), in one place. Each function does what
/// the standard one does; where that exists, it is used, and tests compare the two.
namespace quadrant::inline v0::detail {

/// Whether threads can be started: not in WebAssembly, unless it was built for threads.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool has_threads = false;
#else
inline constexpr bool has_threads = true;
#endif

/// std::bit_cast.
template <class To, class From>
requires(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
         std::is_trivially_copyable_v<From>) constexpr To bits_as(const From& x) noexcept {
#ifdef __cpp_lib_bit_cast
    return std::bit_cast<To>(x);
#else
    return __builtin_bit_cast(To, x);
#endif
}

/// A number as text; it ends in a zero.
struct number_text {
    std::array<char, 32> text{};
};

/// std::to_chars of a finite double without the standard's: the fewest digits that read back as the same
/// number, as a fixed-point number unless that is longer than with an exponent.
template <class Isa = isa::here> number_text shortest_digits(double x) {
    number_text scientific, fixed;
    if (x != x || x - x != 0) {
        std::snprintf(fixed.text.data(), fixed.text.size(), "%g", x);
        return fixed;
    }
    constexpr int most = 17;
    int digits = 1;
    do {
        std::snprintf(scientific.text.data(), scientific.text.size(), "%.*e", digits - 1, x);
    } while (std::strtod(scientific.text.data(), nullptr) != x && digits++ < most);
    const char* const exponent = std::strchr(scientific.text.data(), 'e');
    const int decimals = digits - 1 - static_cast<int>(std::strtol(exponent + 1, nullptr, 10));
    const int length =
        std::snprintf(fixed.text.data(), fixed.text.size(), "%.*f", decimals > 0 ? decimals : 0, x);
    return static_cast<std::size_t>(length) <= std::strlen(scientific.text.data()) ? fixed : scientific;
}

#ifdef __cpp_exceptions
/// std::from_chars of a double without the standard's: the longest decimal number at the start of the text,
/// whatever stands behind it; not in hexadecimal, without blanks or a plus before it.
template <class Isa = isa::here>
std::from_chars_result leading_number(const char* first, const char* last, double& value) {
    const char* at = first;
    const auto digits = [&] {
        const char* const begin = at;
        while (at != last && *at >= '0' && *at <= '9') ++at;
        return at - begin;
    };
    const auto word = [&](const char* w) {
        const char* p = at;
        while (*w != '\0' && p != last && (*p | ' ') == *w) ++p, ++w;
        return *w == '\0' ? p : nullptr;
    };
    if (at != last && *at == '-') ++at;
    const char* end = word("infinity");
    for (const char* name : {"inf", "nan"})
        if (!end) end = word(name);
    if (!end) {
        auto count = digits();
        if (at != last && *at == '.') ++at, count += digits();
        if (count == 0) return {first, std::errc::invalid_argument};
        end = at;
        if (at != last && (*at == 'e' || *at == 'E')) {
            if (++at != last && (*at == '+' || *at == '-')) ++at;
            if (digits() > 0) end = at;
        }
    }
    const std::string text(first, end);
    const double read = std::strtod(text.c_str(), nullptr);
    const bool overflow = (read - read != 0) && text.find_first_of("iInN") == text.npos;
    const bool underflow =
        read == 0 && text.substr(0, text.find_first_of("eE")).find_first_of("123456789") != text.npos;
    if (overflow || underflow) return {end, std::errc::result_out_of_range};
    value = read;
    return {end, std::errc{}};
}

/// std::from_chars of a double.
template <class Isa = isa::here>
std::from_chars_result number_from_chars(const char* first, const char* last, double& value) {
#    ifdef __cpp_lib_to_chars
    return std::from_chars(first, last, value);
#    else
    return leading_number<Isa>(first, last, value);
#    endif
}
#endif

} // namespace quadrant::inline v0::detail
