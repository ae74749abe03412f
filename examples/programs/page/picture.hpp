// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What svg.hpp draws.
namespace quadrant_page {

/// A curve; points with a value that is not finite interrupt it.
struct line {
    std::string name;
    std::vector<double> x, y;
    enum class style { solid, dashed, points } drawn = style::solid;
};

/// One diagram. Panels of one picture stand below each other (Bode: gain, phase).
struct panel {
    std::string x_label, y_label;
    std::vector<line> lines;
    bool log_x = false, log_y = false;
    bool square = false; ///< equal scales: Nyquist
    bool polar = false;  ///< x in degrees, y as radius about `polar_zero`
    double polar_zero = 0;
    std::optional<std::pair<double, double>> x_range{}, y_range{};
};

struct picture {
    std::string title, caption;
    std::vector<panel> panels;
};

} // namespace quadrant_page
