// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../effect/rules.hpp"
#include "../controller_search.hpp"
#include "evidence.hpp"
#include "levels.hpp"
#include "tones.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Weighs what a replay that differs may come from, where no key brings it back to rounding. Each reading is
/// fitted to four fifths of the record and predicts the rest: the best key, with its value free; another law of
/// the same signals (every key at once, error, speed and acceleration); and each simple waveform over time.
class added_search {
public:
    added_search(const controller_description& described, const replay_box& box, const replay_floor& floor)
        : box_(box), floor_(floor) {
        // With the sign that the written reference has: an excuse for it would take a part of the signal.
        const auto replayed = box.smooth(described);
        for (std::size_t k = box.from(); k < replayed.size(); ++k)
            signal_.values.push_back(box.log().command[k] - replayed[k]);
        signal_.noise = std::sqrt(floor.ms);
        signal_.period = box.period();
        signal_.first_row = box.from();
        signal_.offset_unknown = made(described, box.actuator(), box.period())->remembers();
    }

    /// `key`: the best of the search, if any. `slopes`: what each key adds to the command.
    std::optional<added_finding> find(const std::optional<key_fit>& key,
                                      std::vector<std::vector<double>> slopes) {
        const std::size_t block = box_.block();
        if (signal_.values.size() < 2 * column_fit::folds * block) return {};
        const auto constant = [&](std::vector<std::vector<double>> columns) {
            if (signal_.offset_unknown) columns.emplace_back(signal_.values.size(), 1.0);
            return columns;
        };
        const auto nothing = constant({});
        before_ms_ = mean_of(column_fit(signal_.values, nothing, block).held_out_ms());
        const reading of_key = key ? score_of_key(*key, constant) : reading{};
        add_signals(slopes);
        const auto law_columns = constant(std::move(slopes));
        const column_fit law(signal_.values, law_columns, block);
        const reading of_law = scored(law.held_out_ms(), static_cast<double>(law_columns.size()), prior_law);
        reading best;
        waveform_candidate wave;
        double scores = 0;
        std::vector<double> weights;
        for (auto& c : candidates()) {
            const auto columns = constant(c.columns);
            const column_fit fit(signal_.values, columns, block);
            const auto r =
                scored(fit.held_out_ms(), static_cast<double>(columns.size() + c.numbers), suspect_prior);
            weights.push_back(r.score);
            if (r.score > best.score) {
                best = r;
                const auto x = fit.by_all();
                wave = std::move(c);
                fill(wave, x);
            }
        }
        const double top = std::max({of_key.score, of_law.score, best.score});
        const auto weight = [&](double score) { return std::exp((score - top) / score_temperature); };
        for (double s : weights) scores += weight(s);
        const double all = scores + weight(of_key.score) + weight(of_law.score);
        if (best.score == top && best.ms < 0.5 * before_ms_) {
            const double explained = std::max(before_ms_ - best.ms, std::numeric_limits<double>::min());
            const double left = std::sqrt(std::max(0.0, best.ms - 4 * floor_.ms) / explained);
            // As for every cause: an unexplained residual may come from the same unknown cause.
            const double known = 1 - std::min(0.03 + left, 0.95);
            return added_finding{std::move(wave.form), known * scores / all,
                                 known * weight(of_key.score) / all};
        }
        return without_form(of_key, of_law, law, key);
    }

private:
    /// How probable a reading is before the log is seen, against each other: gains are changed at the machine,
    /// laws seldom, and a signal is added in a test or by a fault.
    static constexpr double prior_key = 0.5, prior_law = 0.1, suspect_prior = 0.1;

    struct reading {
        double score = -std::numeric_limits<double>::infinity();
        double ms = std::numeric_limits<double>::infinity(); ///< left on what it was not fitted to [V^2]
    };
    reading scored(const std::vector<double>& ms, double numbers, double prior) const {
        return {score_of_blocks(ms, floor_.ms, numbers) + score_temperature * std::log(prior), mean_of(ms)};
    }
    template <class Constant> reading score_of_key(const key_fit& key, Constant constant) const {
        std::vector<double> left(key.left.size());
        std::transform(key.left.begin(), key.left.end(), left.begin(), std::negate{});
        std::vector<std::vector<double>> columns;
        if (!key.slope.empty()) columns.push_back(key.slope);
        columns = constant(std::move(columns));
        return scored(column_fit(left, columns, box_.block()).held_out_ms(),
                      static_cast<double>(columns.size()), prior_key);
    }
    /// Error, speed and acceleration, of which another law would be made.
    void add_signals(std::vector<std::vector<double>>& columns) const {
        std::erase_if(columns, [](const auto& c) { return c.empty(); });
        const loop_inputs in(loop_columns::of(box_.log()), box_.period());
        const auto rows = signal_.values.size();
        const std::size_t first = columns.size();
        columns.resize(first + 4, std::vector<double>(rows));
        for (std::size_t i = 0; i < rows; ++i) {
            const auto k = static_cast<std::ptrdiff_t>(i + box_.from());
            const auto asked = in.asked(k);
            const auto measured = in.measured(k);
            columns[first][i] = asked.position.value() - measured.position.value();
            columns[first + 1][i] = asked.velocity.value();
            columns[first + 2][i] = asked.acceleration.value();
            columns[first + 3][i] = measured.velocity.value();
        }
    }
    std::vector<waveform_candidate> candidates() const {
        std::vector<waveform_candidate> out;
        const tone_finder tones(signal_);
        for (auto found : {level_finder(signal_).candidate(), tones.tone(), tones.chirp()})
            if (found) out.push_back(std::move(*found));
        return out;
    }
    /// The sizes of the columns are the waveform's.
    void fill(waveform_candidate& c, const Eigen::VectorXd& x) const {
        added_waveform& w = c.form;
        w.sample_period_s = signal_.period;
        w.values.assign(box_.log().command.size(), 0.0);
        for (std::size_t i = 0; i < c.columns.size(); ++i)
            for (std::size_t k = 0; k < signal_.values.size(); ++k)
                w.values[k + box_.from()] += x[static_cast<Eigen::Index>(i)] * c.columns[i][k];
        measure(w);
    }
    void measure(added_waveform& w) const {
        const auto row = [&](double t) {
            return std::min(static_cast<std::size_t>(std::lround(t / w.sample_period_s)), w.values.size());
        };
        const std::size_t a = row(w.from_s), b = row(w.to_s);
        if (b > a) w.rms = rms(std::span(w.values).subspan(a, b - a));
    }
    /// No simple form explains it. It is added all the same where the best key and the other law, fitted to the
    /// parts that differ, leave most of them, and would differ where the replay agrees; or where they predict
    /// next to nothing at all.
    std::optional<added_finding> without_form(const reading& of_key, const reading& of_law,
                                              const column_fit& law, const std::optional<key_fit>& key) const {
        const double explained = 1 - std::min(of_key.ms, of_law.ms) / before_ms_;
        if (!(explained < 0.5)) return {};
        const std::size_t block = box_.block();
        const std::vector<std::vector<double>> none;
        const auto ms = block_ms(signal_.values, 0, block);
        const auto agrees = [&](std::size_t b) { return ms[b] <= 4 * floor_.most; };
        const auto differs = [&](std::size_t b) { return !agrees(b); };
        const auto score_where_it_agrees = [&](auto ms_of) {
            double sum = 0;
            for (std::size_t b = 0; b < ms.size(); ++b)
                if (agrees(b)) sum -= 0.5 * channel{}.nu * std::log(ms_of(b) + floor_.ms);
            return sum;
        };
        const double quiet = score_where_it_agrees([&](std::size_t b) { return ms[b]; });
        const auto x = law.by_blocks(differs);
        double others = score_where_it_agrees([&](std::size_t b) { return law.ms_of(b, x); });
        if (key && !key->slope.empty()) {
            const std::vector<std::vector<double>> column{key->slope};
            const column_fit one(signal_.values, column, block);
            const auto y = one.by_blocks(differs);
            others = std::max(others, score_where_it_agrees([&](std::size_t b) { return one.ms_of(b, y); }));
        }
        const bool confined = quiet - others > rules{}.margin;
        if (!confined && explained > 0.2) return {};
        added_finding out;
        added_waveform& w = out.waveform;
        w.sample_period_s = signal_.period;
        w.values.assign(box_.log().command.size(), 0.0);
        std::size_t first = ms.size(), last = 0;
        for (std::size_t b = 0; b < ms.size(); ++b)
            if (differs(b)) first = std::min(first, b), last = b;
        for (std::size_t k = first * block; k < (last + 1) * block; ++k)
            w.values[k + box_.from()] = signal_.values[k];
        w.from_s = signal_.time(first * block);
        w.to_s = signal_.time((last + 1) * block);
        w.from_start = first == 0;
        w.to_end = last + 1 == ms.size();
        measure(w);
        out.probability = 0.97 * (1 - std::max(0.0, explained));
        return out;
    }

    const replay_box& box_;
    const replay_floor& floor_;
    added_signal signal_;
    double before_ms_ = 0;
};

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
