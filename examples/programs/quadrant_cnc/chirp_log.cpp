// SPDX-License-Identifier: BSL-1.0
// From a log with a chirp in it to a frequency response with its coherence.
#include "chirp_log.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/diagnosis/read_log.hpp>

#include <algorithm>

namespace quadrant_cnc {

namespace an = quadrant::analysis;
namespace signal = quadrant::signal;
using quadrant::in_si;
using quadrant::diagnosis::bad_input;

namespace {

/// The lines that were excited and are coherent.
an::measured_frf trusted(const an::measured_frf& all, double half_rate, std::size_t& left_out) {
    an::measured_frf out{{}, all.averages};
    for (const auto& l : all.lines)
        if (l.f.value() > half_rate * (1 - 1e-9))
            break;
        else if (l.coherence >= least_coherence && l.value != 0.0)
            out.lines.push_back(l);
        else
            ++left_out;
    return out;
}

} // namespace

frf_file frf_of_log(const std::string& path, const std::string& axis, double servo_period) {
    const auto log = quadrant::diagnosis::read_log(std::filesystem::path(path));
    const auto found =
        std::find_if(log.axes.begin(), log.axes.end(), [&](const auto& a) { return a.name == axis; });
    if (found == log.axes.end()) throw bad_input(path, fmt::format("has no axis {}", axis));
    if (std::abs(log.sample_period_s / servo_period - 1) > 1e-3)
        throw bad_input(path,
                        fmt::format("t_s: a sample lasts {:.9g} s, the servo period of the machine is {:.9g} s",
                                    log.sample_period_s, servo_period));
    const auto& reference = found->reference;
    const auto& position = found->position;
    const auto& command = found->command;
    constexpr std::size_t least_window = 256, most_window = 8192, windows = 8;
    std::size_t window = least_window;
    while (window < most_window && 2 * window * windows <= 2 * position.size()) window *= 2;
    if (position.size() < 2 * window)
        throw bad_input(path, fmt::format("holds {} samples: a response needs {} or more", position.size(),
                                          2 * least_window));
    const auto T = in_si(servo_period);
    const an::frf<signal::position, signal::position>::parameters how{.samples = window};
    an::frf<signal::position, signal::position> to_position({how.samples, how.overlap, how.shape, how.remove},
                                                            T);
    an::frf<signal::position, signal::voltage> to_command({how.samples, how.overlap, how.shape, how.remove}, T);
    an::frf<signal::voltage, signal::position> of_command({how.samples, how.overlap, how.shape, how.remove}, T);
    const auto [low, high] = std::minmax_element(reference.begin(), reference.end());
    const bool asked = *high > *low;
    for (std::size_t k = 0; k < position.size(); ++k) {
        const quadrant::quantity_of<signal::position> r = in_si(reference[k]), x = in_si(position[k]);
        const quadrant::quantity_of<signal::voltage> u = in_si(command[k]);
        if (asked)
            to_position.add(r, x), to_command.add(r, u);
        else
            of_command.add(u, x);
    }
    frf_file out{.file = path, .frf = {}, .coherence = true, .notes = {}};
    std::size_t left_out = 0;
    try {
        out.frf = trusted(asked ? an::ratio(to_position.result(), to_command.result()) : of_command.result(),
                          0.5 / servo_period, left_out);
    } catch (const quadrant::invalid_parameter& fault) {
        throw bad_input(path, fault.what());
    }
    constexpr std::size_t least_lines = 10;
    if (out.frf.lines.size() < least_lines)
        throw bad_input(path,
                        fmt::format("{} of {} frequencies have a coherence of {} or more: a response needs {}; "
                                    "let the chirp be larger or longer",
                                    out.frf.lines.size(), out.frf.lines.size() + left_out, least_coherence,
                                    least_lines));
    out.notes.push_back(fmt::format("Response from {} samples, windows of {}, {} averages; {} frequencies "
                                    "whose coherence is below {} are left "
                                    "out.",
                                    position.size(), window, out.frf.averages, left_out, least_coherence));
    if (!asked)
        out.notes.push_back(
            "The reference rests in this log, so the response is that from command to position. Noise "
            "of the encoder in the loop bends it where the coherence is low.");
    return out;
}

std::string frf_table(const frf_file& of) {
    std::string out = "frequency_Hz,real_m_per_V,imag_m_per_V,coherence\n";
    for (const auto& l : of.frf.lines)
        out += fmt::format("{},{},{},{}\n", l.f.value(), l.value.real(), l.value.imag(), l.coherence);
    return out;
}

} // namespace quadrant_cnc
