// SPDX-License-Identifier: BSL-1.0
// A transfer function has no `retune`: a cascade runs with it in its resonance slot, and cannot be retuned.
// MUST SAY: retunable_axis_boxes
// MUST SAY: decltype (B::resonance) | decltype(B::resonance)
// MUST SAY: retunable<
// AT MOST: gcc 3300, clang 1800
#include "quadrant/filter/transfer_function.hpp"
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

using estimator = filtered_derivative<signal::position, signal::velocity>;
#ifdef MEND
using filter = notch<signal::voltage>;
#else
using filter = transfer_function<signal::voltage, signal::voltage, 2>;
#endif
using boxes = cascade_p_pi_boxes<estimator, filter>;
static_assert(axis_boxes<boxes>);
void other_parameters(cascade<boxes>& axis, const boxes& next) { axis.retune(next); }
