// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "linear_past.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>

namespace quadrant::inline v0::diagnosis {

/// What a drive that loses commands is taken to do: in each period it keeps the command before with this
/// probability.
struct loss_assumption {
    double probability = 0.05;
    bool learned = false; ///< the probability is only where to begin
    double size =
        1; ///< of a pulse, in those of a lost command: others, or turned over, are no losses and show chance
};

/// The commands that a drive acted on when it lost some, as the innovations show it; see lost_commands.
struct lossy_commands {
    std::vector<double> applied;
    double probability = 0;
    double choices =
        0; ///< what it takes to say which periods were lost: sum of the weights' divergences from p [nats]
    double told = 0;                     ///< periods whose loss would stand out of the noise
    double gain = 0;                     ///< log-likelihood over the same periods without a loss [nats]
    std::vector<double> gain_by_place{}; ///< the same, for each 500 rows
};

/// A lost command leaves a pulse of known shape in the innovations, as large as the command's step. In a closed
/// loop the sensor's noise is in the step and in the innovation, and so is every linear error of the model:
/// what follows linearly from the past is taken out first (linear_past), and with it the mean of the losses. In
/// what is left each period either kept its command or lost it; pulses overlap, so that the histories are
/// followed side by side, row by row, and the likeliest `abreast` of them are kept (M-algorithm
/// [Anderson1984]). The weight of a loss is the share of the histories that have it, `lag` rows later. What is
/// explained is taken out of the innovations, so that the past is found anew without the pulses, a few times
/// over. Noise is normal but for a share of outliers (Cauchy, three times as wide), its size that of the
/// neighbourhood, a median over `window` rows. A command that hardly changed says nothing: its weight stays p.
class lost_commands {
public:
    /// `response`: innovations after one volt too much in one period, to where it has died away;
    /// `reading_noise`: least standard deviation of the position [m].
    static lossy_commands find(std::span<const double> command, std::span<const double> innovation,
                               const std::vector<double>& response, std::size_t delay_rows,
                               double reading_noise, const loss_assumption& a);

private:
    static constexpr std::size_t window = 100, abreast = 16, lag = 24,
                                 reach = 32; ///< reach: rows of a pulse at most
    static constexpr double stands_out = 2;  ///< times the noise that a loss would have to be

    /// One way that it may have been: which of the last periods were lost, and what is still to come of their
    /// pulses.
    struct history {
        double score = 0, applied = 0;
        std::uint64_t lost = 0;
        std::array<double, reach> to_come{};
        double share = 0; ///< likelihood, that of the best is 1
    };
    /// A history with one row more, before it is known to be worth keeping.
    struct branch {
        const history* from;
        double score, expected; ///< of the row that its pulses make
        std::uint64_t lost;
        double pulse; ///< of this row's command
    };

    lost_commands(std::span<const double> command, std::span<const double> innovation,
                  const std::vector<double>& response, std::size_t delay_rows, double reading_noise,
                  const loss_assumption& a);

    /// Of a normal, from the median of its square.
    static std::vector<double> neighbourhood(std::span<const double> e, double least);
    static double log_density(double x);

    void take_out_the_past();

    bool shows(double step, std::size_t k) const;

    /// The histories row by row; the weights of the rows that are `lag` behind.
    void follow();

    /// One history becomes two where a loss would show.
    void go_on(const history& h, std::size_t k, std::vector<branch>& out) const;
    history grown(const branch& b, std::size_t k) const;

    /// The commands and pulses of the weights, and how many were lost of those whose loss would show.
    void count();

    /// The likeliest first. Histories that agree for as long as a pulse lasts are one.
    static void keep_the_likeliest(std::vector<branch>& of);

    lossy_commands found() const;

    std::span<const double> command_, innovation_;
    const std::vector<double>& response_;
    std::size_t first_;
    double reading_noise_;
    loss_assumption a_;
    double p_, used_ = p_;
    std::size_t from_, end_;
    std::vector<double> step_, pulse_, held_, left_, gain_, weight_;
    std::vector<double> variance_{}, shape_{};
    double energy_ = 0, told_ = 0;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "sample_loss.ipp"
#endif
