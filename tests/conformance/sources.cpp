// SPDX-License-Identifier: BSL-1.0
// What holds of every source: a block without an input, stepped by time alone.
#include "sources.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace conformance;

namespace {
/// The outputs of a source, the components of a pair one after the other.
template <class Real, class Source> std::vector<Real> outputs(Source& source, int samples = 200) {
    std::vector<Real> y;
    for (int k = 0; k < samples; ++k) {
        const auto out = one_sample(source);
        if constexpr (requires { out.y; }) {
            y.push_back(Real(out.x.value()));
            y.push_back(Real(out.y.value()));
        } else
            y.push_back(Real(out.value()));
    }
    return y;
}
template <class Real> double largest(const std::vector<Real>& y) {
    double most = 0;
    for (const Real& each : y) most = std::max(most, std::abs(detail::plain(each)));
    return most;
}
} // namespace

TEST_CASE_TEMPLATE("every source: reset leaves it as new, a copy is a snapshot and drives nothing but itself",
                   Real, double, float, dual<most_parameters>) {
    for_each_source([](const auto& e) {
        CAPTURE(e.name);
        auto source = e(values<Real>{}), twin = e(values<Real>{});
        const auto fresh = outputs<Real>(source);
        CHECK(largest(fresh) > 0);
        source.reset();
        auto copy = source;
        CHECK(outputs<Real>(source) == fresh);
        CHECK(outputs<Real>(copy) == fresh);
        outputs<Real>(twin);
        CHECK(outputs<Real>(source) == outputs<Real>(twin));
    });
}

TEST_CASE("every source: settle(t) leads where t of stepping leads") {
    for_each_source([](const auto& e) {
        CAPTURE(e.name);
        auto stepped = e(values<double>{}), settled = e(values<double>{});
        outputs<double>(stepped, 1234);
        settled.settle(1234.0 * T);
        const auto a = outputs<double>(stepped), b = outputs<double>(settled);
        double off = 0;
        for (std::size_t k = 0; k < a.size(); ++k) off = std::max(off, std::abs(a[k] - b[k]));
        CHECK(off <= 1e-9 * largest(a)); // an edge that enters or leaves the cut within 1e-9 of a sample
    });
}

TEST_CASE("every source: float follows double, a dual its value and its difference quotient") {
    using D = dual<most_parameters>;
    constexpr double h = 1e-6;
    for_each_source([](const auto& e) {
        CAPTURE(e.name);
        auto source = e(values<double>{});
        auto rough = e(values<float>{});
        auto sloped = e(values<D>{});
        const auto exact = outputs<double>(source);
        const auto y = outputs<D>(sloped);
        const auto single = outputs<float>(rough);
        double off = 0, off_single = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) {
            off = std::max(off, std::abs(exact[k] - y[k].value));
            off_single = std::max(off_single, std::abs(exact[k] - double(single[k])));
        }
        CHECK(off <= 1e-12 * largest(exact));
        CHECK(off_single <= 1e-4 * largest(exact));

        values<double> counter;
        e.make(counter);
        REQUIRE(counter.count <= most_parameters);
        for (std::size_t i = 0; i < counter.count; ++i) {
            CAPTURE(i);
            auto more = e(values<double>{.bumped = i, .factor = 1 + h});
            auto less = e(values<double>{.bumped = i, .factor = 1 - h});
            const auto up = outputs<double>(more), down = outputs<double>(less);
            double worst = 0, size = 0;
            for (std::size_t k = 0; k < exact.size(); ++k) {
                const double quotient = (up[k] - down[k]) / (2 * h);
                worst = std::max(worst, std::abs(quotient - y[k].partial[i] * counter.given[i]));
                size = std::max(size, std::abs(quotient));
            }
            CHECK(worst <= 1e-6 * size + 1e-8 * largest(exact));
            CHECK(size > 0);
        }
    });
}

TEST_CASE("every source: no allocation in step, reset, settle or copy") {
    for_each_source([](const auto& e) {
        CAPTURE(e.name);
        auto source = e(values<double>{});
        const std::size_t before = allocated();
        for (int k = 0; k < 100; ++k) source();
        source.settle(3_s);
        auto copy = source;
        copy.reset();
        for (int k = 0; k < 100; ++k) copy();
        const std::size_t after = allocated();
        CHECK(after == before);
    });
}
