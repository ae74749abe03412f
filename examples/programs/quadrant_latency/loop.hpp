// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../quadrant_reproduce/thesis.hpp"

#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_control_lanes.hpp>
#include <quadrant/memory/repetitive.hpp>

#include <cmath>
#include <vector>

/// What is measured: the controller of both axes of the milling table, whole. Cascade with notch, inverse of
/// the plant, GMS friction, disturbance observer, repetitive memory of second order with its two FIR filters.
namespace quadrant_latency {

using namespace quadrant;
using namespace quadrant::literals;

using friction = maxwell_slip<4, signal::velocity, signal::voltage>;
using observer = disturbance_observer<signal::voltage>;
template <std::size_t LearningTaps, std::size_t SmoothingTaps>
using memory_of = repetitive<signal::position, 100, 2, LearningTaps, SmoothingTaps>;
using memory = memory_of<90, 61>;
using memory_without_fir = memory_of<1, 1>;
template <class Memory> using boxes = milling_axis_boxes<friction, observer, Memory>;

/// The taps have the shape of designed ones. The sum of Q is 0.9: the memory forgets, since nothing here closes
/// the loop.
template <std::size_t LearningTaps, std::size_t SmoothingTaps>
typename memory_of<LearningTaps, SmoothingTaps>::parameters
remembered(memory_of<LearningTaps, SmoothingTaps>*) {
    typename memory_of<LearningTaps, SmoothingTaps>::parameters p{
        .cycle = 85.859 * thesis::period, .weights = {2, -1}, .ahead = LearningTaps / 3};
    double sum = 0;
    for (std::size_t i = 0; i < SmoothingTaps; ++i) {
        const double from_middle = double(i) - double(SmoothingTaps / 2);
        p.smoothing[i] = 1 + std::cos(2 * pi * from_middle / double(SmoothingTaps + 1));
        sum += p.smoothing[i];
    }
    for (double& tap : p.smoothing) tap *= 0.9 / sum;
    for (std::size_t i = 0; i < LearningTaps; ++i) {
        const double late = double(i) - double(p.ahead);
        p.learning[i] = (late == 0 ? 0.5 : 0.1 * std::cos(0.7 * late)) * std::exp(-0.05 * std::abs(late));
    }
    return p;
}
template <class Memory> typename boxes<Memory>::parameters parameters_of(const thesis::axis& a) {
    auto p = thesis::controller_of<boxes<Memory>>(a);
    p.friction = thesis::gms<signal::voltage>(a, 1.0 / a.kf);
    p.disturbance = {a.corner, axis_model<signal::voltage>{a.B, a.A_gms}};
    p.memory = remembered(static_cast<Memory*>(nullptr));
    p.dac_step = 20_V / 65536.0;
    return p;
}

/// Of one axis in one period, SI.
struct axis_sample {
    double position, velocity, acceleration, measured;
};
struct sample {
    axis_sample x, y;
};
struct commands {
    double x, y;
};

/// A circle of 30 mm at 100 mm/s as the encoders of a table see it that follows within some um. No plant is
/// behind the
/// commands, so the observer in time asks for more than the limit: samples with and without clipping are among
/// them.
constexpr std::size_t five_turns = 18'850; ///< samples; may be repeated without a jump
inline std::vector<sample> circle(std::size_t n = five_turns) {
    const double R = 0.03, w = 0.1 / R, encoder_step = 250e-9;
    std::vector<sample> all(n);
    for (std::size_t k = 0; k < n; ++k) {
        const double t = double(k) * thesis::period.value(), s = R * std::sin(w * t), c = R * std::cos(w * t);
        const auto seen = [&](double r, double phase) {
            const double error = 5e-6 * std::sin(2 * pi * 23.3 * t + phase) + 1e-6 * std::sin(2 * pi * 210 * t);
            return std::round((r - error) / encoder_step) * encoder_step;
        };
        all[k] = {{c - R, -s * w, -c * w * w, seen(c - R, 0)}, {s, c * w, -s * w * w, seen(s, 1)}};
    }
    return all;
}

/// Parked where the circle begins, a count away from the reference.
inline std::vector<sample> standing(std::size_t n = 1000) {
    const double count = 250e-9;
    return std::vector<sample>(n, sample{{0, 0, 0, count}, {0, 0, 0, -count}});
}
/// Both axes turn round every ten samples, on 20 um: break-away, friction in the other direction, a count of
/// the encoder at a time.
inline std::vector<sample> reversing(std::size_t n = 20'000) {
    const double size = 10e-6, w = pi / (10 * thesis::period.value()), encoder_step = 250e-9;
    std::vector<sample> all(n);
    for (std::size_t k = 0; k < n; ++k) {
        const double t = double(k) * thesis::period.value();
        const auto axis = [&](double phase) {
            const double s = size * std::sin(w * t + phase);
            return axis_sample{s, size * w * std::cos(w * t + phase), -w * w * s,
                               std::round(0.9 * s / encoder_step) * encoder_step};
        };
        all[k] = {axis(0), axis(1)};
    }
    return all;
}

/// Everything is inlined into `step` and `step` into nothing, as in a servo interrupt. Boxes: those of one
/// axis, or `in_lanes` of them.
template <class Memory, class Boxes> struct loop_of {
    using control = quadrant::xy_control<Boxes>;
    control both{{parameters_of<Memory>(thesis::x), parameters_of<Memory>(thesis::y)}, thesis::period};

    [[gnu::noinline, gnu::flatten]] commands step(const sample& s) noexcept {
        using length = typename control::position;
        const auto motion = [](const axis_sample& a) {
            return axis_motion<>{length::from_value(a.position),
                                 quantity_of<signal::velocity>::from_value(a.velocity),
                                 quantity_of<signal::acceleration>::from_value(a.acceleration)};
        };
        const auto u = both({motion(s.x), motion(s.y)}, {.x = on_x(length::from_value(s.x.measured)),
                                                         .y = on_y(length::from_value(s.y.measured))});
        return {u.x.plain().value(), u.y.plain().value()};
    }
    /// Bits: x limited, y limited, faulted.
    int flags() const noexcept { return both.limited_x() | both.limited_y() << 1 | both.faulted() << 2; }
};
template <class Memory> using typed_loop = loop_of<Memory, boxes<Memory>>;
template <class Memory> using typed_lanes = loop_of<Memory, in_lanes<boxes<Memory>>>;

} // namespace quadrant_latency
