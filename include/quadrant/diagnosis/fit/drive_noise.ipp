// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<double> reaction_to_reading(const plant_model& described,
                                                                const driven_motion& of) {
    drive_model d = described.drive;
    d.force_limit = d.maximum_duty = d.rate_limit = drive_model::none;
    d.minimum_duty = d.start_force = 0;
    driven_motion rest;
    rest.period = of.period;
    rest.in_volts = of.in_volts;
    rest.constant = of.constant;
    const std::size_t n = of.position.size();
    rest.set_point.assign(n, 0.0);
    rest.position.assign(n, 0.0);
    rest.position[n / 2] = 1;
    rest.find_velocity();
    auto out = rest.run(d).command;
    for (double& f : out) f *= described.force_constant;
    return out;
}

QUADRANT_DIAGNOSIS_DECL double drift_pole_of(const plant_model& described, double period) {
    const drive_model& d = described.drive;
    if (d.kind != drive_kind::position || !d.has_integral() || !(d.position_gain > 0)) return 1;
    return std::exp(-period * std::cbrt(d.position_gain * d.velocity_integral / described.mass));
}

namespace detail {

QUADRANT_DIAGNOSIS_DECL std::vector<double> innovation_of(const std::vector<double>& reaction, double mass,
                                                          double period, double pole, double reading) {
    const double to_position = 1 - pole * pole, to_velocity = (1 - pole) * (1 - pole) / period;
    std::vector<double> out(reaction.size());
    double x = 0, v = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = (k == out.size() / 2 ? reading : 0) - x;
        x += to_position * out[k];
        v += to_velocity * out[k];
        const double a = reaction[k] / mass;
        x += period * (v + 0.5 * period * a);
        v += period * a;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> running_means(const std::vector<double>& e, std::size_t m) {
    std::vector<double> sum(e.size() + 1, 0.0), mean(e.size(), 0.0);
    for (std::size_t k = 0; k < e.size(); ++k) sum[k + 1] = sum[k] + e[k];
    for (std::size_t k = 0; k + m <= e.size(); ++k) mean[k] = (sum[k + m] - sum[k]) / static_cast<double>(m);
    return mean;
}

QUADRANT_DIAGNOSIS_DECL void set_gains(channel& c, const std::vector<double>& e) {
    const std::size_t n = e.size();
    const auto mean = running_means(e, c.mean);
    c.noise_gain = std::sqrt(std::inner_product(mean.begin(), mean.end(), mean.begin(), 0.0));
    constexpr std::size_t tones = 200;
    double worst = 0;
    for (std::size_t i = 0; i < tones;
         ++i) { // evenly by ratio, from three cycles in the record to half the sample rate
        const double from = 6 * std::numbers::pi / static_cast<double>(n);
        const double w = from * std::pow(std::numbers::pi / from, static_cast<double>(i) / (tones - 1));
        const std::complex<double> turn = std::polar(1.0, -w);
        std::complex<double> at = 1, total = 0;
        for (std::size_t k = 0; k < n; ++k, at *= turn) total += at * mean[k];
        worst = std::max(worst, std::abs(total));
    }
    c.rounding = worst;
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
