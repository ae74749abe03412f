// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../control/sliding_mode.hpp"
#include "frf.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <cstdlib>
#include <vector>

/// Tuning of a `sliding_mode` law by fuzzy rules on how a trial went: its gain Ks and adaptation rho, step by
/// step; sliding stays.
/// Source: [Yeung2006] section 3; max-min composition and centroid [Mamdani1975].
namespace quadrant::inline v0::analysis {

/// How a trial went.
struct tuning_trial {
    double oscillation = 0;                ///< OSC: `oscillation_index` of the command
    double phase_margin = 0;               ///< PHM [deg]; NaN: none, or the loop is not stable
    quantity<si::length> tracking_error{}; ///< TRE: the largest
};

/// The five sets of each attribute, in the order of the source.
enum class tuning_state : std::size_t {
    highly_under, ///< HIUN: far too little stability; of the tracking error: EL, extremely large
    little_under, ///< LIUN; LA, large
    acceptable,   ///< ACCP; ME, medium
    little_over,  ///< LIOQ: more stability than needed; SM, small
    highly_over   ///< HIOQ; OK
};

namespace detail {
/// Membership of a set in the five input sets and in the seven output sets NL ... PL.
constexpr double as_input(std::size_t set, std::size_t in) {
    constexpr std::array<double, 5> by_distance{1, 0.7, 0.3, 0, 0};
    return by_distance[set > in ? set - in : in - set];
}
constexpr double as_output(int set, int in) { return 1 - 0.1 * (set > in ? set - in : in - set); }

/// One attribute: for each of its states the output set of both gains, -3 (NL) ... 3 (PL).
struct tuning_rule {
    int gain, adaptation;
};
using tuning_rules = std::array<tuning_rule, 5>;
inline constexpr std::array<tuning_rules, 3> rules{{{{{-3, -1}, {-2, 0}, {0, 0}, {1, 0}, {2, 1}}},   // OSC
                                                    {{{-2, -2}, {-1, -2}, {0, 0}, {0, 1}, {1, 2}}},  // PHM
                                                    {{{-1, -3}, {0, -2}, {1, 3}, {1, 1}, {0, 0}}}}}; // TRE

/// Relation of five rules (max of the min of input and output row), a state put through it (max-min), centroid.
constexpr double inferred(const tuning_rules& of, int tuning_rule::*which, std::size_t state) {
    const auto membership = [&](int out) {
        double most = 0;
        for (std::size_t in = 0; in < 5; ++in) {
            double relation = 0;
            for (std::size_t rule = 0; rule < 5; ++rule)
                relation = std::max(relation, std::min(as_input(rule, in), as_output(of[rule].*which, out)));
            most = std::max(most, std::min(as_input(state, in), relation));
        }
        return most;
    };
    double moment = 0, sum = membership(0); // in pairs, so that what is even comes out at 0
    for (int out = 1; out <= 3; ++out) {
        const double more = membership(out), less = membership(-out);
        moment += out * (more - less), sum += more + less;
    }
    return moment / sum;
}
} // namespace detail

/// By which share Ks and rho change.
struct tuning_action {
    double gain = 0, adaptation = 0;
};
/// What each attribute (OSC, PHM, TRE) asks for in each of its states: the decision table, out of the rules.
inline constexpr std::array<std::array<tuning_action, 5>, 3> decision_table = [] {
    std::array<std::array<tuning_action, 5>, 3> table{};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t s = 0; s < 5; ++s)
            table[a][s] = {detail::inferred(detail::rules[a], &detail::tuning_rule::gain, s),
                           detail::inferred(detail::rules[a], &detail::tuning_rule::adaptation, s)};
    return table;
}();

/// Where the sets end: Table 2 of the source. Its index of oscillation takes a threshold frequency and a scale
/// that it does not print; 50 Hz and 2000 put all three of the gains that it tuned (Table 9) into the
/// acceptable sets.
struct tuning_limits {
    std::array<double, 4> oscillation{1, 0.75, 0.5,
                                      0.25};            ///< falling: above the first HIUN, below the last HIOQ
    std::array<double, 4> phase_margin{30, 40, 45, 60}; ///< [deg], rising: below the first or none HIUN
    std::array<double, 4> tracking_error{20e-3, 5e-3, 1e-3, 0.1e-3}; ///< [m], falling: above the first EL
};

/// A trial as states of OSC, PHM, TRE. Without a phase margin the tracking error is EL: it is that of a limit
/// cycle.
inline std::array<tuning_state, 3> classified(const tuning_trial& t, const tuning_limits& limits = {}) {
    const auto falling = [](double x, const std::array<double, 4>& ends) {
        std::size_t set = 0;
        while (set < 4 && !(x >= ends[set])) ++set; // NaN is the last: refused by tune()
        return tuning_state(set);
    };
    std::size_t set = 0;
    while (set < 4 && t.phase_margin >= limits.phase_margin[set]) ++set; // NaN: HIUN
    const bool stable = t.phase_margin > 0;
    return {falling(t.oscillation, limits.oscillation), tuning_state(set),
            stable ? falling(t.tracking_error.value(), limits.tracking_error) : tuning_state::highly_under};
}
/// What a trial asks for: the sum of the actions of its three attributes.
inline tuning_action action(const std::array<tuning_state, 3>& states) {
    tuning_action sum;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto& one = decision_table[a][static_cast<std::size_t>(states[a])];
        sum.gain += one.gain, sum.adaptation += one.adaptation;
    }
    return sum;
}

/// Gains of a `sliding_mode`, and how the trial with them went.
template <signal_tag Command = signal::voltage> struct tuning_step {
    gain_of<Command, signal::velocity> gain;
    gain_of<Command, signal::position> adaptation;
    tuning_trial trial{};
    std::array<tuning_state, 3> states{};
};
/// Every trial of a tuning, in order, and whether it came to an end.
template <signal_tag Command = signal::voltage> struct tuning_result {
    std::vector<tuning_step<Command>> steps; ///< the first with the start, the last with the gains tuned
    bool settled = false;                    ///< the last trial asks for no change
};

/// Tries, judges and changes both gains, K (1 + sum of the three actions), until no attribute asks for a
/// change. trial(gain, adaptation) gives a tuning_trial: of a simulation (`feed_drive`) or of a machine whose
/// first gains are safe. Throws for gains that are not above 0, limits out of order, and a trial that is not
/// finite (phase margin excepted).
template <signal_tag Command, class Trial>
tuning_result<Command> tune(const typename sliding_mode<double, Command>::parameters& start, const Trial& trial,
                            const tuning_limits& limits = {}, int most_trials = 50) {
    require_positive("tune.gain", start.gain);
    require_positive("tune.adaptation", start.adaptation);
    require(most_trials > 0, "tune.most_trials", most_trials, "must be above 0");
    for (std::size_t i = 1; i < 4; ++i) {
        require(limits.oscillation[i] < limits.oscillation[i - 1], "tune.limits.oscillation",
                limits.oscillation[i], "must fall");
        require(limits.phase_margin[i] > limits.phase_margin[i - 1], "tune.limits.phase_margin",
                quadrant::detail::in_unit(limits.phase_margin[i], " degrees"), "must rise");
        require(limits.tracking_error[i] < limits.tracking_error[i - 1], "tune.limits.tracking_error",
                limits.tracking_error[i], "must fall");
    }
    tuning_result<Command> result;
    tuning_step<Command> now{start.gain, start.adaptation};
    while (true) {
        now.trial = trial(now.gain, now.adaptation);
        require_finite("tune.trial.oscillation", now.trial.oscillation);
        require_finite("tune.trial.tracking_error", now.trial.tracking_error);
        now.states = classified(now.trial, limits);
        result.steps.push_back(now);
        const auto change = action(now.states);
        // The table's zeros are sums of equal terms with opposite signs: rounding.
        result.settled = std::abs(change.gain) < 1e-9 && std::abs(change.adaptation) < 1e-9;
        if (result.settled || result.steps.size() == std::size_t(most_trials)) return result;
        now.gain = now.gain * (1 + change.gain);
        now.adaptation = now.adaptation * (1 + change.adaptation);
    }
}

/// OSC = scale (Hmax - Hmean)/(Lmax - Lmean): by how much a peak in the power spectrum of the command above
/// `threshold` stands out, beside that below it. The mean of the command is left out. Threshold and scale are
/// not printed in the source.
inline double oscillation_index(const std::vector<double>& command, duration period, frequency threshold,
                                double scale = 2000) {
    require_below_nyquist("oscillation_index.threshold", threshold, period);
    std::size_t size = 2;
    while (size < command.size()) size *= 2;
    double mean = 0;
    for (const double u : command) mean += u / double(command.size());
    std::vector<complex> bins(size);
    for (std::size_t k = 0; k < command.size(); ++k) bins[k] = command[k] - mean;
    fft(bins);
    struct part {
        double most = 0, sum = 0, count = 0;
        double peak() const { return most - sum / count; }
    } low, high;
    for (std::size_t i = 1; i < size / 2; ++i) {
        part& in = double(i) / (double(size) * period.value()) > threshold.value() ? high : low;
        const double power = std::norm(bins[i]);
        in.most = std::max(in.most, power), in.sum += power, in.count += 1;
    }
    require(low.peak() > 0 && high.count > 0, "oscillation_index.command", double(command.size()),
            "must be long enough for lines below and above the threshold, and not constant (samples)");
    return scale * high.peak() / low.peak();
}

} // namespace quadrant::inline v0::analysis
