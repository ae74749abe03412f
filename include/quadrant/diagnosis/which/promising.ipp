// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"

#include <algorithm>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

QUADRANT_DIAGNOSIS_DECL void run_the_promising(const fitter& fit, std::span<fit_course> courses,
                                               std::span<const std::size_t> starts_of, int steps) {
    constexpr std::size_t few = 2; // starts of a model that go on to the end of the look in any case
    const auto of_each_model = [&](const auto& use) {
        for (std::span<fit_course> rest = courses; const std::size_t n : starts_of) {
            const auto starts = rest.first(n);
            const auto takes_longer = [&](const fit_course& c) { return c.iterations() > steps; };
            if (n > few && std::none_of(starts.begin(), starts.end(), takes_longer)) use(starts);
            rest = rest.subspan(n);
        }
    };
    of_each_model([&](std::span<fit_course> starts) {
        for (fit_course& c : starts) c.pause_after(std::max(1, steps / 2));
    });
    fit.run(courses);
    of_each_model([&](std::span<fit_course> starts) {
        std::vector<fit_course*> order;
        for (fit_course& c : starts) order.push_back(&c);
        std::stable_sort(order.begin(), order.end(), [](fit_course* a, fit_course* b) {
            return cost_of(a->result()) < cost_of(b->result());
        });
        const std::size_t kept = std::max(few, (order.size() + 1) / 2);
        for (std::size_t i = 0; i < order.size(); ++i) i < kept ? order[i]->go_on() : order[i]->end();
    });
    fit.run(courses);
}

} // namespace quadrant::inline v0::diagnosis::detail
