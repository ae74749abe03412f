// SPDX-License-Identifier: BSL-1.0
// Long: columns_of() has one case for each term of a link.
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

/// The rows that count in every model: a reading is there; the axis has gone a tenth of its travel, so that it
/// stands at a known side of any play; and the force, where one is known, is far enough from zero for the side
/// in contact to be sure, and the motor moves, so that its own friction has a direction.
QUADRANT_DIAGNOSIS_DECL void readings::choose_rows() {
    const std::size_t n = link_.rows();
    std::vector<unsigned char> out(n, 0);
    for (std::size_t k = 0; k < link_.left_out.size(); ++k) out[k] |= link_.left_out[k];
    if (link_.asked) leave_bends_out(out);
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
            const bool doubt = std::abs(link_.force[k]) < sure || std::abs(velocity_[k]) < 0.01 * speed_ ||
                               (k > 0 && link_.force[k] * link_.force[k - 1] < 0);
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

/// Between the rows of a slow record what was asked is not known where it bends: a cubic is wrong by 3 / 128 of
/// the fourth difference in the middle. Such rows do not count; where most of the motion is in them they do,
/// and what is not known is noise.
QUADRANT_DIAGNOSIS_DECL void readings::leave_bends_out(std::vector<unsigned char>& out) {
    const auto& x = link_.first;
    const std::size_t n = link_.rows();
    std::vector<unsigned char> bent(n, 0);
    double unknown = 0, moved = 0, moved_in_bends = 0;
    for (std::size_t k = 2; k + 3 < n; ++k) {
        const double wrong = 3.0 / 128 * std::abs(x[k - 2] - 4 * x[k - 1] + 6 * x[k] - 4 * x[k + 1] + x[k + 2]);
        unknown += wrong * wrong / static_cast<double>(n);
        if (wrong > noise_) std::fill_n(bent.begin() + static_cast<std::ptrdiff_t>(k) - 2, 6, 1);
    }
    for (std::size_t k = 1; k < n; ++k) {
        moved += std::abs(x[k] - x[k - 1]);
        if (bent[k]) moved_in_bends += std::abs(x[k] - x[k - 1]);
    }
    const bool most = moved_in_bends > 0.5 * moved;
    if (most) noise_ = std::hypot(noise_, std::sqrt(unknown));
    for (std::size_t k = 0; k < n; ++k)
        if (k < 2 || k + 3 >= n || (bent[k] && !most)) out[k] = 1; // or no four rows around it
}

/// Where a coarse reading moves slowly its rounding is a slow wave, which no smoothing takes off: so the smooth
/// motion is rounded as the readings are and smoothed again. What that changes is what rounding has changed.
QUADRANT_DIAGNOSIS_DECL void readings::round_again() {
    const double band = link_.force_band_Hz;
    const auto changed = [&](const std::vector<double>& smooth, double count) {
        std::vector<double> out(smooth.size(), 0.0);
        if (!(count > 0)) return out;
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = count * std::round(smooth[k] / count) - smooth[k];
        return zero_phase(out, band, link_.period);
    };
    const auto first = changed(first_, link_.first_count), last = changed(last_, link_.last_count);
    const auto acceleration = derivative(derivative(first, link_.period), link_.period);
    for (std::size_t k : rows_) {
        rounded_.push_back(last[k] - first[k]);
        rounded_force_.push_back(-link_.motor_mass * acceleration[k]);
    }
}

QUADRANT_DIAGNOSIS_DECL double readings::noise_with(double compliance) const {
    double sum = 0;
    for (std::size_t i = 0; i < rounded_.size(); ++i) {
        const double e = rounded_[i] + compliance * rounded_force_[i];
        sum += e * e;
    }
    return std::max(noise_, std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, rounded_.size()))));
}

QUADRANT_DIAGNOSIS_DECL std::vector<Eigen::VectorXd>
readings::columns_of(const link_model& m, term t, std::span<const double> driven) const {
    const auto by_row = [&](auto value) {
        Eigen::VectorXd c(static_cast<Eigen::Index>(rows_.size()));
        for (std::size_t i = 0; i < rows_.size(); ++i) c[static_cast<Eigen::Index>(i)] = value(rows_[i]);
        return c;
    };
    // What repeats along the travel is as smooth as the readings that it is compared with.
    const auto wave = [&](double period, int harmonics, bool of_scale) {
        std::vector<Eigen::VectorXd> out;
        for (int j = 1; j <= harmonics; ++j)
            for (const double turned : {0.0, std::numbers::pi / 2}) {
                const auto value = [&](double x) {
                    return std::sin(2 * std::numbers::pi * j * x / period + turned);
                };
                const auto each = of_scale ? along_scale(value) : along_travel(m, value);
                out.push_back(by_row([&](std::size_t k) { return each[k]; }));
            }
        return out;
    };
    switch (t) {
    case term::rate: {
        link_model faster = m;
        faster.rate *= 1.001;
        const auto then = faster.follows(first_, link_.period);
        return {by_row([&](std::size_t k) { return (then[k] - driven[k]) / (faster.rate - m.rate); })};
    }
    case term::delay:
    case term::first_order: {
        const double more = 0.05 * link_.period;
        link_model later = m;
        later.late(t) += more;
        const auto then = later.follows(first_, link_.period);
        return {by_row([&](std::size_t k) { return (then[k] - driven[k]) / more; })};
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
        return wave(m.pitch_period, m.pitch_harmonics, false);
    case term::cyclic:
        return wave(m.cyclic_period, 1, true);
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

QUADRANT_DIAGNOSIS_DECL equations readings::of_model(const link_model& m) const {
    equations out{.rows = rows_, .difference = {}, .columns = {}, .of = {}};
    const auto driven = m.follows(first_, link_.period);
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
    // The two readings are not of the same moment; beside a freed delay a second time would mean nothing.
    if (!link_.asked && !m.has(term::delay)) {
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

} // namespace quadrant::inline v0::diagnosis::chain
