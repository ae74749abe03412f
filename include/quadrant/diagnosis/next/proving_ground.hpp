// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/for_machine.hpp"
#include "../fit/with_drives.hpp"
#include "../how_far/closed_loop.hpp"
#include "../how_far/driven_loop.hpp"
#include "../which/causes.hpp"
#include "standard_motions.hpp"

namespace quadrant::inline v0::diagnosis {

/// One of the names that a record does not distinguish: its effect, and the model of the whole axis under this
/// name.
struct confusable {
    const effect* name = nullptr;
    candidate model;

    bool equivalent(const confusable& other) const { return may_be_one(*name, *other.name); }
};

/// What the machine has been asked for and got through: a motion that is proposed keeps inside, with its own
/// gains, so that no joint meets its stop and no drive its limit.
struct proven_limits {
    double low = -std::numeric_limits<double>::infinity(), high = -low; ///< of the position [m]
    double command = high;                                              ///< largest

    proven_limits() = default;
    /// Travel and command of a log. The reading may have passed the ends of the reference.
    explicit proven_limits(const axis_log& log) {
        const auto& x = log.position;
        const auto& r = log.reference.empty() ? x : log.reference;
        low = std::min(*std::min_element(x.begin(), x.end()), *std::min_element(r.begin(), r.end()));
        high = std::max(*std::max_element(x.begin(), x.end()), *std::max_element(r.begin(), r.end()));
        command = 0;
        for (double u : log.command) command = std::max(command, std::abs(u));
    }
    /// Up to `beyond` further than it was shown, and the noise of one more record.
    bool hold(const closed_loop_run& run, double beyond) const {
        constexpr double as_much = 1.1;
        return std::all_of(run.position.begin(), run.position.end(),
                           [&](double y) { return y >= low - beyond && y <= high + beyond; }) &&
               std::all_of(run.command.begin(), run.command.end(),
                           [&](double u) { return std::abs(u) <= as_much * command; });
    }
};

/// Where a motion is tried before the machine drives it: the axis as described, under the controller that runs
/// it or a stand-in, with the noise and the steps of the encoder that its log had.
class proving_ground {
public:
    /// `scale`: of that log. `limits`: that no run may leave.
    proving_ground(const axis_description& axis, double period, double resolution, double noise,
                   const record_scales& scale, const proven_limits& limits = {})
        : axis_(axis), period_(period), resolution_(resolution), scale_(scale), limits_(limits),
          sigma_(std::sqrt(std::max(0.0, noise * noise - resolution * resolution / 12))) {
        axis_.encoder.resolution_m = resolution;
        if (!axis_.controller && !axis_.drive.takes_position())
            axis_.controller =
                axis_.drive.closes() ? stand_in(axis.drive, axis.plant.mass_kg) : stand_in(axis.plant);
    }

    /// A record of the motion as a machine with this plant would leave it, one step a period as in the fits;
    /// empty when it does not follow, or leaves the limits.
    axis_log record(const plant_model& plant, const planned_motion& m) const {
        if (axis_.drive.closes()) return driven_record(plant, m);
        axis_log log;
        log.name = axis_.name;
        log.reference = m.reference;
        const double start = m.reference[0];
        const double held = plant.holding_force(start) / plant.force_constant;
        log.position.assign(m.reference.size(), start);
        log.command.assign(m.reference.size(), held);
        auto run =
            simulate_closed_loop(*axis_.controller, axis_, plant, period_, log, noise(m.reference.size()), 1);
        if (!follows(run, m)) return {};
        log.position = std::move(run.position);
        log.command = std::move(run.command);
        return log;
    }

    /// Log-score by which a record of the motion distinguishes the true name from the other: both fitted again
    /// to a machine that has the truth's plant, the calibration inside its tolerance too, and judged as in
    /// every diagnosis on motion that was not fitted. `whole`: the other name also fitted anew from the machine
    /// file, as the diagnosis of that record would. Two names of one model (docs/formats.md) are distinguished
    /// only where their forces are, as there.
    double gain(const planned_motion& m, const confusable& truth, const confusable& other, bool whole) const {
        const axis_log log = record(truth.model.fit.plant, m);
        if (log.position.empty()) return 0;
        const axis_record r = for_machine(
            prepare(log, period_, resolution_, scales_of(axis_.plant, log, period_, resolution_)), axis_);
        const candidate own = refitted(r, truth.model, whole ? 30 : first_look);
        candidate best = refitted(r, other.model, whole ? 30 : first_look);
        if (whole) {
            const search anew(r, axis_, {}, {.threads = 1}, [](const std::string&) {});
            if (auto c = anew.with(other.model.effects); c.total > best.total) best = std::move(c);
            const auto energy = [&](const candidate& c) {
                const double force = rms(anew.held_out_residual(c));
                return force * force;
            };
            if (truth.equivalent(other) && energy(best) < (1 + told_apart) * energy(own)) return 0;
        }
        return std::isfinite(own.total - best.total) ? own.total - best.total : 0;
    }

private:
    static constexpr int first_look = 6; ///< steps of a fit

    bool follows(const closed_loop_run& run, const planned_motion& m) const {
        const auto ends = std::minmax_element(m.reference.begin(), m.reference.end());
        const double low = *ends.first, high = *ends.second, far = std::max(high - low, 1000 * resolution_);
        return std::all_of(run.position.begin(), run.position.end(),
                           [&](double y) { return y > low - far && y < high + far; }) &&
               limits_.hold(run, 3 * sigma_ + resolution_);
    }
    /// The same where a drive closes its loops on the plant: what it was asked for, and the motion.
    axis_log driven_record(plant_model plant, const planned_motion& m) const {
        const std::size_t n = m.reference.size();
        const double start = m.reference[0];
        plant.drive.start_force = plant.holding_force(start); // it stands there
        plant.drive.received.reset();                         // other set-points are lost, on average as many
        const bool asks = axis_.drive.kind == drive_kind::velocity;
        axis_log log;
        log.name = axis_.name;
        log.kind = axis_.kind;
        log.reference = m.reference;
        log.position.assign(n, start);
        log.command_unit = !asks                        ? std::string()
                           : axis_.drive.velocity_per_V ? std::string("V")
                                                        : key_of("m_per_s", axis_.kind);
        if (asks) log.command.assign(n, 0.0);
        std::vector<double> asked(n);
        log.drive = detail::with_drive(axis_, log, period_).drive;
        auto run = simulate_driven(axis_, plant, period_, log, noise(n), &asked);
        if (!follows(run, m)) return {};
        log.position = std::move(run.position);
        if (asks) log.command = std::move(asked);
        return detail::with_drive(axis_, log, period_);
    }
    /// P on position for a velocity drive whose controller is not described, an eighth as fast as its loop,
    /// with the whole velocity fed forward.
    static controller_description stand_in(const drive_description& d, double mass) {
        const double per_unit = d.velocity_per_V.value_or(1);
        controller_description c;
        c.kind = "p_velocity";
        c.set("position_gain_V_per_m", d.velocity_gain_N_s_per_m.value_or(0) / mass / 8 / per_unit);
        c.set("velocity_feedforward_V_s_per_m", 1 / per_unit);
        return c;
    }

    /// P and PI of the velocity for an axis whose controller is not described, with the crossover that its dead
    /// time allows and the feedforward of its mass and its viscous friction.
    controller_description stand_in(const plant_description& p) const {
        const double dead_time = p.delay_s + axis_.actuator.lag_s.value_or(0) + 1.5 * period_;
        const double crossover = std::min(0.5 / scale_.response(), 0.35 / dead_time);
        const double gain = crossover * p.mass_kg / p.force_constant_N_per_V;
        controller_description c;
        c.set("position_gain_per_s", crossover / 4);
        c.set("velocity_gain_V_s_per_m", gain);
        c.set("velocity_integral_V_per_m", gain * crossover / 5);
        c.set("velocity_filter_Hz", std::min(0.25 / period_, 8 * crossover / (2 * std::numbers::pi)));
        c.set("velocity_feedforward", 1);
        c.set("acceleration_feedforward_V_s2_per_m", p.mass_kg / p.force_constant_N_per_V);
        c.set("viscous_feedforward_V_s_per_m", p.viscous_N_s_per_m / p.force_constant_N_per_V);
        return c;
    }

    static candidate refitted(const axis_record& r, const candidate& model, int steps) {
        candidate c{.effects = model.effects};
        plant_model start = model.fit.plant;
        if (start.drive.losses_known()) start.drive.received = r.observer.received(start);
        c.fit = fitter(r.observer, r.score).fit(start, resumed(model.fit), steps);
        c.total = -std::numeric_limits<double>::infinity();
        judge(r, c);
        return c;
    }
    /// White, the same for every motion of one length (Box and Muller: the same on every library).
    std::vector<double> noise(std::size_t rows) const {
        std::mt19937_64 random(20080901);
        const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
        std::vector<double> out(rows);
        for (double& v : out) {
            const double radius = std::sqrt(-2 * std::log(uniform()));
            v = sigma_ * radius * std::cos(2 * std::numbers::pi * uniform());
        }
        return out;
    }

    axis_description axis_;
    double period_, resolution_;
    record_scales scale_;
    proven_limits limits_;
    double sigma_;
};

} // namespace quadrant::inline v0::diagnosis
