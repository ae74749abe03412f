// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "estimated.hpp"
#include "frf.hpp"
#include "loop.hpp"
#include "minimise.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Which lines of an FRF, and where to look.
struct plant_fit_options {
    frequency from, to;           ///< well below the first structural mode: eq. (2.2) has none
    double least_coherence = 0.8; ///< lines below are left out
    duration longest_delay = duration::from_value(5e-3); ///< of the search for a start
};

/// Fitted G(s) = B e^{-s Td}/(s (s + A)) with intervals of 95 %.
template <signal_tag Command = signal::voltage> struct plant_fit {
    estimated<per_second> pole;                             ///< A [1/s]
    estimated<gain_of<signal::acceleration, Command>> gain; ///< B
    estimated<duration> delay; ///< Td; of a sampled FRF with the hold's half period
    std::size_t lines;         ///< used
    double residual;           ///< rms of |ln(model/measured)|, so about the relative error of a line
    double
        surprise; ///< sum of squares over what the lines' spread explains; far above 1: the model is too small
    bool converged;

    rigid_axis_model<Command> model() const { return {pole.value, gain.value, delay.value}; }
};

namespace detail {
/// A line of an FRF, to be fitted.
struct plant_line {
    complex s, value;
    double weight; ///< 1/spread

    /// ln(G / measured) = ln B - s Td - ln(s (s + A)) - ln measured, imaginary part in (-pi, pi].
    complex off(double a, double log_b, double delay) const {
        return std::log(std::exp(log_b - s * delay) / (s * (s + a) * value));
    }
};
/// Where a fit of lines begins: the best of all starts that were tried, and the best were B negative.
struct plant_start {
    struct guess {
        double cost = HUGE_VAL, a = 0, log_b = 0, delay = 0;
    } best, reversed;

    void attempt(const std::vector<plant_line>& lines, double a, double delay) {
        double log_b = 0, cost = 0, all = 0;
        for (const plant_line& p : lines) {
            log_b += p.weight * std::log(std::abs(p.s * (p.s + a) * p.value));
            all += p.weight;
        }
        log_b /= all;
        double other = 0;
        for (const plant_line& p : lines) {
            const complex e = p.off(a, log_b, delay);
            cost += p.weight * std::norm(e);
            const double turned = std::numbers::pi - std::abs(e.imag());
            other += p.weight * (e.real() * e.real() + turned * turned);
        }
        if (cost < best.cost) best = {cost, a, log_b, delay};
        if (other < reversed.cost) reversed = {other, a, log_b, delay};
    }
};
} // namespace detail

/// Fit of [Jamaludin2008] eq. (2.2) by nonlinear least squares: ln of model over measurement, real part (gain)
/// and imaginary part (phase) of each line, weighed by its spread; so a line counts by how well it is known,
/// not by its size. Start by a grid of A and Td, because the phase is known modulo a turn only; then
/// `minimise`.
/// Intervals: from the Jacobian; widened by `surprise` where that is above 1, since then the lines' own spread
/// does not explain the misfit. They speak of noise, not of a mode that the model does not have.
/// Throws with fewer than 8 lines, or when the response has the sign of a negative B. Where A lies far below
/// `from` it
/// is not determined: its interval then reaches below 0, and only that is said.
template <signal_tag In = signal::voltage>
plant_fit<In> fit_plant(const measured_frf& frf, const plant_fit_options& options) {
    require_not_negative("fit_plant.from", options.from);
    require(options.to > options.from, "fit_plant.to", options.to,
            "must be above fit_plant.from (" + quadrant::detail::shortest(options.from) + ")");
    require_positive("fit_plant.longest_delay", options.longest_delay);
    std::vector<detail::plant_line> points;
    double top = 0, slow = HUGE_VAL;
    for (const auto& line : frf.lines) {
        if (line.f < options.from || line.f > options.to || line.coherence < options.least_coherence ||
            !(std::abs(line.value) > 0) || !std::isfinite(line.spread))
            continue;
        // A simulation without noise has no spread: then all lines alike.
        points.push_back({laplace(line.f), line.value, 1 / std::max(line.spread, 1e-6)});
        top = std::max(top, line.f.value()), slow = std::min(slow, line.f.value());
    }
    require(points.size() >= 8, "fit_plant.lines", double(points.size()),
            "must be 8 or more between fit_plant.from and .to with enough coherence");

    detail::plant_start start;
    const double step = 1 / (8 * top); // an eighth of a turn at the fastest line
    const double scale = 2 * std::numbers::pi * top;
    const auto delays = std::size_t(std::ceil(options.longest_delay.value() / step)) + 1;
    const auto poles = std::size_t(std::ceil(std::log(3 * scale / slow) / std::log(1.6)));
    for (std::size_t i = 0; i <= delays; ++i) {
        start.attempt(points, 0, double(i) * step);
        for (std::size_t k = 0; k < poles; ++k)
            start.attempt(points, slow * std::pow(1.6, double(k)), double(i) * step);
    }
    const std::size_t n = points.size();
    const auto& best = start.best;
    require(best.cost <= start.reversed.cost, "fit_plant.gain", -std::exp(start.reversed.log_b),
            "must be above 0: turn the sign of the command or of the position");

    // Unknowns of comparable size: A over the fastest line, ln B, phase of Td at the fastest line.
    const auto residuals = [&](const std::vector<double>& x) {
        std::vector<double> out;
        for (const auto& p : points) {
            const complex e = p.weight * p.off(scale * x[0], x[1], x[2] / scale);
            out.push_back(e.real()), out.push_back(e.imag());
        }
        return out;
    };
    const minimum fit = minimise(residuals, {best.a / scale, best.log_b, best.delay * scale});
    const double a = scale * fit.x[0], log_b = fit.x[1], delay = fit.x[2] / scale;
    double misfit = 0;
    for (const auto& p : points) misfit += std::norm(p.off(a, log_b, delay)) / double(n);
    const double surprise = fit.cost / double(2 * n - 3);
    const auto spread = [&](double inverse) { return 1.96 * std::sqrt(inverse * std::max(1.0, surprise)); };
    const double da = scale * spread(fit.variance[0]), db = spread(fit.variance[1]),
                 dt = spread(fit.variance[2]) / scale;
    const auto at = [](double v) { return gain_of<signal::acceleration, In>::from_value(v); };
    const auto pole = [](double v) { return per_second::from_value(v); };
    return {{pole(a), pole(a - da), pole(a + da)},
            {at(std::exp(log_b)), at(std::exp(log_b - db)), at(std::exp(log_b + db))},
            {duration::from_value(delay), duration::from_value(delay - dt), duration::from_value(delay + dt)},
            n,
            std::sqrt(misfit),
            surprise,
            fit.converged};
}

} // namespace quadrant::inline v0::analysis
