// SPDX-License-Identifier: BSL-1.0
// A box of the user's own that does not say its state: a series gives the state of each of its blocks.
// MUST SAY: in_series_with
// MUST SAY: gain
// AT MOST: gcc 1900, clang 1500
#include "quadrant/block/series.hpp"
#include "quadrant/filter/notch.hpp"
using namespace quadrant;

class gain {
public:
    using input = signal::voltage;
    using output = signal::voltage;
    using value = quantity_of<signal::voltage>;
    struct parameters {
        double share = 1;
    };
    gain(const parameters& p, duration) : share_(p.share) {}
    value operator()(value x) noexcept { return share_ * x; }
    void settle(value) noexcept {}
    void reset() noexcept {}
#ifdef MEND
    double now() const noexcept { return share_; }
#endif

private:
    double share_;
};
using chain = series<notch<signal::voltage>, gain>;
const auto size = sizeof(chain);
