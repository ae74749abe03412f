// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<std::size_t> motion_segments(std::span<const double> motion, double period,
                                                                 const record_scales& scale) {
    const auto shortest = std::max<std::size_t>(1, static_cast<std::size_t>(5 * scale.block() / period));
    const auto longest = static_cast<std::size_t>(30 * scale.block() / period);
    const auto v = derivative(zero_phase(motion, scale.corner_Hz / 3, period), period);
    double peak = 0;
    for (double x : v) peak = std::max(peak, std::abs(x));
    const auto sense = [&](double x) { return x > 1e-4 * peak ? 1 : x < -1e-4 * peak ? -1 : 0; };
    std::vector<std::size_t> out(motion.size());
    std::size_t current = 0, begun = 0;
    for (std::size_t k = 1; k < motion.size(); ++k) {
        const bool cut =
            sense(v[k]) != sense(v[k - 1]) && k - begun >= shortest && motion.size() - k >= shortest;
        if (cut || (k - begun >= longest && motion.size() - k >= shortest)) {
            ++current;
            begun = k;
        }
        out[k] = current;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double force_floor(const axis_record& r, double mass, double sigma) {
    return std::hypot(residual_force_floor(mass, sigma, r.period, r.bandwidth_Hz, r.reaction), r.command_noise);
}

QUADRANT_DIAGNOSIS_DECL double position_noise(const std::vector<double>& innovation, const scoring& s,
                                              double resolution) {
    std::vector<double> half_difference(innovation.size());
    for (std::size_t k = 1; k < half_difference.size(); ++k)
        half_difference[k] = (innovation[k] - innovation[k - 1]) * std::numbers::sqrt2 / 2;
    const auto ms = detail::block_ms(half_difference, s.channels.front());
    return std::sqrt(std::max(quantile(ms, 0.3), resolution * resolution / 12));
}

QUADRANT_DIAGNOSIS_DECL std::size_t substeps_of(const plant_model& described, double period) {
    const auto& f = described.friction;
    if (f.contact.elements < 2) return 1;
    double stiffness = 0;
    for (std::size_t i = 0; i < f.contact.elements; ++i) stiffness += f.stiffness(i);
    return static_cast<std::size_t>(
        std::clamp(std::ceil(10 * period * std::sqrt(stiffness / described.mass)), 1.0, 10.0));
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> residual_of(const axis_record& r, const plant_model& plant,
                                                        std::span<const double> model_acceleration,
                                                        bool behind_drive) {
    auto out = residual_force(plant, r.position, model_acceleration, r.period, r.bandwidth_Hz, r.left_out);
    const driven_motion* drive = r.observer.drive;
    if (!drive || !drive->tapped() || behind_drive) return out;
    auto beside = drive->force_beside_tap(plant.drive, plant.force_constant);
    for (std::size_t k = 0; k < r.left_out.size(); ++k)
        if (r.left_out[k]) beside[k] = 0;
    beside = zero_phase(beside, r.bandwidth_Hz, r.period);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += beside[k];
    return out;
}

QUADRANT_DIAGNOSIS_DECL double rms_judged(const axis_record& r, const std::vector<double>& residual) {
    const auto out = static_cast<double>(std::count(r.left_out.begin(), r.left_out.end(), 1)),
               rows = static_cast<double>(residual.size());
    return out < rows ? rms(residual) * std::sqrt(rows / (rows - out)) : 0;
}

QUADRANT_DIAGNOSIS_DECL std::shared_ptr<const led_motion> motion_to_lead(const axis_record& r,
                                                                         const plant_model& described) {
    auto out = std::make_shared<led_motion>();
    out->way = zero_phase(r.position, r.scale.corner_Hz, r.period);
    out->quick = derivative(out->way, r.period);
    const auto slow = zero_phase(out->quick, r.scale.corner_Hz, r.period);
    for (std::size_t k = 0; k < slow.size(); ++k) out->quick[k] -= slow[k];
    out->mass = described.moving_mass();
    out->force_constant = described.force_constant;
    const double surely = 3 * r.resolution / r.scale.response();
    for (std::size_t k = 0; k < r.velocity.size(); ++k)
        out->counts.push_back(std::abs(r.velocity[k]) > surely && r.counts(k));
    return out;
}

namespace detail {

/// Whether a record begins with the axis at rest: as long as the position stays within a count of its first
/// value, noise of the reading apart, the axis is no faster than that over this time, which is little beside
/// how fast it gets.
inline bool begins_at_rest(const axis_record& r) {
    constexpr std::size_t least = 3; // periods
    const double still = std::max(1.5 * r.resolution, 4 * reading_noise(r.position, r.resolution));
    std::size_t rows = 0;
    while (rows < r.position.size() && std::abs(r.position[rows] - r.position[0]) <= still) ++rows;
    double fastest = 0;
    for (const double v : r.velocity) fastest = std::max(fastest, std::abs(v));
    return rows > least && still < 0.1 * fastest * static_cast<double>(rows - 1) * r.period;
}

/// Share of a record's acceleration, in energy, in its first rows.
inline double share_of_acceleration(const axis_record& r, std::size_t rows) {
    double first = 0, all = 0;
    for (std::size_t k = 0; k < r.acceleration.size(); ++k) {
        all += r.acceleration[k] * r.acceleration[k];
        if (k < rows) first = all;
    }
    return all > 0 ? first / all : 0;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL axis_record prepare(const axis_log& log, double period, double resolution,
                                            const record_scales& scale) {
    axis_record r{.period = period,
                  .reference = log.reference,
                  .position = log.position,
                  .command = log.command,
                  .scale = scale,
                  .observer = {.period = period,
                               .corner_Hz = scale.corner_Hz,
                               .position = log.position,
                               .command = log.command,
                               .other_acceleration = log.other_acceleration,
                               .resolution = std::max({resolution, log.position_step, scale.count}),
                               .drive = log.drive.get()}};
    const auto smooth = zero_phase(log.position, scale.corner_Hz, period);
    r.velocity = derivative(smooth, period);
    r.acceleration = derivative(r.velocity, period);
    r.segment = motion_segments(motion_of(log), period, scale);
    r.segments = r.segment.empty() ? 0 : r.segment.back() + 1;
    r.bandwidth_Hz = scale.bandwidth_Hz();
    r.resolution = std::max({resolution, log.position_step, scale.count});
    auto& s = r.score;
    const auto mean =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(scale.block() / 5 / period)));
    s.block = 5 * mean;
    // By then a model has forgotten how it began: at rest at the first reading, with contact and play as they
    // come. Where the axis stands still there, rows that hold much of the motion are not left out for it.
    // What a drive's loops held at the beginning no reading shows.
    constexpr double much = 0.25;
    const bool from_the_first =
        !log.drive && detail::share_of_acceleration(r, s.block) > much && detail::begins_at_rest(r);
    s.skip = from_the_first ? 0 : s.block;
    const auto gaps = long_gaps(log.left_out, scale.response() / period, s.block);
    s.channels = detail::channels_of(mean, r.resolution, r.observer.pole(), r.segment, [&](std::size_t block) {
        return lay_blocks(block, s.skip, gaps.settling, log.position.size());
    });
    for (channel& c : s.channels)
        for (const std::size_t first : c.first_of_block) {
            const double creep = 2 * r.resolution / (static_cast<double>(c.mean) * period);
            const auto v = std::span(r.velocity).subspan(first, c.block);
            const auto rows = std::count_if(v.begin(), v.end(), [&](double x) { return std::abs(x) < creep; });
            c.creeping.push_back(static_cast<double>(rows) / static_cast<double>(c.block));
        }
    if (log.drive && log.drive->tapped())
        s.channels = detail::and_tap(std::move(s.channels), log.position.size(), r.resolution);
    r.left_out = around(gaps.gap);
    s.segments = r.segments;
    return r;
}

QUADRANT_DIAGNOSIS_DECL double rows_of_memory(std::span<const double> e) {
    double all = 0;
    for (double x : e) all += x * x;
    double sum = 1;
    for (std::size_t lag = 1; lag < e.size() / 2 && all > 0; ++lag) {
        double product = 0;
        for (std::size_t k = lag; k < e.size(); ++k) product += e[k] * e[k - lag];
        if (product <= 0) break;
        sum += 2 * (product / all) * (product / all);
    }
    return sum;
}

QUADRANT_DIAGNOSIS_DECL double path_of_law_error(const axis_record& r, const plant_model& described) {
    const drive_model& d = described.drive;
    const double stiffness = d.kind == drive_kind::position_servo
                                 ? d.duty_gain * d.supply * described.force_constant
                                 : d.velocity_gain * d.position_gain;
    double sum = 0;
    for (std::size_t k = 0; k < r.position.size(); ++k) {
        const double transmitted =
            described.force_constant * r.command[k] - described.static_force(r.position[k]);
        sum += transmitted * transmitted / static_cast<double>(r.position.size());
    }
    const auto& f = described.friction;
    return law_error * (f.coulomb + f.excess + f.load * std::sqrt(sum)) / stiffness;
}

QUADRANT_DIAGNOSIS_DECL void judge_path(axis_record& r, const plant_model& described,
                                        const plant_model& nearest) {
    const std::size_t rows = r.position.size();
    auto& s = r.score;
    std::vector<unsigned char> unjudged = r.left_out;
    if (!r.observer.drive->begins.empty()) unjudged.resize(rows, 0);
    for (const auto& b : r.observer.drive->begins)
        for (std::size_t k = b.row; k < std::min(rows, b.row + s.skip); ++k) unjudged[k] = 1;
    // Where the errors of two models last differently long, the shorter one distinguishes them.
    double memory = static_cast<double>(rows);
    for (const plant_model* plant : {&described, &nearest}) {
        std::vector<double> e;
        r.observer.run(*plant, e);
        for (std::size_t k = 0; k < unjudged.size(); ++k)
            if (unjudged[k]) e[k] = 0;
        memory = std::min(memory, rows_of_memory(std::span(e).first(rows)));
    }
    memory = std::max(memory, r.scale.response() / r.period);
    channel path = s.channels.front();
    path.mean = 1;
    path.block = std::clamp<std::size_t>(static_cast<std::size_t>(5 * memory), 1,
                                         std::max<std::size_t>(1, (rows - s.skip) / 5));
    path.nu = score_temperature * static_cast<double>(path.block) / memory;
    path.noise_gain = path.rounding = 1;
    path.creeping.clear();
    path.floor = std::hypot(0.4 * r.resolution, path_of_law_error(r, described));
    path.first_of_block = lay_blocks(path.block, s.skip, unjudged, rows);
    path.segment_of_block.clear();
    for (const std::size_t first : path.first_of_block)
        path.segment_of_block.push_back(r.segment[first + path.block / 2]);
    std::vector<channel> out{path};
    for (const channel& c : s.channels) // and what was measured behind the drive
        if (c.of_tap) out.push_back(c);
    s.channels = std::move(out);
}

QUADRANT_DIAGNOSIS_DECL void judge_beside_what_is_left(axis_record& r, std::span<const plant_model> known) {
    std::vector<std::vector<double>> e(known.size());
    r.observer.run(known, e);
    for (channel& c : r.score.channels) {
        if (c.first_of_block.empty()) continue;
        double least = std::numeric_limits<double>::infinity();
        for (const auto& each : e) least = std::min(least, quantile(detail::block_ms(each, c), 0.5));
        if (!std::isfinite(least)) continue;
        c.unknown = std::sqrt(least);
        c.floor = std::hypot(c.floor, c.unknown);
    }
}

} // namespace quadrant::inline v0::diagnosis
