// SPDX-License-Identifier: BSL-1.0
// A box of the user's own without `retune`: a cascade runs with it in its resonance slot, and cannot be
// retuned.
// MUST SAY: retunable_axis_boxes
// MUST SAY: decltype (B::resonance) | decltype(B::resonance)
// MUST SAY: retunable<
// AT MOST: gcc 3300, clang 1800
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

using estimator = filtered_derivative<signal::position, signal::velocity>;
#ifdef MEND
using filter = notch<signal::voltage>;
#else
class filter {
public:
    using input = signal::voltage;
    using value = quantity_of<signal::voltage>;
    struct parameters {
        double share = 1;
    };
    filter(const parameters& p, duration) : share_(p.share) {}
    value operator()(value x) { return share_ * x; }
    void settle(value) {}
    void reset() {}

private:
    double share_;
};
#endif
using boxes = cascade_p_pi_boxes<estimator, filter>;
static_assert(axis_boxes<boxes>);
void other_parameters(cascade<boxes>& axis, const boxes& next) { axis.retune(next); }
