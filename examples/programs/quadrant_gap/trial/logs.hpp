// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"
#include "quadrant/diagnosis/effect/effect_record.hpp"
#include "random.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

/// How the machines of a trial are logged.
namespace quadrant_gap::trial {

enum class logs {
    plain,       ///< every row, fine counts, the command that was asked for
    coarse,      ///< counts of 1 to 20 um
    measured,    ///< the command column is what acts behind the amplifier, with noise; of a drive with loops of
                 ///< its own a column more
    gaps,        ///< rows are missing in up to four places
    jitter,      ///< stamps up to a fifth of a period off
    no_reference ///< position and command alone
};
inline constexpr std::array<std::string_view, 6> names_of_logs{"plain", "coarse", "measured",
                                                               "gaps",  "jitter", "no_reference"};
inline std::optional<logs> logs_named(std::string_view name) {
    const auto found = std::find(names_of_logs.begin(), names_of_logs.end(), name);
    if (found == names_of_logs.end()) return std::nullopt;
    return static_cast<logs>(found - names_of_logs.begin());
}

/// Whether a log of this kind holds anything of an effect: behind the amplifier nothing is seen of what acts on
/// the command, and without reference or asked command nothing of the controller. What is measured behind a
/// drive with loops of its own stands beside what the drive received.
inline bool shows(logs kind, const quadrant::diagnosis::effect& e) {
    const bool controller = e.box == "controller";
    if (kind == logs::measured) return !controller && e.joins != quadrant::diagnosis::joint::command;
    return kind != logs::no_reference || !controller;
}

/// Counts of 1 to 20 um: the gains come down until one count moves the command by at most a twentieth of its
/// range.
inline void make_coarse(axis_truth& a, double period, dice& random) {
    controller_truth& c = a.controller;
    a.encoder.resolution = random.one_of(std::vector<double>{1e-6, 2.5e-6, 5e-6, 1e-5, 2e-5});
    a.encoder.noise = a.encoder.resolution * random.log_uniform(0.05, 0.3);
    const double of_a_count = a.encoder.resolution / period * c.velocity_gain *
                              (c.two_sample_mean ? 0.5 : std::min(1.0, 2 * c.filter_Hz * period));
    const double less = std::clamp(0.05 * c.limit / of_a_count, 0.15, 1.0);
    for (double* gain : {&c.velocity_gain, &c.integral, &c.position_gain}) *gain *= less;
}

/// The rows that a log of `rows` holds.
inline std::vector<bool> rows_kept(logs kind, std::size_t rows, double period, dice random) {
    std::vector<bool> kept(rows, true);
    if (kind == logs::gaps)
        for (int n = random.whole(1, 4); n > 0; --n) {
            const auto length =
                std::max<std::size_t>(2, static_cast<std::size_t>(random.log_uniform(0.005, 0.5) / period));
            const auto first = static_cast<std::size_t>(random.uniform() * static_cast<double>(rows));
            std::fill_n(kept.begin() + static_cast<std::ptrdiff_t>(first), std::min(length, rows - first),
                        false);
        }
    kept.front() = true;
    return kept;
}

} // namespace quadrant_gap::trial
