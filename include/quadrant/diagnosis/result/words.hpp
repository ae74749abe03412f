// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "waveform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// When a waveform is there: "from 1.2 s on", "from 1.2 s to 5 s".
inline std::string times_of(const added_waveform& w) {
    if (w.from_start && w.to_end) return "over the whole record";
    if (w.to_end) return fmt::format("from {:.4g} s on", w.from_s);
    if (w.from_start) return fmt::format("up to {:.4g} s", w.to_s);
    return fmt::format("from {:.4g} s to {:.4g} s", w.from_s, w.to_s);
}

/// Levels that repeat, without their times.
inline std::string square_in_words(const added_waveform& w, std::string_view unit) {
    double size = 0, on = 0, off = 0, signs = 0;
    for (const auto& l : w.levels) {
        if (std::abs(l.value) > std::abs(size)) size = l.value;
        if (l.value != 0) {
            on = l.duration_s;
            ++signs;
        } else {
            off = l.duration_s;
        }
    }
    const bool both = signs == 2;
    const std::string level =
        both ? fmt::format("+-{:.3g} {}", std::abs(size), unit) : fmt::format("{:+.3g} {}", size, unit);
    const char* const what = on < 0.1 * w.period_s ? "pulses" : "a square wave";
    if (off > 0) return fmt::format("{} of {}, {:.4g} s on and {:.4g} s off", what, level, on, off);
    return fmt::format("a square wave of {}, {:.4g} s each way", level, on);
}

} // namespace detail

/// A waveform as a part of a sentence: "a square wave of +-2 V, 0.3 s on and 0.7 s off, is added to the
/// command from 1.2 s on".
inline std::string in_words(const added_waveform& w, std::string_view unit) {
    const std::string when = detail::times_of(w);
    const auto added = [&](const std::string& what) {
        return fmt::format("{} {} added to the command {}", what, what.starts_with("pulses") ? "are" : "is",
                           when);
    };
    switch (w.form) {
    case waveform_form::square:
        return added(detail::square_in_words(w, unit) + ",");
    case waveform_form::pattern:
        return added(fmt::format("a pattern of {} levels that repeats every {:.4g} s, {:.3g} {} rms,",
                                 w.levels.size(), w.period_s, w.rms, unit));
    case waveform_form::tone:
        return added(fmt::format("a tone of {:.5g} Hz and {:.3g} {}", w.frequency_Hz, w.amplitude, unit));
    case waveform_form::chirp: {
        const double last = w.frequency_Hz + w.sweep_Hz_per_s * (w.to_s - w.from_s);
        return added(fmt::format("a sweep from {:.4g} Hz to {:.4g} Hz of {:.3g} {}", w.frequency_Hz, last,
                                 w.amplitude, unit));
    }
    case waveform_form::constant: {
        if (w.levels.size() == 1)
            return added(fmt::format("a constant of {:+.3g} {}", w.levels[0].value, unit));
        std::string parts;
        for (const auto& l : w.levels)
            parts +=
                fmt::format("{}{:+.3g} {} from {:.4g} s", parts.empty() ? "" : ", ", l.value, unit, l.from_s);
        return added(fmt::format("a constant in parts ({})", parts));
    }
    default:
        return added(fmt::format("a waveform without a simple form, {:.3g} {} rms,", w.rms, unit));
    }
}

} // namespace quadrant::inline v0::diagnosis
