// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The encoder counts in coarser steps than described. Joins the reading. No fit of the plant finds it: every
/// position is a multiple of the count (count_cause in causes.hpp).
inline constexpr effect encoder_quantization{
    .name = "encoder_quantization",
    .label = "encoder quantization",
    .box = "sensor",
    .joins = joint::reading,
    .exciting_motion = "any motion",
    .shows = "positions that are multiples of a coarser count",
    .keys = {machine_key{.name = "encoder.resolution_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "step of the position reading",
                         .at = member<&encoder_description::resolution_m>}},
    .prior = {0.4, "interpolation that is switched off or another scale than in the file"},
    .remedy = "Use a finer scale or interpolation; meanwhile a lower corner of the velocity estimate.",
    .advice =
        [](const plant_model&, double resolution, std::string_view) {
            return fmt::format(
                "a finer scale or interpolation than {:.3g} um; meanwhile a lower corner of the velocity "
                "estimate",
                1e6 * resolution);
        },
    .trial = {.low = 2,
              .high = 400,
              .into =
                  [](trial_machine& m) {
                      m.set("encoder.resolution_m",
                            m.described("encoder.resolution_m") * std::round(m.amplitude));
                  }},
};

} // namespace quadrant::inline v0::diagnosis::suspect
