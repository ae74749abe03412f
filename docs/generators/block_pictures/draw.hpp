// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "page/picture.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/base/signal.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// The pictures of docs/blocks: each is drawn from what the block itself gives.
namespace block_pictures {
using namespace quadrant;
using namespace quadrant::literals;
using quadrant_page::line;
using quadrant_page::panel;
using quadrant_page::picture;
namespace s = quadrant::signal;

/// The page of a block, and its picture.
struct entry {
    const char* block;
    picture (*draw)();
};
using family = std::vector<entry>;

/// A curve that is filled point by point.
struct curve : line {
    explicit curve(std::string called, style how = style::solid) {
        name = std::move(called);
        drawn = how;
    }
    void add(double at, double value) {
        x.push_back(at);
        y.push_back(value);
    }
    /// A value that stands from `at` on for `length`: a command behind a converter.
    void hold(double at, double length, double value) {
        add(at, value);
        add(at + length, value);
    }
};
inline constexpr auto dashed = line::style::dashed;
inline constexpr auto points = line::style::points;

inline panel over(std::string x_label, std::string y_label, std::vector<line> lines) {
    panel p;
    p.x_label = std::move(x_label);
    p.y_label = std::move(y_label);
    p.lines = std::move(lines);
    return p;
}
inline panel between(panel p, double low, double high) {
    p.y_range = std::pair{low, high};
    return p;
}
inline picture of(std::string title, std::vector<panel> panels) {
    return {std::move(title), "", std::move(panels)};
}

/// Frequencies in Hz, evenly on a logarithmic scale.
inline std::vector<double> frequencies(double from, double to, int count = 240) {
    std::vector<double> all;
    for (int i = 0; i <= count; ++i) all.push_back(from * std::pow(to / from, double(i) / count));
    return all;
}
/// The same, and close to `centre` ever closer: a notch is deeper than any even grid shows.
inline std::vector<double> frequencies_around(double centre, double from, double to) {
    std::vector<double> all = frequencies(from, to);
    for (double away = 0.1; away > 1e-5; away *= 0.8) {
        all.push_back(centre * (1 - away));
        all.push_back(centre * (1 + away));
    }
    std::sort(all.begin(), all.end());
    return all;
}
inline frequency hertz(double f) { return f * 1_Hz; }

template <class Response> line gain(std::string name, const std::vector<double>& at, Response&& response) {
    curve c(std::move(name));
    for (const double f : at) c.add(f, 20 * std::log10(std::abs(response(hertz(f)))));
    return c;
}
/// Degrees without jumps, beginning in (-270, 90].
template <class Response> line phase(std::string name, const std::vector<double>& at, Response&& response) {
    curve c(std::move(name));
    double last = -90;
    for (const double f : at) {
        const double now = std::arg(response(hertz(f))) * 180 / std::numbers::pi;
        c.add(f, last = now + 360 * std::round((last - now) / 360));
    }
    return c;
}
inline panel gains(std::vector<line> lines, std::string label = "gain [dB]", std::string below = "") {
    panel p = over(std::move(below), std::move(label), std::move(lines));
    p.log_x = true;
    return p;
}
inline panel phases(std::vector<line> lines) {
    return gains(std::move(lines), "phase [deg]", "frequency [Hz]");
}
inline panel gains_alone(std::vector<line> lines, std::string label = "gain [dB]") {
    return gains(std::move(lines), std::move(label), "frequency [Hz]");
}
/// The response of a linear block.
template <class Block> auto response_of(const Block& b) {
    return [&b](frequency f) { return std::complex<double>(b.response(f)); };
}

} // namespace block_pictures
