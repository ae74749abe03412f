// SPDX-License-Identifier: BSL-1.0
// The inverse model is asked with position and velocity, not with velocity and acceleration.
// MUST SAY: inverse_model<quadrant::v0::signal::voltage | inverse_model<signal::voltage
// MUST SAY: no match for call | no matching function for call
// AT MOST: gcc 6100, clang 1000
#include "quadrant/feedforward/inverse_model.hpp"
using namespace quadrant;

quantity<si::electric_potential> command(inverse_model<signal::voltage>& model, const axis_motion<>& m) {
#ifdef MEND
    return model(m.velocity, m.acceleration);
#else
    return model(m.position, m.velocity);
#endif
}
