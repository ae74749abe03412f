// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../experiment/stage_cycle.hpp"
#include "../printed.hpp"
#include "../stage.hpp"

namespace quadrant_reproduce {

/// The precision stage.
inline void print_stage(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, low_source, where); };
    at("Section II")
        .cannot(origin::given, "travel", "0.33", "m", "the rails have no ends in the simulation; 0.3 m is used")
        .used("resolution of the encoder", "1", "um", 1e6 * stage::motor_of(stage::real).encoder_step.value())
        .used("sampling period", "2", "ms", 1e3 * stage::period.value());
    at("Section IV").used("prediction horizon", "10", "", double(stage::horizon));
    at("Section IV")
        .cannot(origin::simulated, "generations until the mean meets the best", "1000", "",
                "weights of the fitness, gains and size of the population are not printed");
    const std::string far = "stage.move_300mm", near = "stage.move_20mm", short_ = "stage.move_500um.";
    at("Fig. 5").used("distance", "30", "cm", 30).measured("reached at", "1", "s", far, "settling_time");
    at("Fig. 6").measured("peak speed", "1.127", "m/s", far, "peak_speed");
    at("Section VI").measured("peak speed at", "0.5", "s", far, "peak_speed_at");
    at("Fig. 7").used("distance", "2", "cm", 2).measured("reached at", "0.5", "s", near, "settling_time");
    at("Fig. 8").cannot(
        origin::measured, "distortion of the current near", "0.15", "s",
        "its height is not printed and the friction of the machine is not given; ours is drawn");
    at("Fig. 9").used("distance", "500", "um", 500).used("time", "0.2", "s", 0.2);
    at("Fig. 9").measured("sticks over the last", "50", "um", short_ + "none", "stuck_from");
    at("Section VI")
        .measured("300 mm, steady error", "0", "um", far, "final_error")
        .measured("20 mm, steady error", "0", "um", near, "final_error")
        .measured("500 um without compensation, steady error", "0", "um", short_ + "none", "final_error")
        .measured("500 um with it, steady error", "0", "um", short_ + "lugre", "final_error");
    at("Fig. 11").used("distance between targets", "10", "um", 10).used("quantum", "1", "um", 1);
    at("Abstract")
        .cannot(origin::measured, "accuracy", "1", "um",
                "a property of the machine; the largest error at our targets is a row of the cycle");
    at("Table I").cannot(
        origin::measured, "whole table", "", "",
        "its figures are not in the text of the source that we have: speeds and errors of Figs. 5 to 10");
}

} // namespace quadrant_reproduce
