// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"

#include <algorithm>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

QUADRANT_DIAGNOSIS_DECL void run_the_promising(const fitter& fit, std::span<fit_course> courses,
                                               std::span<const std::size_t> starts_of, int steps) {
    const int half = std::max(1, steps / 2);
    constexpr std::size_t few = 2; // starts of a model that go on to the end of the look in any case
    const auto of_each_model = [&](const auto& use) {
        for (std::span<fit_course> rest = courses; const std::size_t n : starts_of) {
            use(rest.first(n));
            rest = rest.subspan(n);
        }
    };
    const auto keep_best = [&](int iterations, const auto& kept_of) {
        of_each_model([&](std::span<fit_course> starts) {
            for (fit_course& c : starts)
                if (starts.size() > few) c.pause_after(iterations);
        });
        fit.run(courses);
        of_each_model([&](std::span<fit_course> starts) {
            if (starts.size() <= few) return;
            std::vector<fit_course*> order;
            for (fit_course& c : starts) order.push_back(&c);
            std::stable_sort(order.begin(), order.end(), [](fit_course* a, fit_course* b) {
                return cost_of(a->result()) < cost_of(b->result());
            });
            for (std::size_t i = 0; i < order.size(); ++i)
                i < kept_of(order.size()) ? order[i]->go_on() : order[i]->end();
        });
    };
    keep_best(half, [&](std::size_t starts) { return std::max(few, (starts + 1) / 2); });
    keep_best(3 * half, [&](std::size_t) { return few; });
    fit.run(courses);
}

} // namespace quadrant::inline v0::diagnosis::detail
