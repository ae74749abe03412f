// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <array>
#include <numeric>

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL std::vector<plant_model>
like_machines(const plant_model& calibrated, std::span<const parameter> numbers, bool with_loops) {
    std::mt19937_64 random(20080901);
    std::vector<plant_model> plants(20, calibrated);
    // Gains of velocity loops inside a drive. The force that moves an axis along its path does not depend on
    // them; only a replay of the logged motion with another gain differs, by far more than two machines would.
    const auto is_of_feedback = [&](const parameter& p) {
        return p.key.starts_with("drive.") && calibrated.drive.kind != drive_kind::position_servo;
    };
    for (plant_model& plant : plants)
        for (const parameter& p : numbers) {
            const double low = p.to_fit(p.low), high = p.to_fit(p.high);
            const double share = static_cast<double>(random() >> 11) * 0x1p-53;
            if (p.key != "presliding_length_m" && !is_of_record(p) && (with_loops || !is_of_feedback(p)))
                p.of(plant) = p.from_fit(low + share * (high - low));
        }
    return plants;
}

QUADRANT_DIAGNOSIS_DECL void take_out_numbers_of_record(std::vector<std::vector<double>>& signals,
                                                        const axis_record& r, const plant_model& calibrated,
                                                        std::span<const parameter> numbers) {
    struct number {
        double low, high; // from where it stands
        std::vector<double> slope{};
    };
    std::vector<number> own;
    std::vector<plant_model> plants{calibrated};
    std::vector<double> steps;
    for (const parameter& p : numbers)
        if (is_of_record(p)) {
            plant_model moved = calibrated;
            double& x = p.of(moved);
            own.push_back({p.low - x, p.high - x});
            steps.push_back(x + p.step > p.high ? -p.step : p.step);
            x += steps.back();
            plants.push_back(std::move(moved));
        }
    if (own.empty()) return;
    std::vector<std::vector<double>> e(plants.size());
    r.observer.run(plants, e);
    const auto first = static_cast<std::ptrdiff_t>(r.position.size());
    const auto product = [first](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin() + first, a.end(), b.begin() + first, 0.0);
    };
    for (std::size_t i = 0; i < own.size(); ++i) {
        for (std::size_t k = 0; k < e[0].size(); ++k) e[i + 1][k] = (e[i + 1][k] - e[0][k]) / steps[i];
        own[i].slope = std::move(e[i + 1]);
    }
    for (auto& signal : signals) {
        std::vector<double> x(own.size(), 0.0);
        constexpr int sweeps = 100; // one number after the other: two or three, which may stand for one another
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (std::size_t i = 0; i < own.size(); ++i) {
                const double square = product(own[i].slope, own[i].slope);
                if (!(square > 0)) continue;
                const double best = x[i] + product(own[i].slope, signal) / square,
                             step = std::clamp(best, own[i].low, own[i].high) - x[i];
                x[i] += step;
                for (std::size_t k = static_cast<std::size_t>(first); k < signal.size(); ++k)
                    signal[k] -= step * own[i].slope[k];
            }
    }
}

inline std::vector<double> cloud_of(const axis_record& r, const plant_model& calibrated,
                                    std::span<const parameter> numbers, bool fitted) {
    std::vector<double> out;
    std::array<std::vector<std::vector<double>>, 2> of; // on the motion alone; with the loops of the drive
    for (const channel& c : r.score.channels) {
        auto& differences = of[c.of_tap];
        if (differences.empty()) {
            auto plants = like_machines(calibrated, numbers, c.of_tap);
            plants.push_back(calibrated);
            differences.resize(plants.size());
            r.observer.run(plants, differences);
            const std::vector<double> own = std::move(differences.back());
            differences.pop_back();
            for (auto& e : differences)
                for (std::size_t k = 0; k < e.size(); ++k) e[k] -= own[k];
            if (fitted && c.of_tap) take_out_numbers_of_record(differences, r, calibrated, numbers);
        }
        std::vector<double> sizes;
        for (const auto& e : differences) sizes.push_back(square(rms(seen(e, c))));
        out.push_back(quantile(sizes, 0.95));
    }
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<double> cloud_of_like_machines(const axis_record& r,
                                                                   const plant_model& calibrated,
                                                                   std::span<const parameter> numbers) {
    return detail::cloud_of(r, calibrated, numbers, false);
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> cloud_of_fitted_machines(const axis_record& r,
                                                                     const plant_model& calibrated,
                                                                     std::span<const parameter> numbers) {
    return detail::cloud_of(r, calibrated, numbers, true);
}

} // namespace quadrant::inline v0::diagnosis
