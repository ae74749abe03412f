// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"
#include "joint_fit.hpp"
#include "left_over.hpp"
#include "name_left_over.hpp"

namespace quadrant::inline v0::diagnosis {

/// What the owner of a machine says before its circles are judged.
struct circle_options {
    std::vector<std::string> excluded_effects{}; ///< of the machine file: what this machine cannot have
    std::array<std::string, 2> axes{"x", "y"};   ///< what the first and second axis are called in the files
    double shortest_period = 0; ///< of a cyclic error that is sought [m]; 0: a hundredth of the largest radius
};

namespace detail {

/// The pieces of a ball-bar diagnosis put together; see ball_bar.
class circle_diagnosis {
public:
    circle_diagnosis(std::vector<circle_run> runs, const circle_options& options)
        : options_(options), runs_(std::move(runs)), groups_(runs_) {
        if (options_.shortest_period <= 0)
            options_.shortest_period = *std::max_element(groups_.radii.begin(), groups_.radii.end()) / 100;
    }

    circle_result operator()() {
        auto cleaned = runs_; // without what is periodic
        std::array<double, 3> limits{};
        joint_fit fit(cleaned, groups_);
        std::vector<periodic_error> periodic;
        residuals left;
        for (int round = 0; round < 3;
             ++round) { // what is periodic is in the way of the others, and they of it
            left = fit.left_of(runs_);
            cleaned = runs_;
            periodic =
                take_periodic(cleaned, left, groups_.of_run, options_.shortest_period, fit.floor / 2, limits);
            if (periodic.empty() && round == 0) break;
            double largest = 0;
            for (const auto& p : periodic)
                largest = std::max(largest, 2 * *std::max_element(p.amplitude.begin(), p.amplitude.end()));
            fit = joint_fit(cleaned, groups_, 0.015 * largest);
            left = fit.left_of(cleaned);
        }
        name_columns(fit);
        for (auto& e : name_periodic(runs_, periodic, limits, options_.excluded_effects))
            out_.errors.push_back(std::move(e));
        for (auto& e : name_stick_slip(runs_, left, fit.floor, options_.excluded_effects))
            out_.errors.push_back(std::move(e));
        rank();
        double before = 0, after = 0;
        const auto setup = fit.left_of(cleaned, true);
        for (std::size_t j = 0; j < runs_.size(); ++j) {
            out_.runs.push_back(measured(runs_[j], left[j]));
            for (std::size_t k = 0; k < left[j].size(); ++k) {
                const double set_up_only = runs_[j].deviation[k] - (setup[j][k] - left[j][k]);
                before += set_up_only * set_up_only, after += left[j][k] * left[j][k];
            }
        }
        out_.source = runs_[0].source;
        out_.first_axis = options_.axes[0], out_.second_axis = options_.axes[1];
        out_.explained = before > 0 ? 1 - after / before : 0;
        notes();
        return std::move(out_);
    }

private:
    bool excluded(std::string_view effect) const {
        const auto& all = options_.excluded_effects;
        return std::find(all.begin(), all.end(), effect) != all.end();
    }

    /// A machine without play has the pattern of play all the same, where friction holds the axis back.
    std::string_view name_of(const circle_pattern& p) const {
        return p.name == "backlash" && excluded("backlash") ? std::string_view("reversal_lag") : p.name;
    }
    void name_columns(const joint_fit& fit) {
        for (std::size_t c = 0; c < fit.columns.size(); ++c) {
            const auto& [p, k] = std::tie(fit.patterns[c], fit.columns[c]);
            if (p.of_setup || p.name == "reversal_spikes") continue;
            circle_error e = named_error(name_of(p), p.axis, p.unit, options_.excluded_effects);
            e.verdict = k.verdict, e.limit = k.limit, e.value = interval_of(k.value, k.standard_error);
            e.circularity = std::abs(k.value) * k.circularity;
            for (const std::size_t other : k.together)
                if (other != c)
                    e.together_with.push_back(
                        std::string(name_of(fit.patterns[other])) +
                        (fit.patterns[other].axis.empty() ? "" : " " + fit.patterns[other].axis));
            if (p.name == "backlash") e.reading = reading_of_backlash();
            out_.errors.push_back(std::move(e));
        }
        for (auto& e : out_.errors) // what stands for several names says so
            for (const auto& other : out_.errors)
                if (other.verdict == circle_verdict::not_separable && e.verdict == circle_verdict::found &&
                    std::find(other.together_with.begin(), other.together_with.end(),
                              e.name + (e.axis.empty() ? "" : " " + e.axis)) != other.together_with.end())
                    e.together_with.push_back(other.name + (other.axis.empty() ? "" : " " + other.axis));
        if (runs_[0].source == circle_source::encoder)
            for (const auto& w : circle_error_names)
                if (w.behind_encoder) {
                    out_.errors.push_back(named_error(w.name, "", "", options_.excluded_effects));
                    out_.errors.back().verdict = circle_verdict::not_visible;
                    out_.errors.back().needs = "a ball-bar or grid plate (" + std::string(w.needs) + ")";
                }
        for (const char* axis : {"x", "y"}) out_.errors.push_back(spikes(fit, axis));
    }
    std::string reading_of_backlash() const {
        if (excluded("backlash"))
            return "play is excluded on this machine: friction that the position loop does not integrate away";
        if (runs_[0].source == circle_source::encoder)
            return "play between drive and encoder, or friction that the position loop does not integrate "
                   "away; play "
                   "behind the encoder is not visible to it";
        return "play, or friction that the position loop does not integrate away";
    }
    circle_error spikes(const joint_fit& fit, const std::string& axis) const {
        circle_error e = named_error("reversal_spikes", axis, "m", options_.excluded_effects);
        e.limit = HUGE_VAL;
        for (std::size_t c = 0; c < fit.columns.size(); ++c) {
            const auto& [p, k] = std::tie(fit.patterns[c], fit.columns[c]);
            if (p.name != e.name || p.axis != axis) continue;
            if (k.limit > 0) e.limit = std::min(e.limit, k.limit);
            if (k.verdict != circle_verdict::found) continue;
            const circle_run& r = runs_[groups_.first_run[p.group]];
            e.details.push_back({fmt::format("{}{}, {}", axis, p.side > 0 ? "+" : "-", where(r)), r.feed,
                                 r.radius, interval_of(k.value, k.standard_error, 0.15), p.width_s});
            if (std::abs(k.value) > std::abs(e.value.value)) e.value = e.details.back().size;
            e.verdict = circle_verdict::found;
        }
        e.circularity = std::abs(e.value.value);
        if (e.limit == HUGE_VAL) e.limit = 0;
        return e;
    }

    void rank() {
        double sum = 0;
        for (circle_error& e : out_.errors) {
            if (e.verdict != circle_verdict::found) e.circularity = 0;
            sum += e.circularity;
        }
        for (circle_error& e : out_.errors) e.share = sum > 0 ? e.circularity / sum : 0;
        std::stable_sort(out_.errors.begin(), out_.errors.end(),
                         [](const circle_error& a, const circle_error& b) {
                             return std::pair(a.verdict, -a.circularity) < std::pair(b.verdict, -b.circularity);
                         });
    }

    void notes() {
        if (options_.axes != std::array<std::string, 2>{"x", "y"})
            out_.notes.push_back(
                fmt::format("x stands for axis {}, y for axis {}.", options_.axes[0], options_.axes[1]));
        bool both[2] = {false, false};
        double slow = HUGE_VAL, fast = 0;
        for (const circle_run& r : runs_)
            both[r.counterclockwise] = true, slow = std::min(slow, r.feed), fast = std::max(fast, r.feed);
        if (!both[0] || !both[1])
            out_.notes.push_back(fmt::format("All runs go {}: what differs by direction is identified by the "
                                             "feed or not at all. Run the other way round too.",
                                             both[1] ? "counterclockwise" : "clockwise"));
        if (fast < 1.2 * slow)
            out_.notes.push_back(
                "One feed: what follows the feed (radius, amplitude) is not distinguished from what does "
                "not. "
                "Run at half or twice the feed too.");
        if (groups_.radii.size() < 2)
            out_.notes.push_back("One radius: whether radius and spikes follow v^2/R is assumed, not seen.");
        if (runs_[0].source == circle_source::encoder)
            out_.notes.push_back(
                "Encoders see neither squareness, scale, straightness nor what lies behind them: a "
                "ball-bar or a grid plate does, a laser says the scale of each axis.");
    }

    circle_options options_;
    std::vector<circle_run> runs_;
    circle_groups groups_;
    circle_result out_;
};

} // namespace detail

/// Circles diagnosed as a ball-bar would: which errors make up the radial deviation of all runs, how large each
/// is with its 95 % interval, ranked by the circular error that it would leave alone. Runs clockwise and
/// counterclockwise, at two feeds or more, distinguish what one run does not (docs/circle.md). Throws bad_input
/// when the runs are none, or not of one source.
inline circle_result ball_bar(std::vector<circle_run> runs, const circle_options& options = {}) {
    if (runs.empty()) throw bad_input("", "no circle to diagnose");
    for (const circle_run& r : runs)
        if (r.source != runs[0].source)
            throw bad_input(r.file, "is of another kind than " + runs[0].file +
                                        ": encoders and an instrument are diagnosed apart");
    return detail::circle_diagnosis(std::move(runs), options)();
}

} // namespace quadrant::inline v0::diagnosis
