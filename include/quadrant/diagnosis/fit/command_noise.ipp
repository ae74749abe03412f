// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Power of a signal beside that of another, line by line of a spectrum.
struct beside_another {
    double own = 0, other = 0;
    analysis::complex cross{};

    void add(const analysis::complex& x, const analysis::complex& y) {
        own += std::norm(x), other += std::norm(y), cross += x * std::conj(y);
    }
    /// What of the own power the other does not follow, a mean over so many stretches: chance alone makes one
    /// of them coherent.
    double apart(std::size_t stretches) const {
        const double follows = other > 0 ? std::norm(cross) / other : 0, n = static_cast<double>(stretches);
        return std::max(0.0, own - follows) / std::max(1.0, n - (other > 0 ? 1 : 0));
    }
};

/// Hann windows of so many rows, half overlapped, each with its spectrum.
class stretches {
public:
    explicit stretches(std::size_t rows) : shape_(rows) {
        for (std::size_t i = 0; i < rows; ++i)
            shape_[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (double(i) + 0.5) / double(rows));
    }
    double power() const { return std::inner_product(shape_.begin(), shape_.end(), shape_.begin(), 0.0); }
    std::vector<analysis::complex> spectrum(std::span<const double> x) const {
        const double mean = std::accumulate(x.begin(), x.end(), 0.0) / double(x.size());
        std::vector<analysis::complex> out(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) out[i] = shape_[i] * (x[i] - mean);
        analysis::fft(out);
        return out;
    }

private:
    std::vector<double> shape_;
};

/// Second differences, as many as rows: those of the ends are 0.
inline std::vector<double> second_differences(std::span<const double> position) {
    std::vector<double> out(position.size(), 0.0);
    for (std::size_t k = 1; k + 1 < position.size(); ++k)
        out[k] = position[k + 1] - 2 * position[k] + position[k - 1];
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL double white_noise_in(std::span<const double> x, std::span<const double> position) {
    constexpr std::size_t shortest = 32, longest = 1024, bands = 8;
    std::size_t rows = shortest;
    while (rows < longest && 32 * rows <= x.size()) rows *= 2;
    if (x.size() < 16 * rows) return 0;
    const detail::stretches windows(rows);
    const std::vector<double> moved = detail::second_differences(position);
    const std::size_t each = rows / 2 / bands; // lines a band
    std::array<std::vector<double>, bands> power;
    std::vector<detail::beside_another> lines(each * bands);
    for (std::size_t first = 0; first + rows <= x.size(); first += rows / 2) {
        const auto own = windows.spectrum(x.subspan(first, rows));
        const auto other = moved.empty() ? std::vector<analysis::complex>(rows)
                                         : windows.spectrum(std::span(moved).subspan(first, rows));
        for (std::size_t i = 0; i < lines.size(); ++i) lines[i].add(own[i], other[i]);
        for (std::size_t band = 0; band < bands; ++band) {
            double sum = 0;
            for (std::size_t i = 0; i < each; ++i) sum += std::norm(own[band * each + i]);
            power[band].push_back(sum / double(each));
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t band = 0; band < bands; ++band) {
        double apart = 0;
        for (std::size_t i = 0; i < each; ++i)
            apart += lines[band * each + i].apart(power[band].size()) / double(each);
        least = std::min({least, apart, quantile(std::move(power[band]), 0.5)});
    }
    return std::sqrt(least / windows.power());
}

namespace detail {

/// rms of a channel's means for white noise of this force, of which one sample makes response(impulse).
template <class Response>
double noise_in_means(const channel& c, double force, double pole, Response response) {
    const auto forgotten = static_cast<std::size_t>(30 / (1 - pole));
    std::vector<double> impulse(2 * (c.mean + forgotten), 0.0);
    impulse[c.mean] = force;
    const auto mean = running_means(response(std::move(impulse)), c.mean);
    return std::sqrt(std::inner_product(mean.begin(), mean.end(), mean.begin(), 0.0));
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL double command_noise_in(const channel& c, double force, double mass, double period,
                                                double pole) {
    return detail::noise_in_means(c, force, pole, [&](const std::vector<double>& impulse) {
        return detail::innovation_of(impulse, mass, period, pole, 0);
    });
}

QUADRANT_DIAGNOSIS_DECL double tap_noise_in(const channel& c, double force, const drive_model& d, double period,
                                            double pole) {
    return detail::noise_in_means(c, force, pole, [&](std::vector<double> impulse) {
        return as_reading(d, std::move(impulse), period, pole);
    });
}

QUADRANT_DIAGNOSIS_DECL double share_added_by_measurement(const std::vector<double>& innovation,
                                                          std::span<const channel> channels, double sigma) {
    double share = 1;
    const auto holds = [&](double power, double assumed) {
        if (assumed > 0) share = std::min(share, power / assumed);
    };
    std::vector<std::vector<double>> in_blocks;
    for (const channel& c : channels) {
        in_blocks.push_back(detail::block_ms(innovation, c));
        if (!in_blocks.back().empty())
            holds(quantile(in_blocks.back(), 0.5), c.command_noise * c.command_noise);
    }
    if (channels.size() < 2 || in_blocks[0].empty() || in_blocks[0].size() != in_blocks[1].size()) return share;
    const auto between = [&](double channel::*size) {
        return channels[0].*size * channels[0].*size - channels[1].*size * channels[1].*size;
    };
    for (std::size_t b = 0; b < in_blocks[0].size(); ++b) in_blocks[0][b] -= in_blocks[1][b];
    const double inside = quantile(std::move(in_blocks[0]), 0.5);
    holds(std::max(inside - sigma * sigma * between(&channel::noise_gain), inside / 10),
          between(&channel::command_noise));
    return share;
}

QUADRANT_DIAGNOSIS_DECL double white_noise_below(double bandwidth_Hz, double period) {
    std::vector<double> impulse(4001, 0.0);
    impulse[impulse.size() / 2] = 1;
    const auto passed = zero_phase(impulse, bandwidth_Hz, period);
    return std::sqrt(std::inner_product(passed.begin(), passed.end(), passed.begin(), 0.0));
}

} // namespace quadrant::inline v0::diagnosis
