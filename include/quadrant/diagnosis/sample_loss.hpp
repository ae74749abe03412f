// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "signals.hpp"

namespace quadrant::diagnosis {

/// The commands that a drive acted on when each period keeps the previous one with probability p. Which periods those
/// were, the innovations tell: a lost command leaves a pulse of known shape and size in them. Row by row each period
/// gets its posterior weight (a Bernoulli mixture), and what it explains is taken out before the next row is judged; a
/// period in which the command hardly changed keeps the weight p, which is a mean delay of p periods. The noise is
/// that of the neighbourhood, a median over `window` rows: where a whole stretch is off, no pulse of it is evidence.
struct lossy_commands {
    std::vector<double> applied;
    double choices =
        0; ///< what it takes to say which periods were lost: sum of the weights' divergences from p [nats]
    double told = 0, lost = 0; ///< periods whose loss would stand out of the noise; how many of them were lost
    double mirrored =
        0; ///< how many would pass for lost with the pulse turned over, in what is left: chance and other causes
};

inline lossy_commands commands_with_loss(std::span<const double> command, const std::vector<double>& innovation,
                                         const std::vector<double>& response, std::size_t delay_rows,
                                         double p) {
    constexpr std::size_t window = 100;
    double size = 0;
    for (double h : response) size += h * h;
    lossy_commands found{{command.begin(), command.end()}};
    std::vector<double> left = innovation, pulse(command.size(), 0.0),
                        squares; // pulse: volts explained in each period
    for (int round = 0; round < 4;
         ++round) { // what is explained clears the view and lowers the noise for the next
        std::vector<double> variance;
        for (std::size_t from = 0; from < left.size(); from += window) {
            squares.clear();
            for (std::size_t k = from; k < std::min(left.size(), from + window); ++k)
                squares.push_back(left[k] * left[k]);
            variance.push_back(quantile(squares, 0.5) / 0.455 +
                               1e-30); // of a normal, from the median of its square
        }
        found.choices = found.told = found.lost = 0;
        for (std::size_t k = 1; k < command.size(); ++k) {
            const double step = found.applied[k - 1] - command[k];
            const std::size_t first = k + delay_rows + 1;
            if (first + response.size() > left.size()) break;
            double match = pulse[k] * size;
            for (std::size_t j = 0; j < response.size(); ++j) match += left[first + j] * response[j];
            const double full = step * step * size / (2 * variance[first / window]); // of a loss beyond doubt
            const double evidence = step * match / variance[first / window] - full;
            const double weight = 1 / (1 + (1 - p) / p * std::exp(-std::clamp(evidence, -50.0, 50.0)));
            found.applied[k] = command[k] + weight * step;
            if (full > 5) {
                ++found.told;
                found.lost += weight;
            }
            if (weight > 1e-9) found.choices += weight * std::log(weight / p);
            if (weight < 1 - 1e-9) found.choices += (1 - weight) * std::log((1 - weight) / (1 - p));
            const double more = weight * step - pulse[k];
            pulse[k] = weight * step;
            for (std::size_t j = 0; j < response.size(); ++j) left[first + j] -= more * response[j];
        }
        found.mirrored = 0;
        for (std::size_t k = 1; k + delay_rows + 1 + response.size() <= left.size(); ++k) {
            const double step = command[k] - command[k - 1], noise = variance[(k + delay_rows + 1) / window];
            const double full = step * step * size / (2 * noise);
            if (full <= 5) continue;
            double match = 0;
            for (std::size_t j = 0; j < response.size(); ++j)
                match += left[k + delay_rows + 1 + j] * response[j];
            found.mirrored +=
                1 / (1 + (1 - p) / p * std::exp(-std::clamp(step * match / noise - full, -50.0, 50.0)));
        }
    }
    return found;
}

} // namespace quadrant::diagnosis
