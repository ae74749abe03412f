// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

#include <quadrant/analysis/margins.hpp>

#include <cmath>

/// The pictures that several experiments draw.
namespace quadrant_reproduce {

using quadrant::analysis::band;
using quadrant::analysis::complex;

struct named_response {
    std::string name;
    std::function<complex(quadrant::frequency)> at;
};

/// value(f) over the frequencies of a band.
template <class Value> line over_frequency(std::string name, const band& b, Value&& value) {
    line out{.name = std::move(name), .x = {}, .y = {}};
    for (const quadrant::frequency& f : quadrant::analysis::grid(b)) {
        out.x.push_back(f.value());
        out.y.push_back(value(f));
    }
    return out;
}
/// |response| in dB.
inline line gain_line(const named_response& r, const band& b) {
    return over_frequency(
        r.name, b, [&](quadrant::frequency f) { return quadrant::analysis::decibel(std::abs(r.at(f))); });
}
/// Phase in degrees without jumps, from (-360, 0] on.
inline line phase_line(const named_response& r, const band& b) {
    double last = -180;
    return over_frequency(r.name, b, [&](quadrant::frequency f) {
        const double phase = std::arg(r.at(f)) * 180 / std::numbers::pi;
        return last = phase + 360 * std::round((last - phase) / 360);
    });
}

/// Gain over phase.
inline picture bode(std::string title, std::string caption, const std::vector<named_response>& all,
                    const band& b) {
    picture out{std::move(title),
                std::move(caption),
                {panel{.x_label = "", .y_label = "gain [dB]", .lines = {}, .log_x = true},
                 panel{.x_label = "frequency [Hz]", .y_label = "phase [deg]", .lines = {}, .log_x = true}}};
    for (const named_response& r : all) {
        out.panels[0].lines.push_back(gain_line(r, b));
        out.panels[1].lines.push_back(phase_line(r, b));
    }
    return out;
}
/// Open loops around -1.
inline picture nyquist(std::string title, std::string caption, const std::vector<named_response>& all,
                       const band& b) {
    panel around{.x_label = "real part",
                 .y_label = "imaginary part",
                 .lines = {},
                 .square = true,
                 .x_range = std::pair{-2.0, 1.0},
                 .y_range = std::pair{-2.0, 1.0}};
    for (const named_response& r : all) {
        line curve{.name = r.name, .x = {}, .y = {}};
        const auto put = [&](const complex& value) {
            curve.x.push_back(value.real());
            curve.y.push_back(value.imag());
        };
        // A lightly damped mode turns a whole loop between two lines: halved where the step is seen.
        const auto between = [&](auto&& self, double low, complex from, double high, complex to,
                                 int depth) -> void {
            if (depth < 8 && std::abs(to - from) > 0.03 && std::min(std::abs(from), std::abs(to)) < 3) {
                const double middle = std::sqrt(low * high);
                const complex value = r.at(quadrant::analysis::hertz(middle));
                self(self, low, from, middle, value, depth + 1);
                self(self, middle, value, high, to, depth + 1);
            } else
                put(to);
        };
        const auto lines = quadrant::analysis::grid(b);
        put(r.at(lines.front()));
        for (std::size_t i = 1; i < lines.size(); ++i)
            between(between, lines[i - 1].value(), r.at(lines[i - 1]), lines[i].value(), r.at(lines[i]), 0);
        around.lines.push_back(std::move(curve));
    }
    line circle{.name = "unit circle", .x = {}, .y = {}, .drawn = line::style::dashed};
    for (int degrees = 0; degrees <= 360; degrees += 2) {
        circle.x.push_back(std::cos(degrees * std::numbers::pi / 180));
        circle.y.push_back(std::sin(degrees * std::numbers::pi / 180));
    }
    around.lines.push_back(std::move(circle));
    around.lines.push_back({.name = "-1", .x = {-1}, .y = {0}, .drawn = line::style::points});
    return {std::move(title), std::move(caption), {around}};
}
/// Gain alone.
inline picture magnitude(std::string title, std::string caption, const std::vector<named_response>& all,
                         const band& b) {
    panel gain{.x_label = "frequency [Hz]", .y_label = "gain [dB]", .lines = {}, .log_x = true};
    for (const named_response& r : all) gain.lines.push_back(gain_line(r, b));
    return {std::move(title), std::move(caption), {gain}};
}

} // namespace quadrant_reproduce
