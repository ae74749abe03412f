// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "friction_run.hpp"

#include <quadrant/observer/ferraris_force_estimator.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>
#include <quadrant/process/milling_harmonics.hpp>

#include <array>

/// The observers of [Jamaludin2008] chapters 4 and 5 and Appendices C and D as boxes for the disturbance slot
/// of `milling_axis`: position and wanted command in, what has to be subtracted from the command out; `applied`
/// tells what was sent. `sense` brings the acceleration sensor.
namespace thesis {

using volt = quantity_of<signal::voltage>;

/// What an observer in the slot of `milling_axis` is made from, and what it has besides the loop's wires.
struct slot_parameters {
    axis of = y;
    bool feeds_back = true;
};
/// Section 4.3: the inverse model.
class by_inverse_model {
public:
    using parameters = slot_parameters;
    by_inverse_model(const parameters& p, duration T)
        : box_({p.of.corner, quadrant::axis_model<signal::voltage>{p.of.B, p.of.A}}, T) {}
    void sense(quantity_of<signal::acceleration>) noexcept {}
    void reset() noexcept { box_.reset(); }
    volt operator()(quantity<si::length> position, volt wanted) noexcept { return box_(position, wanted); }
    void applied(volt u) noexcept { box_.applied(u); }

private:
    disturbance_observer<signal::voltage> box_;
};
/// No observer, in the same form.
struct nothing_observed {
    using parameters = slot_parameters;
    nothing_observed(const parameters&, duration) {}
    void sense(quantity_of<signal::acceleration>) noexcept {}
    void reset() noexcept {}
    volt operator()(quantity<si::length>, volt) noexcept { return {}; }
    void applied(volt) noexcept {}
};
/// Eq. (5.6): from the Ferraris sensor, filtered by the same Q. Without `feeds_back` it only estimates.
class by_ferraris {
public:
    using parameters = slot_parameters;
    by_ferraris(const parameters& p, duration T)
        : box_({.mass = p.of.kf / p.of.B, .force_constant = p.of.kf, .corner = p.of.corner}, T),
          feeds_back_(p.feeds_back) {}
    void sense(quantity_of<signal::acceleration> a) noexcept { acceleration_ = a; }
    void reset() noexcept { box_.reset(), applied_ = volt(); }
    volt operator()(quantity<si::length>, volt) noexcept {
        force_ = box_(acceleration_, applied_);
        return feeds_back_ ? box_.command() : volt();
    }
    void applied(volt u) noexcept { applied_ = u; }
    quantity_of<signal::force> force() const noexcept { return force_; }

private:
    ferraris_force_estimator<signal::voltage> box_;
    quantity_of<signal::acceleration> acceleration_{};
    quantity_of<signal::force> force_{};
    volt applied_{};
    bool feeds_back_;
};
/// Appendix C: the force from position and acceleration, behind the same Q.
class by_reduced_order {
public:
    using parameters = slot_parameters;
    using low_pass = transfer_function<signal::force, signal::force, 2>;
    by_reduced_order(const parameters& p, duration T)
        : kf_(p.of.kf), box_({.mass = p.of.kf / p.of.B, .force_constant = p.of.kf, .corner = 20_Hz}, T),
          q_(low_pass::of(bilinear_differences(q_filter<2, 0>(p.of.corner), T), T)) {}
    void sense(quantity_of<signal::acceleration> a) noexcept { acceleration_ = a; }
    void reset() noexcept { box_.reset(), q_.reset(), applied_ = volt(); }
    volt operator()(quantity<si::length> position, volt) noexcept {
        box_(position, acceleration_, applied_);
        return q_(box_.disturbance()) / kf_;
    }
    void applied(volt u) noexcept { applied_ = u; }

private:
    gain_of<signal::force, signal::voltage> kf_;
    reduced_order_observer<signal::voltage> box_;
    low_pass q_;
    quantity_of<signal::acceleration> acceleration_{};
    volt applied_{};
};
/// Appendix D: the first harmonics of the cutter themselves. Where the thesis put the poles is not printed:
/// ours are those of the harmonics, shifted left by 200 1/s.
template <std::size_t Count> class by_harmonics {
public:
    struct parameters : slot_parameters {
        std::array<frequency, Count> at = multiples();
    };
    by_harmonics(const parameters& p, duration T)
        : box_({.plant = {p.of.B, p.of.A_gms},
                .harmonics = p.at,
                .design = placed_poles<Count>::shifted(p.at, 200.0 / 1_s)},
               T) {}
    void sense(quantity_of<signal::acceleration>) noexcept {}
    void reset() noexcept { box_.reset(), applied_ = volt(); }
    void settle(quantity<si::length> at, volt estimate) noexcept { box_.settle(at), applied_ = -estimate; }
    volt operator()(quantity<si::length> position, volt) noexcept { return box_(position, applied_); }
    void applied(volt u) noexcept { applied_ = u; }

private:
    static std::array<frequency, Count> multiples() {
        std::array<frequency, Count> all;
        for (std::size_t i = 0; i < Count; ++i) all[i] = double(i + 1) * milling_harmonics::fundamental;
        return all;
    }
    harmonic_force_observer<signal::voltage, Count> box_;
    volt applied_{};
};

} // namespace thesis
