// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/signal.hpp"
#include "tool_entry.hpp"
#include "turning_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace quadrant::inline v0 {

/// Which way an edge goes through the chip: up (conventional) from thin to thick, down (climb) from thick to
/// thin.
enum class milling { up, down };

/// The force of an end mill on the table, from the process: the sum over the edges that are in the cut.
///   tangential_j = depth (Kt h_j + Kte), radial_j = depth (Kr h_j + Kre),  h_j = feed per tooth * sin(phi_j)
///   feed: sum -tangential cos(phi_j) - radial sin(phi_j);  normal: sum tangential sin(phi_j) - radial cos(phi_j)
/// phi turns clockwise (M3) from the normal, the feed is at 90 deg; in the cut: 0 ... acos(1 - 2
/// radial/diameter) milling up, pi minus that ... pi down. Runout moves edge j out by r_j = runout cos(2 pi
/// j/Edges - angle); it then cuts what is left of the paths of the edges m before it, h_j = max(0, min_m (m
/// feed sin(phi_j) + r_j - r_{j+m})), so that the force repeats with the spindle, not with the tooth.
/// Source: [Altintas2012] chapter 2 (zero helix), runout [Kline1983].
/// Ports: the direction [rad, from x towards y] in which the table moves against the tool; out the force [N] on
/// the table, x and y, mean of the coming period (by the midpoints of `substeps`), as a plant holds it. For the
/// force on the tool give the direction of the tool; both are pushed back against their own motion. Edge 0
/// begins at phi = 0. engage(false) lets the tool leave the cut, engage(true) enter it: the force fades within
/// `entry`, the spindle turns on.
/// State: the spindle's angle, an integer that never drifts, and how far the tool is in the cut. `reset`: t =
/// 0, in the cut; `settle(t, engaged)`: so long after that.
/// Range: rigid tool, straight edges, chip much thinner than the cutter's radius. The passing of the edges
/// below half the sampling rate. A dual carries no derivatives by spindle, diameter and radial depth, at which
/// edges enter and leave.
/// NaN and infinities in the direction: gives the last force, the spindle stands, raises faulted().
/// Throws "milling_force.<field> = ...: must ..." for every field and the period.
/// Cost: substeps times Edges sines and cosines, with runout Edges times more subtractions. Measured harmonics:
/// `cutting_force`.
template <std::size_t Edges, class Real = double>
requires(Edges > 0) class milling_force {
public:
    using output = signal::force;
    using number = parameter_real<Real>; ///< of parameters
    using force = quantity_of<signal::force, Real>;
    using length = quantity_of<signal::position, number>;
    using edge_coefficient = gain_of<signal::force, signal::position, number>; ///< N/m
    using cutting_coefficient =
        quantity<unit_quotient<typename edge_coefficient::unit_type, si::length>, number>; ///< N/m^2
    /// Force on the table [N], positive along its axes.
    struct value {
        force x{}, y{};
    };

    /// Spindle, cutter and chip, the coefficients of the material, and runout.
    struct parameters {
        frequency spindle; ///< turns per second; 0 < Edges * spindle < half the sampling rate
        quantity_of<signal::position> diameter;     ///< of the cutter; > 0
        length feed_per_tooth;                      ///< > 0
        length axial_depth;                         ///< > 0
        quantity_of<signal::position> radial_depth; ///< 0 < it <= diameter; diameter: slot
        milling way = milling::up;                  ///< without effect in a slot
        cutting_coefficient tangential;             ///< Kt; > 0
        cutting_coefficient radial;                 ///< Kr; >= 0
        edge_coefficient edge_tangential{};         ///< Kte: rubbing, whatever the chip; >= 0
        edge_coefficient edge_radial{};             ///< Kre; >= 0
        length runout{};                            ///< of the cutter's axis from the spindle's; >= 0
        double runout_angle = 0;                    ///< [rad] from edge 0 to where it is largest
        duration entry{};                           ///< in which the tool enters or leaves the cut; >= 0
        std::size_t substeps = 8;                   ///< per servo period; 1 ... 1000
    };
    /// Where the cutter stands, and how far it is in the cut.
    struct state {
        turning_phase turn;
        tool_entry tool;
    };

    milling_force(const parameters& p, duration period)
        : given_(checked(p, period)), tangential_(in_real<Real>(p.tangential * p.axial_depth)),
          radial_(in_real<Real>(p.radial * p.axial_depth)),
          edge_tangential_(in_real<Real>(p.edge_tangential * p.axial_depth)),
          edge_radial_(in_real<Real>(p.edge_radial * p.axial_depth)), feed_(in_real<Real>(p.feed_per_tooth)) {
        const double arc = std::acos(std::max(-1.0, 1 - 2 * double(p.radial_depth / p.diameter))); // 0 ... pi
        const auto count = [](double angle) {
            return static_cast<std::uint64_t>(
                std::ldexp(static_cast<long double>(angle / std::numbers::pi), 63));
        };
        first_ = p.way == milling::up ? 0 : count(std::numbers::pi - arc);
        last_ = p.way == milling::up ? count(arc) : half_turn;
        for (std::size_t j = 0; j < Edges; ++j) {
            place_[j] = turning_phase::counts(static_cast<long double>(j) / static_cast<long double>(Edges));
            out_of_centre_[j] =
                in_real<Real>(p.runout * number(std::cos(turning_phase::angle(place_[j]) - p.runout_angle)));
        }
        state_ = {turning_phase(p.spindle, period), tool_entry("milling_force.entry", p.entry, period)};
    }

    value operator()(Real direction = Real(0)) noexcept {
        using std::cos, std::sin;
        if (!finite(direction)) {
            fault_ = true;
            return last_force_;
        }
        force along{}, across{};
        const double n = static_cast<double>(given_.substeps);
        for (std::size_t i = 0; i < given_.substeps; ++i) {
            const double share = (static_cast<double>(i) + 0.5) / n; // of the period
            const std::uint64_t turn =
                state_.turn.count() +
                static_cast<std::uint64_t>(static_cast<double>(state_.turn.increment()) * share);
            for (std::size_t j = 0; j < Edges; ++j) {
                const std::uint64_t at = turn + place_[j];
                if (at < first_ || at > last_) continue;
                const double angle = turning_phase::angle(at);
                const Real s = Real(std::sin(angle)), c = Real(std::cos(angle));
                const auto h = chip(j, s);
                if (!(h > decltype(h)())) continue;
                const force tangential = tangential_ * h + edge_tangential_,
                            radial = radial_ * h + edge_radial_;
                along -= tangential * c + radial * s;
                across += tangential * s - radial * c;
            }
        }
        const Real part = Real(state_.tool.depth() / n), c = Real(cos(direction)), s = Real(sin(direction));
        state_.turn.advance();
        state_.tool.advance();
        return last_force_ = {(along * c - across * s) * part, (along * s + across * c) * part};
    }
    void engage(bool in_the_cut) noexcept { state_.tool.engage(in_the_cut); }
    void reset() noexcept { settle(duration()); }
    void settle(duration t, bool engaged = true) noexcept {
        if (!finite(t)) {
            fault_ = true;
            return;
        }
        state_.turn.settle(t);
        state_.tool.settle(engaged);
        last_force_ = {};
        fault_ = false;
    }

    double entry_angle() const noexcept { return angle(first_); } ///< [rad], 0 ... pi
    double exit_angle() const noexcept { return angle(last_); }
    bool faulted() const noexcept { return fault_; }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    using way = quantity_of<signal::position, Real>;
    static constexpr std::uint64_t half_turn = std::uint64_t(1) << 63;

    static double angle(std::uint64_t count) noexcept {
        return std::ldexp(static_cast<double>(count), -63) * std::numbers::pi;
    }
    /// What edge j finds: the edges after it in number were there before it in time.
    way chip(std::size_t j, Real sine) const noexcept {
        way thinnest = feed_ * (sine * Real(static_cast<double>(Edges))); // since its own last turn
        for (std::size_t m = 1; m < Edges; ++m) {
            const way h = feed_ * (sine * Real(static_cast<double>(m))) + out_of_centre_[j] -
                          out_of_centre_[(j + m) % Edges];
            if (h < thinnest) thinnest = h;
        }
        return thinnest;
    }
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("milling_force.period", period);
        const double highest = 0.5 / (period.value() * static_cast<double>(Edges));
        require(p.spindle.value() > 0 && p.spindle.value() < highest, "milling_force.spindle", p.spindle,
                "must lie between 0 and half the sampling rate by the number of edges (" +
                    detail::shortest(detail::in_unit(highest, " Hz")) + ")");
        require_positive<Real>("milling_force.diameter", p.diameter);
        require_positive<Real>("milling_force.feed_per_tooth", p.feed_per_tooth);
        require_positive<Real>("milling_force.axial_depth", p.axial_depth);
        require_positive<Real>("milling_force.radial_depth", p.radial_depth);
        require(p.radial_depth <= p.diameter, "milling_force.radial_depth", p.radial_depth,
                "must not be beyond the diameter (" + detail::shortest(p.diameter) + ")");
        require_positive<Real>("milling_force.tangential", p.tangential);
        require_not_negative<Real>("milling_force.radial", p.radial);
        require_not_negative<Real>("milling_force.edge_tangential", p.edge_tangential);
        require_not_negative<Real>("milling_force.edge_radial", p.edge_radial);
        require_not_negative<Real>("milling_force.runout", p.runout);
        require_finite<Real>("milling_force.runout_angle", p.runout_angle);
        require(p.substeps >= 1 && p.substeps <= 1000, "milling_force.substeps",
                static_cast<double>(p.substeps), "must lie between 1 and 1000");
        return p;
    }

    parameters given_;
    gain_of<signal::force, signal::position, Real> tangential_, radial_; ///< per chip thickness
    force edge_tangential_, edge_radial_;
    way feed_;
    std::uint64_t first_ = 0, last_ = 0; ///< where the cut begins and ends, of `turning_phase`
    std::array<std::uint64_t, Edges> place_{};
    std::array<way, Edges> out_of_centre_{};
    state state_;
    value last_force_;
    bool fault_ = false;
};

} // namespace quadrant::inline v0
