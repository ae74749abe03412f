// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL lossy_commands lost_commands::find(std::span<const double> command,
                                                           std::span<const double> innovation,
                                                           const std::vector<double>& response,
                                                           std::size_t delay_rows, double reading_noise,
                                                           const loss_assumption& a) {
    lost_commands search(command, innovation, response, delay_rows, reading_noise, a);
    for (int round = 0; round < 5 && search.end_ > search.from_; ++round) {
        search.take_out_the_past();
        search.follow();
    }
    return search.found();
}

QUADRANT_DIAGNOSIS_DECL
lost_commands::lost_commands(std::span<const double> command, std::span<const double> innovation,
                             const std::vector<double>& response, std::size_t delay_rows, double reading_noise,
                             const loss_assumption& a)
    : command_(command), innovation_(innovation), response_(response), first_(delay_rows + 1),
      reading_noise_(reading_noise), a_(a), p_(a.probability), from_(window + linear_past::first + delay_rows),
      end_(command.size() > first_ + response.size() ? command.size() - first_ - response.size() : 0),
      step_(command.size(), 0.0), pulse_(step_), held_(step_), left_(step_), gain_(step_),
      weight_(command.size(), a.probability) {
    for (std::size_t k = 1; k < step_.size(); ++k) step_[k] = command[k - 1] - command[k];
    variance_ = neighbourhood(innovation_, square(reading_noise_));
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> lost_commands::neighbourhood(std::span<const double> e,
                                                                         double least) {
    std::vector<double> out, squares;
    for (std::size_t from = 0; from < e.size(); from += window) {
        squares.clear();
        for (std::size_t k = from; k < std::min(e.size(), from + window); ++k) squares.push_back(square(e[k]));
        out.push_back(std::max({least, quantile(squares, 0.5) / 0.455, std::numeric_limits<double>::min()}));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double lost_commands::log_density(double x) {
    constexpr double strangers = 0.02;
    return std::log((1 - strangers) * std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi) +
                    strangers / (3 * std::numbers::pi * (1 + x * x / 9)));
}

QUADRANT_DIAGNOSIS_DECL void lost_commands::take_out_the_past() {
    std::vector<double> cleared(innovation_.begin(), innovation_.end()), trust(left_.size());
    for (std::size_t k = from_; k < end_; ++k)
        for (std::size_t j = 0; pulse_[k] != 0 && j < response_.size(); ++j)
            cleared[k + first_ + j] -= pulse_[k] * response_[j];
    for (std::size_t k = 0; k < trust.size(); ++k)
        trust[k] = 1 / (variance_[k / window] + square(left_[k]) / 9);
    const auto past = linear_past::of(cleared, step_, trust, from_);
    variance_ = neighbourhood(past.left(cleared, step_, from_), square(reading_noise_) * past.noise_gain());
    left_ = past.left(innovation_, step_, from_);
    shape_ = past.left(response_);
    shape_.resize(std::min(shape_.size(), reach));
    energy_ = std::inner_product(shape_.begin(), shape_.end(), shape_.begin(), 0.0);
}

QUADRANT_DIAGNOSIS_DECL bool lost_commands::shows(double step, std::size_t k) const {
    return square(step) * energy_ > square(stands_out) * variance_[(k + first_) / window];
}

QUADRANT_DIAGNOSIS_DECL void lost_commands::follow() {
    std::vector<history> now(1), next;
    std::vector<branch> branches;
    now.front().applied = command_[from_ - 1];
    double before = 0, alone = 0;
    std::fill(gain_.begin(), gain_.end(), 0.0);
    for (std::size_t k = from_; k < end_; ++k) {
        const double seen = left_[k + first_], sigma = std::sqrt(variance_[(k + first_) / window]);
        branches.clear();
        for (const history& h : now) go_on(h, k, branches);
        for (branch& b : branches) b.score += log_density((seen - b.expected) / sigma);
        alone += log_density(seen / sigma);
        keep_the_likeliest(branches);
        next.clear();
        for (const branch& b : branches) next.push_back(grown(b, k));
        now.swap(next);
        const double best = now.front().score;
        double sum = 0;
        for (history& h : now) sum += h.share = std::exp(h.score - best);
        const double ahead = best + std::log(sum) - alone;
        gain_[k] = ahead - before;
        before = ahead;
        for (std::size_t back = k + 1 == end_ ? 0 : lag; back <= lag && k >= from_ + back; ++back) {
            weight_[k - back] = 0;
            for (const history& h : now)
                if ((h.lost >> back) & 1) weight_[k - back] += h.share / sum;
        }
    }
    count();
}

QUADRANT_DIAGNOSIS_DECL void lost_commands::go_on(const history& h, std::size_t k,
                                                  std::vector<branch>& out) const {
    const double step = a_.size * (h.applied - command_[k]), expected = h.to_come[k % reach];
    const std::uint64_t kept = h.lost << 1;
    if (!shows(step, k)) {
        out.push_back({&h, h.score, expected, kept, 0});
        return;
    }
    // The mean of the losses is gone with the past.
    const double gone = (1 - p_) * step, stays = p_ * step;
    out.push_back({&h, h.score + std::log(p_), expected + gone * shape_[0], kept | 1, gone});
    out.push_back({&h, h.score + std::log(1 - p_), expected - stays * shape_[0], kept, -stays});
}

QUADRANT_DIAGNOSIS_DECL lost_commands::history lost_commands::grown(const branch& b, std::size_t k) const {
    history out = *b.from;
    out.score = b.score;
    out.lost = b.lost;
    if (!(b.lost & 1)) out.applied = command_[k];
    for (std::size_t j = 0; b.pulse != 0 && j < shape_.size(); ++j)
        out.to_come[(k + j) % reach] += b.pulse * shape_[j];
    out.to_come[k % reach] = 0;
    return out;
}

QUADRANT_DIAGNOSIS_DECL void lost_commands::count() {
    double lost = 0;
    told_ = 0;
    for (std::size_t k = from_; k < end_; ++k) {
        const double step = a_.size * (held_[k - 1] + step_[k]);
        const bool told = shows(step, k);
        if (!told) weight_[k] = p_;
        told_ += told;
        lost += told * weight_[k];
        pulse_[k] = (weight_[k] - p_) * step;
        held_[k] = weight_[k] * step;
    }
    used_ = p_;
    if (a_.learned && told_ > 0) p_ = std::clamp(lost / told_, 1e-4, 0.5);
}

QUADRANT_DIAGNOSIS_DECL void lost_commands::keep_the_likeliest(std::vector<branch>& of) {
    constexpr std::uint64_t lasting = (std::uint64_t(1) << reach) - 1;
    std::sort(of.begin(), of.end(), [](const branch& a, const branch& b) { return a.score > b.score; });
    std::size_t n = 0;
    for (std::size_t i = 0; i < of.size() && n < abreast; ++i) {
        bool known = false;
        for (std::size_t j = 0; j < n && !known; ++j) known = ((of[i].lost ^ of[j].lost) & lasting) == 0;
        if (!known) {
            if (i != n) of[n] = of[i];
            ++n;
        }
    }
    of.resize(n);
}

QUADRANT_DIAGNOSIS_DECL lossy_commands lost_commands::found() const {
    lossy_commands out{.applied = {command_.begin(), command_.end()}, .probability = p_, .told = told_};
    out.gain_by_place.assign(command_.size() / (5 * window) + 1, 0.0);
    for (std::size_t k = from_; k < end_; ++k) {
        out.applied[k] += held_[k];
        out.gain += gain_[k];
        out.gain_by_place[k / (5 * window)] += gain_[k];
        const double q = weight_[k];
        if (q > 1e-9) out.choices += q * std::log(q / used_);
        if (q < 1 - 1e-9) out.choices += (1 - q) * std::log((1 - q) / (1 - used_));
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
