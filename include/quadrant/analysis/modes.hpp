// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::analysis {

/// One structural or base mode beside the rigid axis, as its partial fraction (in time: block
/// `flexible_modes`):
///   share / (s^2 + 2 damping w s + w^2),   w = 2 pi centre
///   share > 0: anti-resonance below it, at centre/sqrt(1 + share) on a free mass (base; encoder beside the motor)
///   -1 < share < 0: anti-resonance above it, the phase falls by 180 degrees in between; share <= -1: none
/// A base of mass Mb on its bolts under a slide of mass M, the encoder between them: share = M/Mb.
struct flexible_mode {
    frequency centre; ///< undamped natural frequency, > 0
    double damping;   ///< ratio zeta, > 0; half the width of a notch
    double share;     ///< residue over that of the rigid axis

    complex operator()(frequency f) const {
        const complex s = laplace(f);
        const double w = 2 * std::numbers::pi * centre.value();
        return share / (s * s + 2 * damping * w * s + w * w);
    }
    /// Where this mode's own anti-resonance lies against a free mass; share > -1.
    frequency anti_resonance() const {
        require(share > -1, "flexible_mode.share", share, "must be above -1 for an anti-resonance");
        return centre / std::sqrt(1 + share);
    }
};

/// A linear axis with modes, from command to position:
///   G(s) = B e^{-s Td} (1/(s (s + A)) + sum share_i/(s^2 + 2 damping_i w_i s + w_i^2))
/// Modal superposition in parallel form: any number of modes, none needs to know the others. Without modes
/// `rigid_axis_model`.
template <signal_tag Command = signal::voltage> struct flexible_axis_model {
    rigid_axis_model<Command> rigid;
    std::vector<flexible_mode> modes;

    complex operator()(frequency f) const {
        const complex s = laplace(f);
        complex sum = 1.0 / (s * (s + rigid.viscous_rate.value()));
        for (const flexible_mode& mode : modes) sum += mode(f);
        return rigid.gain.value() * std::exp(-s * rigid.delay.value()) * sum;
    }
};
template <class C>
flexible_axis_model(rigid_axis_model<C>, std::vector<flexible_mode>) -> flexible_axis_model<C>;

} // namespace quadrant::inline v0::analysis
