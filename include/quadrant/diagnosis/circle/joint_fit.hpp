// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "periodic.hpp"
#include "spikes.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Runs of the same feed (within 5 %) and radius.
struct circle_groups {
    std::vector<std::size_t> of_run, first_run; ///< group of each run; a run of each group
    std::vector<double> radii;                  ///< each once
    explicit circle_groups(const std::vector<circle_run>& runs) {
        for (std::size_t j = 0; j < runs.size(); ++j) {
            const auto same = [&](std::size_t first) {
                return std::abs(runs[first].feed / runs[j].feed - 1) < 0.05 &&
                       std::abs(runs[first].radius / runs[j].radius - 1) < 1e-3;
            };
            const auto found = std::find_if(first_run.begin(), first_run.end(), same);
            of_run.push_back(static_cast<std::size_t>(found - first_run.begin()));
            if (found == first_run.end()) first_run.push_back(j);
            if (std::none_of(radii.begin(), radii.end(),
                             [&](double r) { return std::abs(runs[j].radius / r - 1) < 1e-3; }))
                radii.push_back(runs[j].radius);
        }
    }
};

/// All errors that a coefficient each describes, fitted to all runs at once; what is not above its detection
/// limit is taken out, weakest first, until all that is left is needed.
class joint_fit {
public:
    struct column {
        circle_verdict verdict = circle_verdict::below_limit;
        double value = 0, standard_error = 0, limit = 0;
        double circularity = 0; ///< for a coefficient of 1
        std::vector<std::size_t> together;
    };

    /// `least`: what nothing is found below, as a circular error [m].
    joint_fit(const std::vector<circle_run>& runs, const circle_groups& groups, double least = 0)
        : runs_(&runs), least_(least) {
        const auto bins = binned(runs);
        for (const circle_run& r : runs) least_ = std::max({least_, 0.1 * r.resolution, 1e-9});
        std::array<double, 2> play{};
        for (int round = 0; round < 3; ++round) { // the step of a play is as wide as the play
            fit(bins, groups, play);
            std::array<double, 2> now{};
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (patterns[c].name == "backlash")
                    now[patterns[c].axis == "y"] = std::max(0.0, columns[c].value);
            if (now == std::array<double, 2>{}) break;
            play = now;
        }
    }

    /// Deviation that the errors in the model leave; `machine`: without what belongs to the set-up.
    double model(const circle_point& p, bool machine = false) const {
        double sum = 0;
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (columns[c].value != 0 && !(machine && patterns[c].of_setup))
                sum += columns[c].value * patterns[c].of(p);
        return sum;
    }
    residuals left_of(const std::vector<circle_run>& runs, bool machine = false) const {
        residuals out;
        for (std::size_t j = 0; j < runs.size(); ++j) {
            const circle_run& r = runs[j];
            out.emplace_back();
            for (std::size_t k = 0; k < r.angle.size(); ++k)
                out.back().push_back(r.deviation[k] -
                                     model({r.angle[k], r.feed, r.radius, r.turning(), j, r.log}, machine));
        }
        return out;
    }

    std::vector<circle_pattern> patterns;
    std::vector<column> columns;
    /// What is not found below [m]: a tenth of the resolution, and the second order of the largest error's
    /// pattern.
    double floor = 0;

private:
    static constexpr double sigmas = 4; ///< of some twenty errors none by chance
    static constexpr double of_largest = 0.015;

    void fit(const std::vector<circle_bin>& bins, const circle_groups& groups,
             const std::array<double, 2>& play) {
        const auto& runs = *runs_;
        std::size_t logs = 0;
        for (const circle_run& r : runs) logs = std::max(logs, r.log + 1);
        const double largest = *std::max_element(groups.radii.begin(), groups.radii.end());
        patterns = circle_patterns(runs[0].source, logs, groups.radii, largest);
        for (std::size_t g = 0; g < groups.first_run.size(); ++g)
            for (const int axis : {0, 1}) {
                const auto shape = fit_spike(bins, groups.of_run, g, axis, play[std::size_t(axis)]);
                const circle_run& r = runs[groups.first_run[g]];
                for (const int side : {1, -1})
                    patterns.push_back(spike_pattern(axis, side, g, groups.of_run, shape, r.feed / r.radius));
            }
        for (const int axis : {0, 1}) patterns.push_back(backlash_pattern(axis, play[std::size_t(axis)]));
        columns.assign(patterns.size(), {});
        circle_fit all(bins, patterns);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            columns[c].circularity = all.circularity(c);
            columns[c].together = all.take_or_name(c);
            if (columns[c].together.empty()) continue;
            columns[c].verdict =
                columns[c].together[0] == c ? circle_verdict::not_tested : circle_verdict::not_separable;
        }
        choose(all);
        all.solve();
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (all.used(c)) {
                columns[c].value = all.value(c), columns[c].standard_error = all.standard_error(c);
                if (!patterns[c].of_setup) columns[c].verdict = circle_verdict::found;
            }
    }
    double limit(const circle_fit& fit, std::size_t c) const {
        return std::max(sigmas * fit.standard_error(c), floor / columns[c].circularity);
    }
    void set_floor(const circle_fit& fit) {
        floor = std::max(least_, 4 * fit.structure()); // of what is left, what is no noise
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (fit.used(c) && !patterns[c].of_setup)
                floor = std::max(floor, of_largest * std::abs(fit.value(c)) * columns[c].circularity);
    }
    void choose(circle_fit& fit) {
        const auto candidate = [&](std::size_t c) {
            return !patterns[c].of_setup && columns[c].verdict == circle_verdict::below_limit;
        };
        for (bool weaker = true; weaker;) {
            fit.solve(), set_floor(fit);
            double least = 1;
            std::size_t weakest = columns.size();
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (fit.used(c) && candidate(c)) {
                    const double size = std::abs(fit.value(c)) / limit(fit, c);
                    if (size < least) least = size, weakest = c;
                }
            weaker = weakest < columns.size();
            if (weaker) fit.use(weakest, false);
        }
        for (int round = 0; round < 6;
             ++round) { // what was taken out beside a stronger one may be needed after all
            double most = 1;
            std::size_t strongest = columns.size();
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (!fit.used(c) && candidate(c)) {
                    fit.use(c, true), fit.solve(false);
                    columns[c].limit = limit(fit, c);
                    const double size = std::abs(fit.value(c)) / columns[c].limit;
                    if (size > most) most = size, strongest = c;
                    fit.use(c, false);
                }
            if (strongest == columns.size()) break;
            fit.use(strongest, true), fit.solve(), set_floor(fit);
        }
        fit.solve();
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (fit.used(c)) columns[c].limit = limit(fit, c);
    }

    const std::vector<circle_run>* runs_;
    double least_;
};

} // namespace quadrant::inline v0::diagnosis::detail
