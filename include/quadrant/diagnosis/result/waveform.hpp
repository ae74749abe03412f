// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// The form of a signal that is added to a command.
enum class waveform_form : unsigned char { constant, square, pattern, tone, chirp, unknown };

/// The form's word in files.
constexpr std::string_view name_of(waveform_form form) {
    switch (form) {
    case waveform_form::constant:
        return "constant";
    case waveform_form::square:
        return "square";
    case waveform_form::pattern:
        return "pattern";
    case waveform_form::tone:
        return "tone";
    case waveform_form::chirp:
        return "chirp";
    default:
        return "unknown";
    }
}

/// A signal that is added to the command of a controller in parts of a record: when, and by which numbers.
struct added_waveform {
    /// A level that is held.
    struct level {
        double value = 0;      ///< [V]
        double duration_s = 0; ///< of one that repeats, the mean
        double from_s = 0;     ///< where it begins first
    };
    waveform_form form = waveform_form::unknown;
    double from_s = 0, to_s = 0; ///< first and last time at which it is not zero
    bool from_start = false, to_end = false;
    double rms = 0;              ///< between these times [V]
    double period_s = 0;         ///< of levels that repeat
    std::vector<level> levels{}; ///< of a constant in parts, each part; of a square or pattern, one period
    double amplitude = 0;        ///< of a tone or chirp [V]
    double frequency_Hz = 0;     ///< of a tone; of a chirp where it begins
    double sweep_Hz_per_s = 0;   ///< of a chirp
    double phase_rad = 0;        ///< amplitude sin(2 pi (frequency t + sweep t^2 / 2) + phase), t from `from_s`
    std::vector<double> values{}; ///< one a row [V]
    double sample_period_s = 0;   ///< of `values`
};

} // namespace quadrant::inline v0::diagnosis
