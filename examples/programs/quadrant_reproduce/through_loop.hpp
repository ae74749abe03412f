// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string_view>

/// Which experiments run through `xy_loop`, the library's loop of a whole table. This is the one place that
/// says so; tests/reproduce/*through_xy_loop.cpp hold it.
namespace quadrant_reproduce {

struct through_loop {
    std::string_view experiment; ///< its title
    std::string_view words;      ///< how, or why not
    bool runs;
};

namespace through {
inline constexpr std::string_view same = "one axis of it gives the same figures, bit for bit",
                                  itself = "is one", law = "transfer functions: nothing moves",
                                  cnc = "both axes of it give the same errors to 1e-9 of the largest";
} // namespace through

inline constexpr through_loop through_loops[] = {
    {"Frequency responses of the simulated axis",
     "the loop is open; its table alone, with the other axis driven, gives the same figures, bit for bit",
     false},
    {"The cascade on its model", through::law, false},
    {"The cascade on the model with a base mode and a structural mode", through::law, false},
    {"The inverse model fed forward", through::same, true},
    {"The pole beside GMS friction",
     "the loop is open; its table alone, with the other axis driven, gives the same figures, bit for bit",
     false},
    {"The cascade with the disturbance observer", through::law, false},
    {"How far the observer's filter may reach", through::law, false},
    {"A sinusoidal force against the observer", through::same, true},
    {"Repetitive control", "transfer functions and the design of filters; the memory runs in the cuts below",
     false},
    {"Friction at reversals, without observer", through::same, true},
    {"Friction at reversals, with the disturbance observer", through::same, true},
    {"A circle of 30 mm at 100 mm/s", through::same, true},
    {"The circle at 10 mm/s", through::same, true},
    {"Identification from simulated runs", through::same, true},
    {"The synthesized cutting force", "a force alone: no axis is in it", false},
    {"Observers against the cutter's harmonics", through::same, true},
    {"Calibration of the Ferraris sensor", "a sensor on a motion that is given: no loop is in it", false},
    {"The harmonic force observer",
     "one axis of it gives the same figures, bit for bit; eqs. (D.14) and (D.15) are transfer functions", true},
    {"Cutting along a circle", through::itself, true},
    {"The real cut", through::itself, true},
    {"How much may the tables be wrong", through::itself, true},
    {"What would make 10 um of 1.2", through::same, true},
    {"Chapters 2 to 4 on another machine", "is one; the responses of chapter 2 are transfer functions", true},
    {"A machine that changes", through::itself, true},
    {"What is not printed, as bands", through::itself, true},
    {"The parts of the Virtual CNC's feed drive", "single blocks: no loop is in it", false},
    {"The Virtual CNC along a diamond and a circle", through::cnc, true},
    {"CL files through reader, look-ahead and interpolator",
     "both axes of it give the same errors to 1e-9 of the largest; profiles alone move no axis", true},
    {"Margins of the Virtual CNC's control laws", through::law, false},
    {"Fuzzy tuning of the sliding mode law", "x gives the same trial to 1e-9 while y rests", true},
    {"The Virtual CNC with an accelerometer, and on another machine",
     "y gives the same errors to 1e-9 with the accelerometer; the other machine differs in its numbers", true},
    {"Moves of the precision stage", through::same, true},
    {"The linear cycle of BS 3800", through::same, true},
    {"The drive and the friction of the stage", through::same, true},
    {"The precision stage on another machine", through::same, true},
    {"Tuning the precision stage", "each of its moves: one axis of it gives the same, bit for bit", true}};

/// Nothing for a title that is not in the list.
inline const through_loop* through_loop_of(std::string_view experiment) {
    for (const through_loop& t : through_loops)
        if (t.experiment == experiment) return &t;
    return nullptr;
}

} // namespace quadrant_reproduce
