// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "cutting.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// The masses of the machine, over the one that its controller believes.
inline constexpr std::array chapter_masses{0.5, 0.75, 1.0, 1.25, 1.5};

/// Chapter 2: the cascade on another mass. What the sensitivity rises to, and how far a force moves
/// the axis.
inline outcome cascade_chapter(const std::string& id) {
    using namespace quadrant::literals;
    namespace qa = quadrant::analysis;
    const band b{qa::hertz(0.5), qa::hertz(900)};
    outcome out;
    picture drawn{
        "Chapter 2: the cascade on another mass",
        "Largest sensitivity of the position loop, and bandwidth, over the mass of the machine; gains of the "
        "tables.",
        {panel{.x_label = "", .y_label = "max |S|", .lines = {}},
         panel{.x_label = "mass, machine over controller", .y_label = "bandwidth [Hz]", .lines = {}}}};
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        line peak{.name = std::string("axis ") + a->name, .x = {}, .y = {}}, reach = peak;
        for (double mass = 0.5; mass < 1.505; mass += 0.05) {
            thesis::axis other = *a;
            other.B = a->B / mass, other.A = a->A / mass; // the friction stays
            const auto loop = thesis::loop_around(thesis::model_of(other), other);
            double most = 0;
            for (const auto& f : qa::grid(b)) most = std::max(most, std::abs(loop.sensitivity(f)));
            const auto width =
                qa::sensitivity_bandwidth([&](quadrant::frequency f) { return loop.sensitivity(f); }, b);
            peak.x.push_back(mass), peak.y.push_back(most);
            reach.x.push_back(mass), reach.y.push_back(width ? width->value() : 0);
        }
        const std::string name = a->name;
        out.rows.push_back({id, name + "_peak_minus_50", "1", peak.y.front(), {}, {}, {}, "half the mass"});
        out.rows.push_back({id, name + "_peak", "1", peak.y[10], {}, {}, {}, ""});
        out.rows.push_back(
            {id, name + "_peak_plus_50", "1", peak.y.back(), {}, {}, {}, "one and a half times the mass"});
        drawn.panels[0].lines.push_back(std::move(peak));
        drawn.panels[1].lines.push_back(std::move(reach));
    }
    out.pictures = {std::move(drawn)};
    return out;
}

/// What a legend says of a friction feedforward.
inline std::string fed_forward_words(std::string_view name) {
    return name == "none" ? "no friction fed forward" : name == "static" ? "static curve" : "GMS";
}

/// Chapters 3 and 4: largest radial deviation on the circle without a cutter, on friction by another law and
/// another mass, through `xy_loop`.
template <class... Configurations>
outcome friction_chapter(const std::string& id, const std::string& title,
                         const std::array<const char*, sizeof...(Configurations)>& names) {
    outcome out;
    panel drawn{
        .x_label = "mass, machine over controller", .y_label = "largest radial deviation [um]", .lines = {}};
    std::size_t which = 0;
    const auto one = [&]<class Configuration>(Configuration) {
        line curve{.name = fed_forward_words(names[which]), .x = {}, .y = {}};
        for (const double mass : chapter_masses) {
            const thesis::cut c{.force = 0, .mass = mass, .turns = 2};
            const auto found = thesis::mill<Configuration, thesis::lugre_plant>(c);
            curve.x.push_back(mass);
            curve.y.push_back(found.diverged ? std::numeric_limits<double>::quiet_NaN() : found.largest);
            if (mass == 0.5 || mass == 1 || mass == 1.5)
                out.rows.push_back({id,
                                    fmt::format("{}_mass_{:g}", names[which], mass),
                                    "um",
                                    found.diverged ? std::nullopt : std::optional(found.largest),
                                    {},
                                    {},
                                    {},
                                    found.diverged ? stopped_note : ""});
        }
        drawn.lines.push_back(std::move(curve));
        ++which;
    };
    (one(Configurations{}), ...);
    out.pictures = {{title,
                     "Circle of 30 mm at 100 mm/s; the machine has LuGre friction with levels 10 % higher, the "
                     "controller believes the tables. A line ends where the run was unstable.",
                     {std::move(drawn)}}};
    return out;
}

inline experiment chapters() {
    using namespace thesis;
    const std::string two = "thesis.robustness.cascade", three = "thesis.robustness.friction",
                      four = "thesis.robustness.observer";
    return {"Chapters 2 to 4 on another machine",
            "not in the thesis; its Tables 2.2, 4.2 and 4.9",
            "What each chapter designs, on a machine with half to one and a half times the mass and, where "
            "friction "
            "counts, with friction by another law than the controller's; chapter 5 has a section of its own "
            "(milling.robustness). "
            "All but the responses of chapter 2 run through `xy_loop`.",
            0.10,
            {{two, [=] { return cascade_chapter(two); }},
             {three,
              [=] {
                  return friction_chapter<configuration<no_friction_model, no_observer, no_memory>,
                                          configuration<static_curve, no_observer, no_memory>,
                                          configuration<gms_model, no_observer, no_memory>>(
                      three, "Chapter 3: friction feedforward on another machine", {"none", "static", "gms"});
              }},
             {four, [=] {
                  return friction_chapter<configuration<no_friction_model, observer, no_memory>,
                                          configuration<static_curve, observer, no_memory>,
                                          configuration<gms_model, observer, no_memory>>(
                      four, "Chapter 4: the observer on another machine", {"none", "static", "gms"});
              }}}};
}

} // namespace quadrant_reproduce
