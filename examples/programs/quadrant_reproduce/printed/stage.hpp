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
        .cannot(origin::given, "travel", "0.33", "m",
                "no move of the source comes near the ends of the rails, the longest is 0.3 m: nothing depends "
                "on it")
        .used("resolution of the encoder", "1", "um", 1e6 * stage::motor_of(stage::real).encoder_step.value())
        .used("sampling period", "2", "ms", 1e3 * stage::period.value());
    at("Section IV").used("prediction horizon", "10", "", double(stage::horizon));
    at("Section IV")
        .cannot(origin::simulated, "generations until the mean meets the best", "1000", "",
                "the weights of the fitness, the size of the population and the rates of its operators are not "
                "printed, and the number follows from them; ours is ended after 3750 simulations");
    const std::string far = "stage.move_300mm", near = "stage.move_20mm", short_ = "stage.move_500um.";
    at("Fig. 5").used("distance", "30", "cm", 30).measured("reached at", "1", "s", far, "settling_time");
    at("Fig. 6").measured("peak speed", "1.127", "m/s", far, "peak_speed");
    at("Section VI").measured("peak speed at", "0.5", "s", far, "peak_speed_at");
    at("Fig. 7").used("distance", "2", "cm", 2).measured("reached at", "0.5", "s", near, "settling_time");
    at("Fig. 8").measured("distortion of the current near", "0.15", "s", near, "current_bends_at");
    at("Fig. 9").used("distance", "500", "um", 500).used("time", "0.2", "s", 0.2);
    at("Fig. 9").measured("sticks over the last", "50", "um", short_ + "none", "stuck_from");
    at("Section VI")
        .measured("300 mm, steady error", "0", "um", far, "final_error")
        .measured("20 mm, steady error", "0", "um", near, "final_error")
        .measured("500 um without compensation, steady error", "0", "um", short_ + "none", "final_error")
        .measured("500 um with it, steady error", "0", "um", short_ + "lugre", "final_error");
    at("Fig. 11").used("distance between targets", "10", "um", 10).used("quantum", "1", "um", 1);
    at("Abstract").measured("accuracy", "1", "um", "stage.bs3800", "max_error_at_targets");
    at("Table I").cannot(
        origin::measured, "whole table", "", "",
        "its figures are not in the text of the source that we have: speeds and errors of Figs. 5 to 10");
}

} // namespace quadrant_reproduce
