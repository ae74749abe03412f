// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "friction.hpp"

namespace quadrant_reproduce {

/// The friction experiment again, with the disturbance observer.
inline experiment friction_dob() {
    using namespace thesis;
    const std::string id = "thesis.friction_dob.";
    return {
        "Friction at reversals, with the disturbance observer",
        "[Jamaludin2008] eqs. (4.1-4.20), Tables 4.9 and 4.10",
        "The same runs with the observer of 60 Hz (x) and 90 Hz (y) on B/(s(s+A')). Friction feedforward "
        "enters behind "
        "the observer's tap. At 10 mm/s the static curve makes it worse: its step at the reversal comes at "
        "once, the "
        "friction's over 50 um of way.",
        0.10,
        {{id + "x.none",
          [=] {
              return friction_case<no_friction_model, observer>(x, id + "x.none", "observer alone", {}, 2.5);
          }},
         {id + "x.static",
          [=] { return friction_case<static_curve, observer>(x, id + "x.static", "and static", {}, 2.5); }},
         {id + "x.gms", [=] { return friction_case<gms_model, observer>(x, id + "x.gms", "and GMS", {}, 4); }},
         {id + "y.none",
          [=] {
              return friction_case<no_friction_model, observer>(y, id + "y.none", "observer alone", {}, 2.5);
          }},
         {id + "y.static",
          [=] { return friction_case<static_curve, observer>(y, id + "y.static", "and static", {}, 2.5); }},
         {id + "y.gms",
          [=] { return friction_case<gms_model, observer>(y, id + "y.gms", "and GMS", {}, 4); }}}};
}

} // namespace quadrant_reproduce
