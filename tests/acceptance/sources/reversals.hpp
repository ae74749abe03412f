// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

namespace sources {

/// Largest following error between a reversal of the reference and half the way to the next one, mean over
/// the reversals [m]. The motion before the first reversal is left out.
inline double reversal_error(std::span<const double> reference, std::span<const double> position) {
    std::vector<std::size_t> turns;
    double before = 0;
    for (std::size_t k = 1; k < reference.size(); ++k) {
        const double step = reference[k] - reference[k - 1];
        if (step * before < 0) turns.push_back(k);
        if (step != 0) before = step;
    }
    turns.push_back(reference.size());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
        double peak = 0;
        for (std::size_t k = turns[i]; k < (turns[i] + turns[i + 1]) / 2; ++k)
            peak = std::max(peak, std::abs(reference[k] - position[k]));
        sum += peak;
    }
    return turns.size() > 1 ? sum / static_cast<double>(turns.size() - 1) : 0;
}

/// Per axis: the reversal error of the log, and of the closed loop that the machine file describes.
inline nlohmann::ordered_json reversals(const std::filesystem::path& machine,
                                        const std::filesystem::path& log) {
    using namespace quadrant::diagnosis;
    const auto described = read_machine(machine);
    std::ifstream file(log);
    const auto logged = read_log(file, log.string());
    nlohmann::ordered_json out;
    for (const simulated_axis& a : simulate(described, logged).axes)
        for (const axis_log& l : logged.axes)
            if (l.name == a.name && a.closed_loop)
                out[a.name] = {{"log_m", reversal_error(l.reference, l.position)},
                               {"simulated_m", reversal_error(l.reference, a.position)}};
    return out;
}

} // namespace sources
