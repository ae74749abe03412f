// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/signals.hpp"
#include "../text/axis_words.hpp"
#include "../where/places.hpp"
#include "../which/axis_case.hpp"
#include "../which/rivals.hpp"

#include <algorithm>
#include <string>

namespace quadrant::inline v0::diagnosis::detail {

/// What is left when every cause is added: how large, and in which regimes.
inline void describe_rest(diagnosis_result& out, const axis_case& c, const axis_result& result,
                          const std::vector<cause>& causes) {
    const double floor = square(c.floor_force());
    double before = std::max(0.0, square(result.gap.force_rms_N) - floor);
    double after = c.at_floor() ? 0 : std::max(0.0, square(result.gap_after.force_rms_N) - floor);
    if (c.count_unnamed)
        before = after = std::max(before, floor); // finer steps are missing, and no suspect gives them
    std::string text = "axis " + c.axis.name + ": ";
    if (c.controller_differs()) {
        before += square(rms(c.command_difference(c.log, *c.axis.controller)));
        after += square(rms(c.command_left()));
        if (c.controller_open())
            text += std::string("the controller that ran is not the one described") +
                    (c.controller_unnamed ? ", which the machine file excludes; "
                                          : " and no single key of it corrects the replay; ");
    }
    if (c.count_unnamed)
        text += worded("the position moves in steps of %.4g m where %.4g m are described; ", c.count,
                       c.axis.encoder.resolution_m);
    if (c.at_floor()) {
        text += worded("%.3g N rms behind the command (floor %.3g N), which does not matter",
                       result.gap_after.force_rms_N, c.floor_force());
    } else {
        text += worded("%.3g N rms behind the command (floor %.3g N)", result.gap_after.force_rms_N,
                       c.floor_force());
        if (c.within_its_laws()) text += ", no more than the laws of friction and of the causes are wrong by";
        auto views = regimes(c.models.held_out_residual(c.best()), c.record);
        std::erase_if(views, [](const place& v) { // an even spread over time says nothing
            return v.view == "time" && v.share.value > 0.35 && v.share.value < 0.65;
        });
        std::stable_sort(views.begin(), views.end(),
                         [](const auto& a, const auto& b) { return a.share.value > b.share.value; });
        for (std::size_t i = 0; i < std::min<std::size_t>(3, views.size()); ++i)
            text += worded("; %.0f %% ", 100 * views[i].share.value) + views[i].finding;
        const auto forms = c.models.forms();
        std::vector<candidate> with_form;
        if (!c.models.over()) with_form = c.models.with_these(c.best(), forms, c.limits.forms);
        for (std::size_t i = 0; i < with_form.size(); ++i)
            if (const double share = c.takes_off(with_form[i], c.best());
                share > 0.5 && c.models.pays(with_form[i], c.best()))
                text += worded("; a force that follows %s and is in no list takes %.0f %% off",
                               std::string(forms[i]->name).c_str(), 100 * share);
        for (const cause& x : causes)
            if (!x.better_form.empty())
                text += worded("; a force that follows %s and is in no list predicts better than %s",
                               x.better_form.c_str(), x.effect.c_str());
    }
    out.share_unexplained =
        std::max(out.share_unexplained, before > 0 ? std::clamp(after / before, 0.0, 1.0) : 0);
    out.remaining_structure += (out.remaining_structure.empty() ? "" : "; ") + text_of(text, c.axis.kind);
}

} // namespace quadrant::inline v0::diagnosis::detail
