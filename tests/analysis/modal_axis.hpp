// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/analysis/excitation.hpp>
#include <quadrant/analysis/frf.hpp>
#include <quadrant/analysis/modes.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

/// The machine behind the tests of the designs: a `flexible_axis_model` in time, behind a hold of one period.
/// Each oscillator is advanced by its own closed form for a constant force, so no step is too long; the dead
/// time is rounded to a tenth of the period.
class modal_axis {
public:
    modal_axis(const quadrant::analysis::flexible_axis_model<>& g, double period)
        : h_(period / parts), b_(g.rigid.gain.value()),
          late_(std::size_t(std::lround(g.rigid.delay.value() / h_)) + 1, 0.0) {
        parts_.push_back(rigid(g.rigid.viscous_rate.value(), h_));
        for (const auto& m : g.modes) parts_.push_back(oscillator(m, h_));
    }
    /// One period with the command u [V]; returns the position [m] at its end.
    double operator()(double u) {
        for (std::size_t k = 0; k < parts; ++k) {
            late_[at_] = u;
            at_ = (at_ + 1) % late_.size();
            const double force = b_ * late_[at_]; // the oldest
            for (auto& p : parts_) p.step(force);
        }
        double x = 0;
        for (const auto& p : parts_) x += p.share * p.x;
        return x;
    }

private:
    static constexpr std::size_t parts = 10;
    /// (x, v) about its rest under the force: x' = xx x + xv v, v' = vx x + vv v; what the force adds.
    struct part {
        double share, xx, xv, vx, vv, force_x, force_v, x = 0, v = 0;
        void step(double force) {
            const double before = x;
            x = xx * before + xv * v + force_x * force;
            v = vx * before + vv * v + force_v * force;
        }
    };
    static part rigid(double a, double h) {
        if (a == 0) return {1, 1, h, 0, 1, h * h / 2, h};
        const double e = std::exp(-a * h);
        return {1, 1, (1 - e) / a, 0, e, (h - (1 - e) / a) / a, (1 - e) / a};
    }
    static part oscillator(const quadrant::analysis::flexible_mode& m, double h) {
        const double w = 2 * std::numbers::pi * m.centre.value(), decay = m.damping * w;
        const double wd = w * std::sqrt(1 - m.damping * m.damping), e = std::exp(-decay * h);
        const double c = std::cos(wd * h), s = std::sin(wd * h) / wd;
        const double xx = e * (c + decay * s), vx = -e * w * w * s;
        return {m.share, xx, e * s, vx, e * (c - decay * s), (1 - xx) / (w * w), -vx / (w * w)};
    }
    double h_, b_;
    std::vector<part> parts_;
    std::vector<double> late_;
    std::size_t at_ = 0;
};

/// Its response as a controller of that period sees it, hold, delay and sampling in it: a multisine in time,
/// exact on its lines once the speed that the start has left has died away (A of 5 1/s or more).
inline quadrant::analysis::measured_frf measured(const quadrant::analysis::flexible_axis_model<>& g,
                                                 quadrant::duration period) {
    namespace s = quadrant::signal;
    using namespace quadrant::analysis;
    modal_axis axis(g, period.value());
    const auto volts = quadrant::quantity_of<s::voltage>::from_value;
    const auto metres = quadrant::quantity_of<s::position>::from_value;
    multisine<s::voltage> excite{{volts(1), hertz(2), hertz(0.48 / period.value()), 4096}, period};
    frf<s::voltage, s::position> out{
        {.samples = 4096, .overlap = 0, .shape = window::none, .remove = trend::mean}, period};
    double reading = 0;
    for (std::size_t k = 0; k < 4 * 4096; ++k) {
        const auto u = excite();
        if (k >= 3 * 4096) out.add(u, metres(reading));
        reading = axis(u.value());
    }
    return out.result();
}
