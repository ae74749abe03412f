// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "controller_box.hpp"

#include <random>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Whether a column holds whole counts, so far as its digits show. `count`: 0 where it is not known.
inline bool in_whole_counts(std::span<const double> x, double step, double count) {
    return count > 0 && step <= 1.001 * count && std::all_of(x.begin(), x.end(), [&](double v) {
               const double off = std::abs(v - std::round(v / count) * count);
               return off <= 0.501 * step + 1e-12 * std::abs(v);
           });
}

/// The log as the controller had it, with the rounding that its columns still carry. Numbers in whole counts
/// were not rounded when they were written, and are put back on the count. A reference whose last digit is a
/// count would always pass, so its digits have to be finer.
inline axis_log as_controlled(axis_log log, double count) {
    const auto put_on_counts = [&](std::vector<double>& column, double& step) {
        for (double& v : column) v = std::round(v / count) * count;
        step = 0;
    };
    if (in_whole_counts(log.position, log.position_step, count)) put_on_counts(log.position, log.position_step);
    if (log.reference_step <= 0.5 * count && in_whole_counts(log.reference, log.reference_step, count))
        put_on_counts(log.reference, log.reference_step);
    return log;
}

/// A difference at row k without what the sign of the reference's velocity makes of it where rounding of the
/// column decides that sign: by one or two Coulomb feedforwards the command may then be off. What is no
/// multiple of it to a quarter of one has another reason and stays.
inline double but_for_the_sign(double difference, double coulomb_feedforward, std::size_t k,
                               const axis_log& log) {
    if (std::abs(log.reference[k] - log.reference[k - 1]) > log.reference_step) return difference;
    for (const double signs : {-2.0, -1.0, 1.0, 2.0})
        if (const double other = difference + signs * coulomb_feedforward;
            std::abs(other) < 0.25 * std::abs(coulomb_feedforward) && std::abs(other) < std::abs(difference))
            return other;
    return difference;
}

/// The step of the converter behind a controller [V]; 0: none is described.
inline double dac_step(const actuator_description& a) {
    return a.dac_bits && a.dac_range_V ? *a.dac_range_V / std::exp2(*a.dac_bits) : 0;
}

/// Replays of one logged controller box: every controller is compared with the same log.
class replay_box {
public:
    replay_box(const axis_log& log, const actuator_description& actuator, const axis_record& record)
        : replay_box(log, actuator, record.period, record.score.block, record.score.block) {}
    replay_box(const axis_log& log, const actuator_description& actuator, double period, std::size_t from,
               std::size_t block)
        : log_(log), actuator_(actuator), smooth_(actuator), period_(period),
          from_(std::min(from, log.command.size())), block_(block) {
        smooth_.dac_bits.reset();
        unlimited_ = smooth_;
        unlimited_.limit_V.reset();
    }

    const axis_log& log() const { return log_; }
    const actuator_description& actuator() const { return actuator_; }
    double period() const { return period_; }
    std::size_t from() const { return from_; } ///< first row that is compared
    void skip_to(std::size_t row) { from_ = std::max(from_, std::min(row, log_.command.size())); }
    std::size_t block() const { return block_; }

    std::vector<double> replay(const controller_description& c) const {
        return replay_controller(c, actuator_, period_, loop_columns::of(log_));
    }
    /// The same without the converter, so that it follows a small change of a value.
    std::vector<double> smooth(const controller_description& c) const {
        return replay_controller(c, smooth_, period_, loop_columns::of(log_));
    }
    /// The same without the limit: an integral that adds up a wrong value for the whole record then follows a
    /// change of that value in proportion, where the limit would hold it.
    std::vector<double> unlimited(const controller_description& c) const {
        return replay_controller(c, unlimited_, period_, loop_columns::of(log_));
    }
    bool limited() const { return actuator_.limit_V.has_value(); }
    /// Replayed less logged, from the first row that is compared.
    std::vector<double> difference(const controller_description& c, const std::vector<double>& replayed) const {
        return difference(c, replayed, log_.command);
    }
    std::vector<double> difference(const controller_description& c, const std::vector<double>& replayed,
                                   const std::vector<double>& command) const {
        const double coulomb = coulomb_of(c);
        std::vector<double> d(replayed.size() - from_);
        for (std::size_t k = from_; k < replayed.size(); ++k)
            d[k - from_] =
                but_for_the_sign(replayed[k] - command[k], coulomb, std::max<std::size_t>(1, k), log_);
        return d;
    }

private:
    static double coulomb_of(const controller_description& c) {
        const controller_kind* kind = c.own ? nullptr : &kind_of(c);
        return kind && !kind->coulomb.key.empty() ? given_values(*kind, c)[kind->coulomb.key] : 0;
    }

    const axis_log& log_;
    const actuator_description& actuator_;
    actuator_description smooth_, unlimited_;
    double period_;
    std::size_t from_, block_;
};

/// What rounding alone makes of a replay: how large the difference of the right controller is, and how much
/// that varies from record to record.
struct replay_floor {
    double ms = 0;      ///< mean square of the difference [V^2]
    double scatter = 0; ///< standard deviation of that mean [V^2]
    double most = 0;    ///< mean square of the largest block [V^2]

    /// Whether rounding explains a difference, given the mean squares of its blocks. Twice the floor's rms is
    /// allowed, and five standard deviations: what was rounded need not have been rounded evenly.
    bool explains(const std::vector<double>& blocks) const {
        if (blocks.empty()) return true;
        double sum = 0, largest = 0;
        for (double b : blocks) {
            sum += b / static_cast<double>(blocks.size());
            largest = std::max(largest, b);
        }
        return sum <= 4 * ms + 5 * scatter && largest <= 4 * most;
    }
};

/// The floor of a controller on a log: it is replayed on columns that were rounded otherwise by as much, a few
/// times. A right controller differs from its log by as much as two such replays differ. The linear and the
/// nonlinear part of its filters, its converter and the unknown first integral are all in it. Two roundings to
/// the converter's step may differ by one step for as long as the command stands still, and arithmetic of
/// single precision is exact to 2^-24.
inline replay_floor floor_of(const controller_description& c, const replay_box& box) {
    constexpr std::size_t draws = 6;
    const axis_log& log = box.log();
    std::mt19937_64 random(20080901);
    const auto rounded_otherwise = [&](std::vector<double> column, double step) {
        for (double& x : column) x += step * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
        return column;
    };
    const double dac = dac_step(box.actuator()), arithmetic = 0x1p-24 * rms(log.command);
    replay_floor out;
    std::vector<double> sum, squares;
    if (log.reference_step > 0 || log.position_step > 0 || log.command_step > 0) {
        const auto replayed = box.replay(c);
        for (std::size_t i = 0; i < draws; ++i) {
            axis_log other = log;
            other.reference = rounded_otherwise(log.reference, log.reference_step);
            other.position = rounded_otherwise(log.position, log.position_step);
            auto written = replay_controller(c, box.actuator(), box.period(), loop_columns::of(other));
            if (const double step = log.command_step; step > 0)
                for (double& u : written) u = std::round(u / step) * step;
            auto d = box.difference(c, replayed, written);
            // The first integral is fitted to each replay, in which rounded signs count as well.
            const double constant = made(c, box.actuator(), box.period())->remembers() ? quantile(d, 0.5) : 0;
            for (double& v : d) v -= constant;
            const auto blocks = block_ms(d, 0, box.block());
            sum.resize(blocks.size());
            squares.resize(blocks.size());
            for (std::size_t b = 0; b < blocks.size(); ++b) {
                sum[b] += blocks[b] / draws;
                squares[b] += blocks[b] * blocks[b] / draws;
                out.most = std::max(out.most, blocks[b]);
            }
        }
    }
    double variance = 0;
    for (std::size_t b = 0; b < sum.size(); ++b) {
        out.ms += sum[b] / static_cast<double>(sum.size());
        variance += std::max(0.0, squares[b] - sum[b] * sum[b]) * draws / (draws - 1);
    }
    if (!sum.empty()) out.scatter = std::sqrt(variance) / static_cast<double>(sum.size());
    const double step = std::max({0.5 * dac, 0.5 * log.command_step, arithmetic});
    out.ms = std::max(out.ms, step * step);
    out.most = std::max(out.most, 4 * step * step);
    return out;
}

/// Rows after which a replay that begins in the middle of the record agrees with one that has seen all of it:
/// for so long the past that no log has shows in the command. At most a quarter of the record.
inline std::size_t rows_of_unknown_past(const controller_description& c, const replay_box& box,
                                        double least_ms) {
    constexpr std::size_t starts = 4;
    const auto whole = box.replay(c);
    const std::size_t rows = whole.size();
    std::size_t most = 0;
    for (std::size_t i = 1; i <= starts; ++i) {
        const std::size_t first = rows * i / (starts + 1);
        auto left = replay_controller(c, box.actuator(), box.period(), loop_columns::of(box.log()).from(first));
        for (std::size_t k = 0; k < left.size(); ++k) left[k] -= whole[first + k];
        const double constant = quantile(left, 0.5); // of the first integral, which is fitted
        for (double& d : left) d -= constant;
        const auto blocks = block_ms(left, 0, box.block());
        for (std::size_t b = 0; b < blocks.size(); ++b)
            if (blocks[b] > least_ms) most = std::max(most, (b + 1) * box.block());
    }
    return std::min(most, rows / 4);
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
