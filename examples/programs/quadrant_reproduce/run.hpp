// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../for_each_index.hpp"
#include "row.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace quadrant_reproduce {

/// One experiment with what its cases found.
struct section {
    experiment what;
    std::vector<row> rows;
    std::vector<picture> pictures;
};

/// Adds the lines of a picture to the one of the same title, or the picture.
inline void put_together(std::vector<picture>& all, picture more) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const picture& p) { return p.title == more.title; });
    if (same == all.end()) return all.push_back(std::move(more));
    for (std::size_t k = 0; k < std::min(same->panels.size(), more.panels.size()); ++k)
        for (line& l : more.panels[k].lines) same->panels[k].lines.push_back(std::move(l));
}

/// Runs the cases on all cores; `tell(id, done, of)` hears of each that has ended, one at a time. A case that
/// throws leaves one row that says so; but std::bad_alloc is thrown on, for a table made in want of memory says
/// nothing of the experiment. No number that is not finite leaves here.
template <class Tell> std::vector<section> run_all(const std::vector<experiment>& chosen, Tell&& tell) {
    std::vector<const run_case*> cases;
    for (const experiment& e : chosen)
        for (const run_case& c : e.cases) cases.push_back(&c);
    std::vector<outcome> found(cases.size());
    std::size_t done = 0;
    std::mutex telling;
    quadrant_programs::for_each_index(
        cases.size(), std::min<std::size_t>(std::thread::hardware_concurrency(), cases.size()),
        [&](std::size_t k) {
            try {
                found[k] = cases[k]->run();
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::exception& e) {
                found[k].rows = {{cases[k]->id, "failed", "", {}, {}, {}, {}, e.what()}};
            }
            for (row& r : found[k].rows)
                if (r.simulated && !std::isfinite(*r.simulated)) {
                    r.simulated.reset();
                    r.note = r.note.empty() ? "no finite figure" : "no finite figure; " + r.note;
                }
            const std::lock_guard lock(telling);
            tell(cases[k]->id, ++done, cases.size());
        });
    std::vector<section> out;
    auto at = found.begin();
    for (const experiment& e : chosen) {
        section s{e, {}, {}};
        for (std::size_t k = 0; k < e.cases.size(); ++k, ++at) {
            s.rows.insert(s.rows.end(), at->rows.begin(), at->rows.end());
            for (picture& p : at->pictures) put_together(s.pictures, std::move(p));
        }
        out.push_back(std::move(s));
    }
    return out;
}

} // namespace quadrant_reproduce
