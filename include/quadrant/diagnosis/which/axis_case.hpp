// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/log.hpp"
#include "../log/sensor_box.hpp"
#include "../where/controller_mismatch.hpp"
#include "pieces.hpp"
#include "restart.hpp"
#include "search.hpp"

#include <array>
#include <optional>

namespace quadrant::diagnosis {

/// One axis under diagnosis, everything found out once: where its wires disagree and the models on the way
/// from the machine file to its causes. What is said of them (causes.hpp, how_far.hpp, block_places.hpp) only
/// reads it.
class axis_case {
public:
    axis_case(const axis_description& a, const axis_log& l, const axis_log* other, double period,
              const std::vector<std::string>& excluded, const rules& r, const progress& tell,
              held_by how = held_by::readings)
        : axis(a), log(l), holdout(other), limits(r), count(observed_count(l.position, l.position_step)),
          resolution(std::max({a.encoder.resolution_m, coarse() ? count : 0.0, l.position_step})),
          record(for_machine(
              in_pieces(prepare(l, period, resolution, scales_of(a.plant, l, period, resolution)), motions), a,
              how)),
          models(record, a, excluded, r, tell) {
        const auto is_excluded = [&](const char* effect) {
            return std::find(excluded.begin(), excluded.end(), effect) != excluded.end();
        };
        // A velocity drive's controller commands set-points; how far a difference there moves the axis no force
        // tells. What was measured behind an amplifier is not what the controller asked for.
        if (axis.controller && log.has_reference && log.as_sampled && !axis.drive.closes() &&
            axis.actuator.command_is == command_origin::asked)
            controller = judge_controller(*axis.controller, axis.actuator, log, record,
                                          coarse() ? count : axis.encoder.resolution_m);
        if (controller && is_excluded("added_command")) controller->added.reset();
        controller_unnamed = controller_differs() && !command_is_added() && is_excluded("controller_mismatch");
        if (controller_unnamed) controller->mended = false;
        if (holdout)
            second = for_machine(
                in_pieces(prepare(*holdout, period, resolution, record.scale), motions_of_second), axis, how);
        count_unnamed = coarse() && is_excluded("encoder_quantization");
        follow(models.run());
        if (!second || !record.replayed() || best().effects.empty()) return;
        const auto worth_of = [&](const candidate& m) { return worth(m); };
        if (auto more = models.most_worth(best(), least_score(), worth_of); !search::same(more, best()))
            follow(models.path_to(more));
    }
    axis_case(const axis_case&) = delete; // the record and the models refer to it
    axis_case& operator=(const axis_case&) = delete;

    const axis_description& axis;
    const axis_log& log;
    const axis_log* holdout;
    rules limits;
    double count;      ///< the step in which the position really moves [m]
    double resolution; ///< the described one, or the real one where that is coarser [m]
    std::size_t motions = 0, motions_of_second = 0; ///< that the log holds, and the hold-out log
    axis_record record;
    search models;
    std::optional<axis_record> second; ///< the hold-out log
    std::optional<controller_finding> controller;
    std::vector<candidate> path; ///< the calibrated machine, then with one cause more each
    std::size_t claims = 0;      ///< of the causes, the first on the path
    double noise = 0;            ///< white noise of the position [m]
    bool count_unnamed = false; ///< a coarser count than described, and the machine file excludes it as a cause
    bool controller_unnamed = false; ///< replay differs, and the machine file excludes that as a cause
    bool settled = false;            ///< the last model leaves noise, or nothing that matters to the owner
    bool settled_on_second = true;   ///< the same on the hold-out log
    /// What is left speaks against no cause: it does not matter to the owner, and what the causes take off
    /// does.
    bool excused = false;

    const candidate& best() const { return path.back(); }
    /// The model of the claims alone: what apply writes.
    const candidate& applied() const { return path[claims]; }
    /// Takes another way from the machine file to its causes.
    void follow(std::vector<candidate> way) {
        path = std::move(way);
        claims = path.size() - 1;
        noise = models.noise(best());
        settled = models.settled(best().fit.ms, record.score, noise) &&
                  (best().effects.empty() || models.near_its_laws(best()));
        excused = settled && !(models.immaterial(path.front()) && models.structure(best(), noise) > 0);
        if (second) settled_on_second = second_log(best()).settled;
    }
    bool coarse() const { return axis.encoder.resolution_m > 0 && count > 1.5 * axis.encoder.resolution_m; }
    /// Nothing is left that would matter: noise, or far less than the owner's tolerances make. No other cause
    /// can hide behind the names.
    bool at_floor() const { return settled && settled_on_second; }
    /// Whether the machine as calibrated leaves no more, in any band of either log, than machines inside the
    /// owner's tolerances differ by from one another.
    bool calibrated_within_tolerances() const {
        const candidate& m = path.front();
        if (m.stops_at_a_tolerance()) return false; // it would have left them
        if (!models.within_tolerances(m.fit.ms, record.score, noise)) return false;
        if (!second) return true;
        fit_result there{.plant = restarted(m.fit.plant, *second), .x = Eigen::VectorXd(0)};
        fitter(second->observer, second->score).evaluate(there);
        return models.within_tolerances(there.ms, second->score, noise);
    }
    /// Nothing is left that would matter when the claims alone are added: the suspects are not needed.
    bool claims_suffice() const {
        const candidate& m = applied();
        return claims > 0 && models.settled(m) && models.near_its_laws(m);
    }
    /// What the best model's forces leave along the measured motion, over what those of the calibrated machine
    /// leave there. The same measure for a model that was fitted to the readings and for one that was led.
    double left_along_motion() const {
        const std::array plants{best().fit.plant, path.front().fit.plant};
        std::array<std::vector<double>, 2> left;
        const auto by = motion_to_lead(record, plant_model(axis, record.scale.give()));
        record.observer.forces_beside(*by, plants, record.command, left);
        return rms(left[0]) / rms(left[1]);
    }
    /// Share of what `from` leaves above the floor that `to` takes off, in energy on held-out motion.
    double takes_off(const candidate& to, const candidate& from) const {
        const auto energy = [&](const candidate& m) {
            const double force = models.held_out_force(m);
            return force * force;
        };
        const double left = energy(from), floor = floor_force() * floor_force();
        return left > floor ? (left - energy(to)) / (left - floor) : 0;
    }
    /// How a model predicts the hold-out log, which nothing was fitted to.
    struct on_second {
        double score = 0;     ///< log-score
        bool settled = false; ///< nothing is left that matters
        double force = 0;     ///< residual, rms [N]
    };
    on_second second_log(const candidate& m) const {
        fit_result there{.plant = restarted(m.fit.plant, *second), .x = Eigen::VectorXd(0)};
        std::vector<double> a;
        const double choices = second->observer.run(there.plant, there.innovation.rows, &a);
        fitter(second->observer, second->score).judge(there, choices);
        return {-there.objective, models.settled(there.ms, second->score, noise),
                rms(residual_of(*second, there.plant, a))};
    }
    /// The log-scores alone, of several models.
    std::vector<double> scores_on_second(const std::vector<const candidate*>& some) const {
        std::vector<plant_model> plants;
        for (const candidate* m : some) plants.push_back(restarted(m->fit.plant, *second));
        auto out = fitter(second->observer, second->score).objectives(plants);
        for (double& score : out) score = -score;
        return out;
    }
    /// What a model is worth on motion that it was not fitted to: of this log, and of the hold-out log.
    double worth(const candidate& m) const {
        return m.total + (second && record.replayed() ? second_log(m).score : 0);
    }
    /// Score on this log below which a model counts little beside the best, whatever the hold-out log says.
    double least_score() const {
        return record.replayed() ? best().total - 5 * score_temperature
                                 : -std::numeric_limits<double>::infinity();
    }
    bool controller_differs() const { return controller && controller->differs; }
    bool command_is_added() const { return controller_differs() && controller->is_added(); }
    bool controller_open() const { return controller_differs() && !controller->mended && !command_is_added(); }
    double floor_force() const { return models.floor_force(noise); }
    /// The described controller with the found key mended.
    controller_description mended() const {
        controller_description c = *axis.controller;
        if (controller->mended)
            for (const auto& key : detail::searched_keys(c))
                if (controller->key == key.key) key.of(c) = controller->value;
        return c;
    }
    /// What the corrected controller commands otherwise than this log, as a force on the axis [N]: with the
    /// signal that is added to the command taken off, or not. A constant of the unknown first integral is no
    /// part of it.
    std::vector<double> command_left(bool without_added = true) const {
        auto d = command_difference(log, mended());
        if (!command_is_added()) return d;
        std::vector<double> left = d;
        for (std::size_t k = 0; k < d.size(); ++k)
            left[k] += controller->added->waveform.values[k] * axis.plant.force_constant_N_per_V;
        const double constant = quantile(left, 0.5);
        if (without_added) d = std::move(left);
        for (double& x : d) x -= constant;
        return d;
    }
    /// What a controller commands otherwise than logged, as a force on the axis [N].
    std::vector<double> command_difference(const axis_log& l, const controller_description& c) const {
        auto d = replay_controller(c, axis.actuator, record.period, loop_columns::of(l));
        for (std::size_t k = 0; k < d.size(); ++k)
            d[k] = (d[k] - l.command[k]) * axis.plant.force_constant_N_per_V;
        return d;
    }
};

} // namespace quadrant::diagnosis
