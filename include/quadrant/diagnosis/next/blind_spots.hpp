// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/effect_list.hpp"
#include "../result/result.hpp"

#include <algorithm>
#include <array>

namespace quadrant::inline v0::diagnosis {

/// What an encoder reads wrongly or does not reach is in no log of that encoder: the loop holds the reading,
/// not the tool, where it should be. What it is, and the instrument that sees it.
struct blind_spot {
    std::string_view what, instrument;
};
inline constexpr std::array blind_spots_of_a_line{
    blind_spot{"a scale error of the encoder", "a laser interferometer, or a step gauge, along the travel"},
    blind_spot{"squareness to another axis, and straightness",
               "a ball-bar in a circle, or a square and a dial gauge"},
    blind_spot{"play and bending between encoder and tool",
               "a dial gauge at the tool while the axis reverses, or a ball-bar"},
};
inline constexpr std::array blind_spots_of_an_angle{
    blind_spot{"a scale error of the encoder, and its eccentricity",
               "a polygon mirror and an autocollimator over one turn"},
    blind_spot{"tilt and run-out of the axis", "a master ball or a test bar and a dial gauge"},
    blind_spot{"play and torsion between encoder and table",
               "a dial gauge on an arm of the table while the axis reverses"},
};

/// Where it bears on what was said of an axis: a claim that machine and simulation agree holds as far as the
/// encoder sees, and a suspected sensor is evaluated on its own reading. Else nothing: the log shows enough
/// that is unexplained.
inline std::vector<unseen> unseen_by(const axis_result& a, const std::vector<cause>& causes) {
    const auto of_the_sensor = [](std::string_view name) {
        const effect* e = effect_named(name);
        return e && e->box == "sensor";
    };
    const bool sensor = std::any_of(causes.begin(), causes.end(), [&](const cause& c) {
        return c.axis == a.name &&
               (of_the_sensor(c.effect) ||
                std::any_of(c.confusable_with.begin(), c.confusable_with.end(), of_the_sensor));
    });
    if (!sensor && a.verdict > verdict::explained) return {};
    std::vector<unseen> out;
    for (const blind_spot& b : a.kind == axis_kind::rotary ? blind_spots_of_an_angle : blind_spots_of_a_line)
        out.push_back({a.name, std::string(b.what), std::string(b.instrument)});
    return out;
}

} // namespace quadrant::inline v0::diagnosis
