// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "linear_past.hpp"
#include "signals.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace quadrant::diagnosis {

/// What a drive that loses commands is taken to do: in each period it keeps the command before with this probability.
struct loss_assumption {
    double probability = 0.05;
    bool learned = false; ///< the probability is only where to begin
    double size =
        1; ///< of a pulse, in those of a lost command: others, or turned over, are no losses and show chance
};

/// The commands that a drive acted on when it lost some, as the innovations tell it; see lost_commands.
struct lossy_commands {
    std::vector<double> applied;
    double probability = 0;
    double choices =
        0; ///< what it takes to say which periods were lost: sum of the weights' divergences from p [nats]
    double told = 0;           ///< periods whose loss would stand out of the noise
    double gain = 0;           ///< log-likelihood over the same periods without a loss [nats]
    double gain_elsewhere = 0; ///< the same without the twentieth of the record where it is largest
};

/// A lost command leaves a pulse of known shape in the innovations, as large as the command's step. In a closed loop the
/// sensor's noise is in the step and in the innovation, and so is every linear error of the model: what follows linearly from
/// the past is taken out first (linear_past). What is left is matched with the pulse in units of the step: 0 of a period that
/// was kept, 1 of one that was lost, beside noise that is normal but for a share of strangers (Cauchy, three times as wide). Each
/// period gets its posterior weight, those that explain most first; what is explained is taken out of the innovations, so
/// that the past is found anew without the pulses, a few times over. Where the command hardly changed the weight stays p,
/// a mean delay of p periods. The noise is that of the neighbourhood, a median over `window` rows.
class lost_commands {
public:
    /// `response`: innovations after one volt too much in one period, to where it has died away; `reading_noise`: least standard
    /// deviation of the position [m].
    static lossy_commands find(std::span<const double> command, std::span<const double> innovation,
                               const std::vector<double>& response, std::size_t delay_rows,
                               double reading_noise, const loss_assumption& a) {
        lost_commands search(command, innovation, response, delay_rows, reading_noise, a);
        for (int round = 0; round < 6 && search.end_ > search.from_; ++round) {
            search.take_out_the_past();
            for (int sweep = 0; sweep < 2; ++sweep) search.weigh();
        }
        return search.found();
    }

private:
    static constexpr std::size_t window = 100;
    static constexpr double stands_out = 2; ///< times the noise that a loss would have to be

    lost_commands(std::span<const double> command, std::span<const double> innovation,
                  const std::vector<double>& response, std::size_t delay_rows, double reading_noise,
                  const loss_assumption& a)
        : command_(command), innovation_(innovation), response_(response), first_(delay_rows + 1),
          reading_noise_(reading_noise), a_(a), p_(a.probability),
          from_(window + linear_past::first + delay_rows),
          end_(command.size() > first_ + response.size() ? command.size() - first_ - response.size() : 0),
          step_(command.size(), 0.0), pulse_(step_), unsure_(step_), held_(step_), left_(step_), gain_(step_),
          weight_(command.size(), a.probability), cleared_(innovation.begin(), innovation.end()) {
        for (std::size_t k = 1; k < step_.size(); ++k) step_[k] = command[k - 1] - command[k];
        variance_ = neighbourhood(cleared_, 0);
    }

    static double square(double x) { return x * x; }
    /// Of a normal, from the median of its square.
    static std::vector<double> neighbourhood(const std::vector<double>& e, double least) {
        std::vector<double> out, squares;
        for (std::size_t from = 0; from < e.size(); from += window) {
            squares.clear();
            for (std::size_t k = from; k < std::min(e.size(), from + window); ++k)
                squares.push_back(square(e[k]));
            out.push_back(std::max(least, quantile(squares, 0.5) / 0.455) + 1e-30);
        }
        return out;
    }
    static double strange(double x) { return 1 / (3 * std::numbers::pi * (1 + x * x / 9)); }
    double density(double x) const {
        return (1 - strangers_) * std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi) +
               strangers_ * strange(x) + 1e-300;
    }

    void take_out_the_past() {
        std::copy(innovation_.begin(), innovation_.end(), cleared_.begin());
        for (std::size_t k = from_; k < end_; ++k)
            for (std::size_t j = 0; pulse_[k] != 0 && j < response_.size(); ++j)
                cleared_[k + first_ + j] -= pulse_[k] * response_[j];
        std::vector<double> trust(left_.size());
        for (std::size_t k = 0; k < trust.size(); ++k)
            trust[k] = 1 / (variance_[k / window] + square(left_[k]) / 9);
        const auto past = linear_past::of(cleared_, step_, trust, from_);
        left_ = past.left(cleared_, step_, from_);
        least_variance_ = square(reading_noise_) * past.noise_gain();
        shape_ = past.left(response_);
        const double whole = std::inner_product(shape_.begin(), shape_.end(), shape_.begin(), 0.0);
        std::size_t rows = 0; // those that hold nearly all of it
        for (energy_ = 0; rows < shape_.size() && energy_ < 0.999 * whole; ++rows)
            energy_ += square(shape_[rows]);
        shape_.resize(rows);
        overlap_.assign(rows, 0.0);
        for (std::size_t apart = 0; apart < rows; ++apart)
            for (std::size_t j = 0; j + apart < rows; ++j)
                overlap_[apart] += shape_[j] * shape_[j + apart] / energy_;
    }

    /// What one period looks like beside what the others explain.
    struct view {
        double step = 0;           ///< to the command that a lost one leaves acting [V]
        double match = 0;          ///< of the pulse in what is left [V]
        double kept = 0, lost = 0; ///< how far that is from either, in its noise
        double weight = 0, pulse = 0;
        bool stands_out = false;
    };
    view look(std::size_t k) const {
        double noise = variance_[(k + first_) / window] / energy_;
        for (std::size_t apart = 1; apart < overlap_.size(); ++apart)
            noise += square(overlap_[apart]) * (unsure_[k - apart] + unsure_[k + apart]);
        const double sigma = std::sqrt(noise) * wider_;
        view v{.step = a_.size * step_[k] + held_[k - 1], .weight = p_};
        v.stands_out = std::abs(v.step) > stands_out * sigma;
        if (!v.stands_out) return v;
        v.match = pulse_[k];
        for (std::size_t j = 0; j < shape_.size(); ++j) v.match += left_[k + first_ + j] * shape_[j] / energy_;
        v.kept = (v.match + p_ * v.step) / sigma; // the mean loss is gone with the past
        v.lost = v.kept - v.step / sigma;
        v.weight = 1 / (1 + (1 - p_) / p_ * density(v.kept) / density(v.lost));
        v.pulse = (v.weight - p_) * v.step;
        return v;
    }
    void take(std::size_t k, const view& v) {
        unsure_[k] = v.weight * (1 - v.weight) * square(v.step);
        held_[k] = v.weight * v.step;
        weight_[k] = v.weight;
        const double more = v.pulse - pulse_[k];
        pulse_[k] = v.pulse;
        for (std::size_t j = 0; more != 0 && j < shape_.size(); ++j) left_[k + first_ + j] -= more * shape_[j];
    }

    /// Every period once, those first whose pulse takes most out of what is left: a neighbour of a lost one looks lost by half.
    void weigh() {
        variance_ = neighbourhood(left_, least_variance_);
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t k = from_; k < end_; ++k) {
            const view v = look(k);
            if (v.pulse == 0 && pulse_[k] == 0)
                take(k, v);
            else
                order.emplace_back((square(v.match - v.pulse) - square(v.match - pulse_[k])) /
                                       variance_[(k + first_) / window],
                                   k);
        }
        std::sort(order.begin(), order.end());
        for (const auto& [gain, k] : order) take(k, look(k));
        told_ = 0;
        double lost = 0, strange_ones = 0;
        std::vector<double> kept;
        std::fill(gain_.begin(), gain_.end(), 0.0);
        for (const auto& [gain, k] : order) {
            const view v = look(k);
            if (!v.stands_out) continue;
            ++told_;
            lost += v.weight;
            strange_ones += strangers_ * ((1 - v.weight) * strange(v.kept) / density(v.kept) +
                                          v.weight * strange(v.lost) / density(v.lost));
            if (v.weight < 0.5) kept.push_back(std::abs(v.kept) * wider_);
            gain_[k] = std::log(1 - p_ + p_ * density(v.lost) / density(v.kept));
        }
        used_ = p_;
        if (told_ == 0) return;
        if (a_.learned) p_ = std::clamp(lost / told_, 1e-4, 0.5);
        strangers_ = std::clamp(strange_ones / told_, 1e-3, 0.3);
        wider_ = std::max(1.0, quantile(kept, 0.5) / 0.675);
    }

    lossy_commands found() const {
        lossy_commands out{.applied = {command_.begin(), command_.end()}, .probability = p_, .told = told_};
        std::vector<double> by_place(command_.size() / (5 * window) + 1, 0.0);
        for (std::size_t k = from_; k < end_; ++k) {
            out.applied[k] += held_[k];
            out.gain += gain_[k];
            by_place[k / (5 * window)] += gain_[k];
            const double q = weight_[k];
            if (q > 1e-9) out.choices += q * std::log(q / used_);
            if (q < 1 - 1e-9) out.choices += (1 - q) * std::log((1 - q) / (1 - used_));
        }
        std::sort(by_place.rbegin(), by_place.rend());
        out.gain_elsewhere = std::accumulate(
            by_place.begin() + static_cast<std::ptrdiff_t>(by_place.size() / 20 + 1), by_place.end(), 0.0);
        return out;
    }

    std::span<const double> command_, innovation_;
    const std::vector<double>& response_;
    std::size_t first_;
    double reading_noise_;
    loss_assumption a_;
    double p_, used_ = p_;
    std::size_t from_, end_;
    std::vector<double> step_, pulse_, unsure_, held_, left_, gain_, weight_, cleared_;
    std::vector<double> variance_{}, shape_{}, overlap_{};
    double energy_ = 0, least_variance_ = 0, strangers_ = 0.1, wider_ = 1, told_ = 0;
};

} // namespace quadrant::diagnosis
