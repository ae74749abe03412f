// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/harmonics.hpp"
#include "model.hpp"

namespace quadrant::diagnosis::chain {

/// How many rows an equation system has at most; of a longer record every n-th row is taken.
inline constexpr std::size_t most_rows = 30000;

/// One link made ready: the part of its equations that does not depend on a model.
class readings {
public:
    explicit readings(position_link l)
        : link_(std::move(l)), noise_(link_.noise()), travel_(link_.travel()), middle_(link_.middle()) {
        const double band = link_.force_band_Hz;
        first_ = band > 0 ? zero_phase(link_.first, band, link_.period) : link_.first;
        last_ = band > 0 ? zero_phase(link_.last, band, link_.period) : link_.last;
        velocity_ = derivative(first_, link_.period);
        if (band > 0) noise_ = std::max(noise_ * std::sqrt(2 * band * link_.period), 0.1 * link_.count());
        for (double v : velocity_) speed_ = std::max(speed_, std::abs(v));
        choose_rows();
    }

    const position_link& of() const { return link_; }
    double noise() const { return noise_; }
    double travel() const { return travel_; }
    double middle() const { return middle_; }
    double speed() const { return speed_; }
    std::span<const double> first() const { return first_; }
    const std::vector<std::size_t>& rows() const { return rows_; }
    /// Place on the travel, -1 to 1 from end to end.
    double along(double x) const { return 2 * (x - middle_) / travel_; }

    /// Where what lies behind the play stands beside what drives it. With a force its sign tells which side is
    /// in contact; without, friction holds the load where it is.
    std::vector<double> offset(const link_model& m, std::span<const double> driven, double width) const {
        if (link_.force.empty()) return play_of(driven, width).offset;
        std::vector<double> out(driven.size());
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = -width / 2 * (passed(m, k) > 0 ? 1 : -1);
        return out;
    }
    /// Force that goes through the spring [N].
    double passed(const link_model& m, std::size_t k) const {
        return link_.force[k] - m.motor_coulomb * link_.motor_direction[k];
    }

    equations of_model(const link_model& m) const;
    /// A function of the place, at every row, as smooth as the readings.
    template <class Value> std::vector<double> along_travel(const link_model& m, Value value) const {
        auto out = followed(link_.first, link_.period, m.how, m.lag);
        for (double& x : out) x = value(x);
        return link_.force_band_Hz > 0 ? zero_phase(out, link_.force_band_Hz, link_.period) : out;
    }

private:
    void choose_rows();
    std::vector<Eigen::VectorXd> columns_of(const link_model& m, term t, std::span<const double> driven) const;

    position_link link_;
    double noise_, travel_, middle_, speed_ = 0;
    std::vector<double> first_, last_, velocity_;
    std::vector<std::size_t> rows_;
};

/// The rows that count in every model: a reading is there; the axis has gone a tenth of its travel, so that it
/// stands at a known side of any play; and the force, where one is known, is far enough from zero for the side
/// in contact to be sure.
inline void readings::choose_rows() {
    const std::size_t n = link_.rows();
    std::vector<unsigned char> out(n, 0);
    for (std::size_t k = 0; k < link_.left_out.size(); ++k) out[k] |= link_.left_out[k];
    double low = first_[0], high = low;
    for (std::size_t k = 0; k < n && high - low < 0.1 * travel_; ++k) {
        low = std::min(low, first_[k]);
        high = std::max(high, first_[k]);
        out[k] = 1;
    }
    if (!link_.force.empty()) {
        const double sure = 0.15 * rms(link_.force);
        const auto around = static_cast<std::size_t>(1 + 1 / (link_.force_band_Hz * link_.period));
        std::size_t since = n;
        for (std::size_t k = 0; k < n; ++k) {
            const bool doubt =
                std::abs(link_.force[k]) < sure || (k > 0 && link_.force[k] * link_.force[k - 1] < 0);
            since = doubt ? 0 : since == n ? n : since + 1;
            if (since <= around) out[k] = 1;
        }
        std::size_t until = n;
        for (std::size_t k = n; k-- > 0;) {
            const bool doubt = std::abs(link_.force[k]) < sure;
            until = doubt ? 0 : until == n ? n : until + 1;
            if (until <= around) out[k] = 1;
        }
    }
    for (std::size_t k = 0; k < n; ++k)
        if (!out[k]) rows_.push_back(k);
    const std::size_t stride = 1 + rows_.size() / most_rows;
    if (stride > 1) {
        std::vector<std::size_t> some;
        for (std::size_t i = 0; i < rows_.size(); i += stride) some.push_back(rows_[i]);
        rows_ = std::move(some);
    }
}

/// The columns of one freed term.
inline std::vector<Eigen::VectorXd> readings::columns_of(const link_model& m, term t,
                                                         std::span<const double> driven) const {
    const auto by_row = [&](auto value) {
        Eigen::VectorXd c(static_cast<Eigen::Index>(rows_.size()));
        for (std::size_t i = 0; i < rows_.size(); ++i) c[static_cast<Eigen::Index>(i)] = value(rows_[i]);
        return c;
    };
    // What repeats along the travel is as smooth as the readings that it is compared with.
    const auto wave = [&](double period, int harmonics) {
        std::vector<Eigen::VectorXd> out;
        for (int j = 1; j <= harmonics; ++j)
            for (const double turned : {0.0, std::numbers::pi / 2}) {
                const auto each = along_travel(
                    m, [&](double x) { return std::sin(2 * std::numbers::pi * j * x / period + turned); });
                out.push_back(by_row([&](std::size_t k) { return each[k]; }));
            }
        return out;
    };
    switch (t) {
    case term::delay:
    case term::first_order: {
        const double more = 0.05 * link_.period;
        const auto later = followed(first_, link_.period, m.how, m.lag + more);
        const auto speed = derivative(driven, link_.period);
        const Eigen::VectorXd by_lag = by_row([&](std::size_t k) { return (later[k] - driven[k]) / more; });
        if (t == term::delay) return {by_lag};
        return {by_lag, by_row([&](std::size_t k) { return speed[k]; })}; // and read a little earlier or later
    }
    case term::scale:
        return {by_row([&](std::size_t k) { return driven[k] - middle_; })};
    case term::play: {
        const double more = std::max(1e-3 * m.play, 1e-2 * noise_);
        const auto now = offset(m, driven, m.play), wider = offset(m, driven, m.play + more);
        const auto by_width = [&](std::size_t k) { return (wider[k] - now[k]) / more; };
        return {by_row(by_width), by_row([&](std::size_t k) { return by_width(k) * along(driven[k]); })};
    }
    case term::pitch:
        return wave(m.pitch_period, m.pitch_harmonics);
    case term::cyclic:
        return wave(m.cyclic_period, 1);
    case term::smooth: {
        std::vector<Eigen::VectorXd> out;
        for (int order = 2; order < 2 + smooth_terms; ++order)
            out.push_back(by_row([&](std::size_t k) { return legendre(order, along(driven[k])); }));
        return out;
    }
    case term::spring:
        return {by_row([&](std::size_t k) { return -passed(m, k); })};
    case term::motor_friction:
        return {by_row([&](std::size_t k) { return link_.motor_direction[k]; })};
    case term::steps: {
        std::vector<Eigen::VectorXd> out;
        for (std::size_t step : m.steps)
            out.push_back(by_row([&](std::size_t k) { return k >= step ? 1.0 : 0.0; }));
        return out;
    }
    default: {
        const auto last = static_cast<double>(link_.rows() - 1);
        return {by_row([&](std::size_t k) { return static_cast<double>(k) / last; }),
                by_row([&](std::size_t k) { return legendre(2, 2 * static_cast<double>(k) / last - 1); })};
    }
    }
}

/// The equations of a model.
inline equations readings::of_model(const link_model& m) const {
    equations out{.rows = rows_, .difference = {}, .columns = {}, .of = {}};
    const auto driven = followed(first_, link_.period, m.how, m.lag);
    const auto behind = m.play > 0 ? offset(m, driven, m.play) : std::vector<double>(driven.size(), 0.0);
    const auto n = static_cast<Eigen::Index>(rows_.size());
    const harmonics pitch(m.pitch_period, m.pitch, m.pitch_phase);
    const auto errors = m.pitch.empty() ? std::vector<double>(driven.size(), 0.0)
                                        : along_travel(m, [&](double x) { return pitch.at(x); });
    out.difference.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const std::size_t k = rows_[static_cast<std::size_t>(i)];
        double d = last_[k] - driven[k] - behind[k];
        d -= errors[k];
        if (!m.smooth.empty()) d -= smooth_curve(m, driven[k]);
        if (m.compliance > 0 && !link_.force.empty()) d += m.compliance * passed(m, k);
        out.difference[i] = d;
    }
    std::vector<Eigen::VectorXd> columns{Eigen::VectorXd::Ones(n)};
    out.of.push_back({});
    if (!link_.asked) { // the two readings are not of the same moment
        Eigen::VectorXd age(n);
        for (Eigen::Index i = 0; i < n; ++i) age[i] = velocity_[rows_[static_cast<std::size_t>(i)]];
        columns.push_back(std::move(age));
        out.of.push_back({});
    }
    for (term t : m.freed)
        for (Eigen::VectorXd& c : columns_of(m, t, driven)) {
            columns.push_back(std::move(c));
            out.of.push_back(t);
        }
    out.columns.resize(n, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) out.columns.col(static_cast<Eigen::Index>(j)) = columns[j];
    return out;
}

} // namespace quadrant::diagnosis::chain
