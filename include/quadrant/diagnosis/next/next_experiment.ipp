// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL separation best_motion(const proving_ground& ground,
                                               const std::vector<planned_motion>& motions,
                                               const std::vector<confusable>& names, std::size_t threads) {
    const std::size_t n = names.size(), pairs = n * (n - 1);
    const auto pair = [&](std::size_t i) { // each as the truth against each other
        const std::size_t truth = i / (n - 1), other = i % (n - 1);
        return std::pair{truth, other < truth ? other : other + 1};
    };
    const auto gains_of = [&](const std::vector<std::size_t>& which, bool whole) {
        std::vector<double> gains(which.size() * pairs);
        on_all_cores(gains.size(), threads, [&](std::size_t i) {
            const auto [truth, other] = pair(i % pairs);
            gains[i] = ground.gain(motions[which[i / pairs]], names[truth], names[other], whole);
        });
        return gains;
    };
    std::vector<std::size_t> order(motions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto look = gains_of(order, false);
    const auto least = [&](const std::vector<double>& gains, std::size_t m) {
        const auto first = gains.begin() + static_cast<std::ptrdiff_t>(m * pairs);
        return *std::min_element(first, first + static_cast<std::ptrdiff_t>(pairs));
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return least(look, a) > least(look, b); });
    separation best{.tried = motions.size()};
    constexpr std::size_t finalists = 3;
    for (std::size_t k = 0; k < std::min(finalists, order.size()) && least(look, order[k]) > best.gain; ++k)
        if (const double found = least(gains_of({order[k]}, true), 0); found > best.gain) {
            best.motion = order[k];
            best.gain = found;
        }
    std::size_t most = 0; // of those where the truth can do what the other cannot
    double largest = 0;
    for (std::size_t i = 0; i < look.size(); ++i) {
        const auto [truth, other] = pair(i % pairs);
        const bool richer = names[truth].model.fit.x.size() > names[other].model.fit.x.size();
        if (richer && look[i] > largest) largest = look[most = i];
    }
    if (largest > 0 && best.gain < 1) {
        const auto [truth, other] = pair(most % pairs);
        best.one_way_motion = most / pairs;
        best.one_way_truth = truth;
        best.one_way_gain = ground.gain(motions[best.one_way_motion], names[truth], names[other], true);
    }
    return best;
}

namespace detail {

QUADRANT_DIAGNOSIS_DECL std::vector<confusable> readings_of(const std::vector<rival>& rivals,
                                                            const axis_record& record) {
    constexpr std::size_t most = 3;
    std::vector<const rival*> others;
    for (const rival& r : rivals)
        if (r.same && &r != &rivals.front()) others.push_back(&r);
    std::stable_sort(others.begin(), others.end(), [](auto a, auto b) { return a->weight > b->weight; });
    constexpr double in_question = 0.05; // the most probable is in any case
    while (others.size() > 1 && others.back()->weight < in_question) others.pop_back();
    const auto equivalent = [&](const rival* r) { return may_be_one(*r->name, *rivals.front().name); };
    if (!std::all_of(others.begin(), others.end(), equivalent)) std::erase_if(others, equivalent);
    std::vector<confusable> out{{rivals.front().name, rivals.front().model}};
    for (const rival* r : others)
        if (out.size() < most) {
            out.push_back({r->name, r->model});
            finish(record, out.back().model);
        }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<planned_motion> motions_for(const std::vector<confusable>& names,
                                                                std::vector<planned_motion> motions) {
    constexpr std::array<std::string_view, 5> at_rest{"presliding_friction", "backlash", "stribeck_friction",
                                                      "actuator_dead_zone", "cutting_force"};
    const bool wanted = std::any_of(names.begin(), names.end(), [&](const confusable& n) {
        return std::find(at_rest.begin(), at_rest.end(), n.name->name) != at_rest.end();
    });
    if (!wanted) std::erase_if(motions, [](const planned_motion& m) { return !m.slips; });
    return motions;
}

/// By how much the log itself prefers the first of the names to the nearest of the others; 0: not at all.
inline double separated_by_log(const std::vector<confusable>& names) {
    double least = std::numeric_limits<double>::infinity();
    for (const confusable& n : names)
        if (&n != &names.front()) least = std::min(least, names.front().model.total - n.model.total);
    return std::max(0.0, least);
}

/// "a, b and c".
inline std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names)
        (out += out.empty() ? "" : &name == &names.back() ? " and " : ", ") += label_of_effect(name);
    return out;
}

QUADRANT_DIAGNOSIS_DECL experiment simulated_experiment(const axis_case& c,
                                                        const std::vector<confusable>& names) {
    experiment out{.motion = "", .separates = {}, .axis = c.axis.name};
    for (const confusable& n : names) out.separates.emplace_back(n.name->name);
    out.gain_of_log = separated_by_log(names);
    const bool known = std::all_of(names.begin(), names.end(), [&](const confusable& n) {
        return &n == &names.front() || names.front().equivalent(n);
    });
    const double period = c.record.period;
    const auto motions =
        motions_for(names, standard_motions(shown_by(motion_of(c.log), period, c.record.scale.corner_Hz),
                                            period, c.record.scale));
    if (motions.empty()) {
        out.motion = names.front().name->exciting_motion;
        out.finding = "not simulated: the reference of this log shows no travel and speed to stay inside";
        return out;
    }
    axis_description axis = c.axis;
    if (axis.controller) axis.controller = c.mended();
    const proving_ground ground(axis, period, c.resolution, c.noise, c.record.scale, proven_limits(c.log));
    const separation best = best_motion(ground, motions, names, c.limits.threads);
    const auto inside =
        worded("%zu motions inside the travel, speed, acceleration and command of this log", best.tried);
    const auto take = [&](std::size_t motion) {
        out.motion = motions[motion].words;
        out.period_s = period;
        out.reference = motions[motion].reference;
    };
    if (best.gain >= score_temperature) { // better than odds of e to 1
        out.expected_gain = best.gain;
        take(best.motion);
        out.finding = "simulated beforehand, each name as the truth and the others fitted again: the best of " +
                      inside + worded(", which itself separates them by %.1f", out.gain_of_log);
        if (out.gain_of_log >= c.limits.margin && !c.settled)
            out.finding +=
                "; what keeps them together is the force that is left unexplained, which is larger than "
                "their difference: find that first";
        if (best.gain < c.limits.margin)
            out.finding += worded("; below %.0f they stay undecided", c.limits.margin);
    } else if (best.one_way_gain >= c.limits.margin) {
        take(best.one_way_motion);
        out.finding =
            worded("it decides only if %s is true, by a log-score of %.0f in simulation, the best of ",
                   listed({out.separates[best.one_way_truth]}).c_str(), best.one_way_gain) +
            inside + "; else they stay one group" +
            (known ? ", for they are one model under two names but for that" : "");
    } else {
        out.motion = "none: no motion of this axis distinguishes " + listed(out.separates);
        out.finding =
            inside + worded(" were simulated, and the best separates them by a log-score of %.1f", best.gain) +
            (known ? ": a known equivalence, one model under two names; either corrects the simulation"
                   : "; it needs another load or another sensor");
    }
    if (!axis.controller && !axis.drive.takes_position())
        out.finding += "; under a stand-in controller, as none is described";
    return out;
}

QUADRANT_DIAGNOSIS_DECL void propose(diagnosis_result& out, const axis_case& c,
                                     const std::vector<cause>& causes,
                                     const std::vector<std::vector<rival>>& rivals) {
    if (out.next.expected_gain > 0) return; // of an earlier axis
    const cause* group = nullptr;
    const cause* suspect = nullptr;
    for (const cause& x : causes) {
        if (x.confusable_with.empty()) {
            if (!suspect && x.probability < 0.5) suspect = &x;
        } else if (!group || (!claimed(*group) && claimed(x))) {
            group = &x;
        }
    }
    if (group) {
        for (const auto& r : rivals)
            if (r.front().name->name == group->effect)
                out.next = simulated_experiment(c, readings_of(r, c.record));
    } else if (suspect && out.next.motion.empty()) {
        out.next = {.motion = suspect->exciting_motion, .separates = {}, .axis = c.axis.name};
        out.next.finding = "to see whether " + listed({suspect->effect}) +
                           " is there; not simulated, for what else it may be has no model";
    }
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
