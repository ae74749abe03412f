// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../feedforward/cogging_harmonics.hpp"
#include "../feedforward/cogging_table.hpp"
#include "cogging_fit.hpp"
#include "estimated.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// One slow move in one direction: what the axis needed, and where. Samples need not be even in time or place.
template <signal_tag Out, signal_tag In = signal::position> struct cogging_run {
    std::vector<quantity_of<In>> position;
    std::vector<quantity_of<Out>> command; ///< or current, or force
    int direction = 0;                     ///< +1, -1; 0: the direction from the first position to the last
    std::vector<double>
        velocity{}; ///< SI; of all runs or of none: then viscous and Coulomb friction are distinct
};

/// What repeats along the travel, and which of its harmonics a map keeps.
template <signal_tag In = signal::position> struct cogging_options {
    quantity_of<In> pitch{};        ///< > 0; what repeats: pole pitch, or a turn
    unsigned highest = 40;          ///< harmonic that is looked for
    std::vector<unsigned> orders{}; ///< keep just these, or
    std::size_t strongest = 0;      ///< keep so many; neither given: keep all above the noise
    std::vector<unsigned>
        friction_orders{}; ///< where half the difference of the directions repeats along the pitch too
};

/// One harmonic of the cogging that was found, with its interval, and what shows that it is friction instead.
template <signal_tag Out> struct cogging_harmonic {
    unsigned order;
    estimated<quantity_of<Out>> amplitude;
    estimated<double> phase; ///< [rad] of the sine at position 0
    bool above_noise;        ///< stands out by more than noise does once in 20 whole fits
    quantity_of<Out>
        half_difference; ///< of the two directions in this order; far above its neighbours: a friction order
};

/// What two directions show.
template <signal_tag Out, signal_tag In = signal::position> struct cogging_identification {
    quantity_of<In> pitch{};
    std::vector<cogging_harmonic<Out>> harmonics; ///< those kept, the strongest first
    std::vector<cogging_harmonic<Out>> left_out;  ///< the others up to `highest`, the strongest first
    estimated<quantity_of<Out>>
        coulomb{}; ///< half the difference of both directions, by the mean speed or at rest
    estimated<quantity_of<Out>> offset{}; ///< constant force (gravity), not part of the map
    estimated<double> viscous{};          ///< per SI velocity; 0 without velocities
    quantity_of<Out> residual{};          ///< rms of what neither harmonics nor friction explain

    /// Half the difference of the directions by place: Coulomb level and friction orders, to be added forwards.
    struct wave {
        unsigned order;
        double cosine, sine;
    };
    std::vector<wave> friction_waves;
    quantity_of<Out> friction_at(quantity_of<In> x) const {
        double sum = coulomb.value.value();
        for (const auto& w : friction_waves) {
            const double angle = 2 * std::numbers::pi * w.order * std::remainder((x / pitch).value(), 1.0);
            sum += w.cosine * std::cos(angle) + w.sine * std::sin(angle);
        }
        return quantity_of<Out>::from_value(sum);
    }
    /// The map: what has to be added whichever way it goes.
    quantity_of<Out> at(quantity_of<In> x) const {
        double sum = 0;
        for (const auto& h : harmonics)
            sum += h.amplitude.value.value() *
                   std::sin(2 * std::numbers::pi * h.order * std::remainder((x / pitch).value(), 1.0) +
                            h.phase.value);
        return quantity_of<Out>::from_value(sum);
    }
    /// The map as blocks. Harmonics beyond those kept stay zero; fewer than were kept is refused.
    template <std::size_t Harmonics>
    typename cogging_harmonics<Harmonics, Out, In>::parameters as_harmonics() const {
        require(harmonics.size() <= Harmonics, "cogging_identification.harmonics", double(harmonics.size()),
                "must not be more than the block holds (" + quadrant::detail::shortest(double(Harmonics)) +
                    ")");
        typename cogging_harmonics<Harmonics, Out, In>::parameters p{.pitch = pitch, .harmonics = {}};
        for (std::size_t i = 0; i < harmonics.size(); ++i)
            p.harmonics[i] = {harmonics[i].order, harmonics[i].amplitude.value, harmonics[i].phase.value};
        return p;
    }
    template <std::size_t Points> typename cogging_table<Points, Out, 3, In>::parameters as_table() const {
        typename cogging_table<Points, Out, 3, In>::parameters p{.pitch = pitch, .points = {}};
        for (std::size_t i = 0; i < Points; ++i) p.points[i] = at(pitch * (double(i) / double(Points)));
        return p;
    }
};

namespace detail {
/// The runs as the fit takes them: positions in pitches, numbers without units.
template <signal_tag Out, signal_tag In>
std::vector<cogging_record> cogging_records(const std::vector<cogging_run<Out, In>>& runs,
                                            const cogging_options<In>& options) {
    require_positive("identify_cogging.pitch", options.pitch);
    require(options.highest >= 1, "identify_cogging.highest", double(options.highest), "must be 1 or more");
    for (const unsigned order : options.orders)
        require(order >= 1 && order <= options.highest, "identify_cogging.orders", double(order),
                "must lie between 1 and highest (" + quadrant::detail::shortest(double(options.highest)) + ")");
    for (const unsigned order : options.friction_orders)
        require(order >= 1 && order <= options.highest, "identify_cogging.friction_orders", double(order),
                "must lie between 1 and highest (" + quadrant::detail::shortest(double(options.highest)) + ")");
    std::vector<cogging_record> records;
    for (const auto& run : runs) {
        require(run.position.size() == run.command.size() && run.position.size() >= 2,
                "identify_cogging.position", double(run.position.size()),
                "must hold 2 samples or more, as many as command (" +
                    quadrant::detail::shortest(double(run.command.size())) + ")");
        require(run.velocity.size() == (runs[0].velocity.empty() ? 0 : run.position.size()),
                "identify_cogging.velocity", double(run.velocity.size()),
                "must hold as many samples as position (" +
                    quadrant::detail::shortest(double(run.position.size())) + ") in all runs, or none in all");
        cogging_record r{{}, {}, run.velocity, run.direction};
        for (std::size_t i = 0; i < run.position.size(); ++i) {
            require_finite("identify_cogging.position", run.position[i]);
            require_finite("identify_cogging.command", run.command[i]);
            if (!run.velocity.empty()) require_finite("identify_cogging.velocity", run.velocity[i]);
            r.turns.push_back((run.position[i] / options.pitch).value());
            r.command.push_back(run.command[i].value());
        }
        if (r.direction == 0)
            r.direction = r.turns.back() > r.turns.front() ? 1 : r.turns.back() < r.turns.front() ? -1 : 0;
        require(r.direction == 1 || r.direction == -1, "identify_cogging.direction", double(r.direction),
                "must be +1 or -1, or 0 for a run that ends elsewhere than it began");
        records.push_back(std::move(r));
    }
    return records;
}
/// The strongest first; which of them the options keep.
template <signal_tag Out, signal_tag In>
void keep_harmonics(std::vector<cogging_harmonic<Out>> all, const cogging_options<In>& options,
                    cogging_identification<Out, In>& out) {
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.amplitude.value > b.amplitude.value; });
    for (const auto& h : all) {
        const bool listed = std::count(options.orders.begin(), options.orders.end(), h.order) > 0;
        const bool keep = !options.orders.empty() ? listed
                          : options.strongest > 0 ? out.harmonics.size() < options.strongest
                                                  : h.above_noise;
        (keep ? out.harmonics : out.left_out).push_back(h);
    }
}
} // namespace detail

/// Finds the cogging of an axis from slow runs both ways, by least squares over all harmonics up to `highest`
/// at once:
///   command = offset + coulomb direction + viscous velocity + sum of harmonics of the pitch
/// Friction changes sign with the direction and the map does not, so that it drops out of the map; a lag of the
/// loop turns the phase one way and the other, and drops out too. Nothing leaks from harmonics that are not
/// kept into those that are. Intervals of 95 % from the spectrum of the residual around each harmonic, so that
/// correlated residuals count for what they are; five harmonics on either side share one level of noise.
/// Range: slow: highest times speed over pitch well below the bandwidth of the velocity loop, and no
/// stick-slip. More passes, shorter intervals; one each way is the least.
/// Throws "identify_cogging.<field> = ...: must ..." when a direction is missing, when a direction leaves a gap
/// in the pitch that is longer than half the shortest wave, for samples that are not finite, for options.
template <signal_tag Out, signal_tag In = signal::position>
cogging_identification<Out, In> identify_cogging(const std::vector<cogging_run<Out, In>>& runs,
                                                 const cogging_options<In>& options) {
    const detail::cogging_fit fit(detail::cogging_records(runs, options), options.highest,
                                  options.friction_orders);

    using value = quantity_of<Out>;
    const auto around = [&](double x, double error) {
        return estimated<value>{value::from_value(x), value::from_value(x - error),
                                value::from_value(x + error)};
    };
    cogging_identification<Out, In> out;
    out.pitch = options.pitch;
    out.residual = value::from_value(fit.residual());
    const double level = student_95(fit.level_noise().freedom);
    out.offset = around(fit.x(0), level * fit.level_deviation(0));
    out.coulomb = around(fit.x(1), level * fit.level_deviation(1));
    if (!runs[0].velocity.empty()) {
        const double s = fit.x(2), error = level * fit.level_deviation(2);
        out.viscous = {s, s - error, s + error};
    }
    std::vector<cogging_harmonic<Out>> all;
    for (unsigned order = 1; order <= options.highest; ++order) {
        const auto h = fit.harmonic(order);
        const double t = student_95(h.freedom);
        auto amplitude = around(h.amplitude, t * h.amplitude_deviation);
        amplitude.low = std::max(amplitude.low, value());
        const double turn = std::min(t * h.phase_deviation, std::numbers::pi);
        all.push_back({order,
                       amplitude,
                       {h.phase, h.phase - turn, h.phase + turn},
                       h.chance < 0.05 / double(options.highest),
                       value::from_value(h.half_difference)});
    }
    for (std::size_t i = 0; i < options.friction_orders.size(); ++i) {
        const auto [cosine, sine] = fit.friction(i);
        out.friction_waves.push_back({options.friction_orders[i], cosine, sine});
    }
    detail::keep_harmonics(std::move(all), options, out);
    return out;
}

} // namespace quadrant::inline v0::analysis
