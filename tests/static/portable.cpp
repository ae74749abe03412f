// SPDX-License-Identifier: BSL-1.0
// What stands in for a C++ library that lacks it does the same as the library that has it.
#include <quadrant/base/digits.hpp>
#include <quadrant/base/portable.hpp>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>

using namespace quadrant::detail;

namespace {
std::string by_library(double x) {
    std::array<char, 64> out{};
    std::to_chars(out.data(), out.data() + out.size(), x);
    return out.data();
}
std::string by_us(double x) { return shortest_digits(x).text.data(); }
} // namespace

TEST_CASE("portable: bits_as is the library's bit_cast, also at compile time") {
    static_assert(bits_as<std::uint64_t>(1.0) == 0x3ff0'0000'0000'0000);
    static_assert(bits_as<std::uint32_t>(-0.0F) == 0x8000'0000);
    CHECK(bits_as<double>(std::uint64_t{0x7ff0'0000'0000'0000}) == std::numeric_limits<double>::infinity());
}

TEST_CASE("portable: shortest_digits writes what std::to_chars writes") {
    for (const double x : {0.0,
                           -0.0,
                           1.0,
                           -1.0,
                           0.1,
                           1200.0,
                           1e5,
                           100000.5,
                           123456.0,
                           1e-4,
                           0.00012,
                           1e22,
                           1e21,
                           123456789012345680000.0,
                           5e-324,
                           1.7976931348623157e308,
                           2.2250738585072014e-308,
                           -1.2345678901234567e-300,
                           9007199254740993.0,
                           std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()})
        CHECK(by_us(x) == by_library(x));
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> exponent(-30, 30), mantissa(-10, 10);
    for (int k = 0; k < 20000; ++k) {
        const double x = mantissa(random) * std::pow(10.0, std::round(exponent(random)));
        const double rounded = std::round(x * 1000) / 1000;
        CHECK(by_us(x) == by_library(x));
        CHECK(by_us(rounded) == by_library(rounded));
    }
}

TEST_CASE("portable: any double reads back from shortest_digits") {
    std::mt19937_64 random(2);
    for (int k = 0; k < 20000; ++k) {
        const auto x = bits_as<double>(random());
        if (std::isfinite(x)) CHECK(std::strtod(by_us(x).c_str(), nullptr) == x);
    }
}

TEST_CASE("portable: leading_number reads what std::from_chars reads, and refuses what it refuses") {
    const auto same = [](const std::string& text) {
        double ours = -7, theirs = -7;
        const char* const end = text.data() + text.size();
        const auto a = leading_number(text.data(), end, ours);
        const auto b = std::from_chars(text.data(), end, theirs);
        INFO(text);
        CHECK(a.ec == b.ec);
        CHECK(a.ptr - text.data() == b.ptr - text.data());
        CHECK(bits_as<std::uint64_t>(ours) == bits_as<std::uint64_t>(theirs));
    };
    for (const char* text :
         {"",    "-",    ".",     "-.",        "+1",      " 1",    "1",      "-1",     "1.",
          ".5",  "1.5e", "1.5e+", "1.5e3",     "1.5E-3x", "1e400", "-1e400", "1e-400", "0e999",
          "0.0", "-0",   "inf",   "-Infinity", "infinit", "nan",   "NaN",    "0x10",   "1,5",
          "1 2", "e5",   "12abc", "1.2.3",     "5e-324",  "--1",   "1e--2"})
        same(text);
    std::mt19937_64 random(3);
    for (int k = 0; k < 5000; ++k) {
        const auto x = bits_as<double>(random());
        if (std::isfinite(x)) same(by_library(x));
        std::string noise;
        for (int i = 0; i < 8; ++i) noise += "0123456789.eE+-x"[random() % 16];
        same(noise);
    }
}
