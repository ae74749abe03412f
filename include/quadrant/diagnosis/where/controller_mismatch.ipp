// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "added/find_added.hpp"
#include "own_limit.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Why the controller as described, which runs, commands something that is not finite at a row.
inline void refuse_broken(const controller_description& described, const axis_log& log,
                          const std::vector<double>& replayed) {
    const auto broken =
        std::find_if_not(replayed.begin(), replayed.end(), [](double u) { return std::isfinite(u); });
    if (described.own && broken != replayed.end())
        throw std::invalid_argument(
            fmt::format("the controller of axis {}: its command at row {} is not finite", log.name,
                        broken - replayed.begin()));
}

/// Below this share of itself neither a command nor a value is called another one: the accuracy to which files
/// and recordings of controllers agree.
inline constexpr double same_controller = 0.005;

/// 95 % of what the difference that is left leaves open of a value. Its blocks are independent, not its rows.
inline double width_of(const key_fit& fit, double left, std::size_t block) {
    const double slope = rms(fit.slope);
    if (!(slope > 0)) return fit.slope.empty() ? std::abs(fit.value - fit.described) : 0;
    return 1.96 * left / (slope * std::sqrt(static_cast<double>(fit.left.size()) / static_cast<double>(block)));
}

/// Every key fitted alone; the first agrees best.
inline std::vector<key_fit> fitted_keys(const controller_description& described, const replay_box& box,
                                        const std::vector<double>& difference, double floor,
                                        const record_scales& scale, std::vector<std::vector<double>>& slopes) {
    std::vector<key_fit> out;
    for (const auto& key : searched_keys(described, scale)) {
        key_search search(described, key, box, difference, floor);
        slopes.push_back(search.slope());
        if (auto fit = search.best()) out.push_back(std::move(*fit));
    }
    std::stable_sort(out.begin(), out.end(), [](auto& a, auto& b) { return a.score < b.score; });
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL controller_finding judge_controller(const controller_description& described,
                                                            const actuator_description& actuator,
                                                            const axis_log& log, const axis_record& record,
                                                            double count) {
    using namespace detail;
    controller_finding out;
    const axis_log as_read = as_controlled(log, count);
    replay_box box(as_read, actuator, record);
    out.replayed = box.replay(described);
    refuse_broken(described, log, out.replayed);
    const replay_floor floor = floor_of(described, box);
    box.skip_to(rows_of_unknown_past(described, box, 4 * floor.ms));
    const auto difference = box.difference(described, out.replayed);
    out.after_rms = out.difference_rms = rms(difference);
    out.floor_rms = std::sqrt(floor.ms);
    if (floor.explains(block_ms(difference, 0, box.block()))) return out;
    out.limits_otherwise_from = limit_of_another_law(described, box, record);
    if (out.limits_otherwise_from) return out;

    const double least = same_controller * rms(std::span(log.command).subspan(box.from()));
    const bool matters = out.difference_rms > least;
    std::vector<std::vector<double>> slopes;
    const auto fits = fitted_keys(described, box, difference, floor.ms, record.scale, slopes);
    const auto to_rounding = [&](const key_fit& fit, const std::vector<double>& left) {
        const auto blocks = block_ms(left, 0, box.block());
        return floor.explains(blocks) || floor_of(fit.controller, box).explains(blocks);
    };
    bool exactly = false;
    for (std::size_t i = 0; i < fits.size(); ++i) {
        const key_fit& fit = fits[i];
        const auto left = box.difference(fit.controller, box.replay(fit.controller));
        const double after = rms(left);
        const bool agrees = after < 0.5 * out.difference_rms;
        if (i == 0) {
            exactly = agrees && to_rounding(fit, left);
            out.key = fit.key;
            out.described = fit.described;
            out.value = fit.value;
            out.after_rms = after;
            const double width = width_of(fit, std::max(after, out.floor_rms), box.block());
            out.low = fit.value - width;
            out.high = fit.value + width;
            out.mended = exactly || (agrees && after <= least);
        } else if (out.mended && agrees && (exactly ? to_rounding(fit, left) : after <= least)) {
            out.alternatives.push_back({fit.key, fit.value});
        }
    }
    const bool moved = std::abs(out.value - out.described) > same_controller * std::abs(out.described);
    if (!out.mended)
        out.added = added_search(described, box, floor)
                        .find(fits.empty() ? std::nullopt : std::optional(fits.front()), std::move(slopes));
    // Below the accuracy of files and recordings only a form that is recognised is a signal.
    if (out.added && !matters && out.added->waveform.form == waveform_form::unknown) out.added.reset();
    out.differs = matters || (exactly && moved) || out.is_added();
    return out;
}

} // namespace quadrant::inline v0::diagnosis
