// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/late_command.hpp"
#include "../fit/regression.hpp"
#include "axis_start.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

/// An axis whose command is a voltage, a current or a force: its numbers are given, or come from a regression
/// of the log; those that are given have to agree with it.
class commanded_axis : axis_start {
public:
    using axis_start::axis_start;

    void begin() {
        const axis_log* log = record_;
        const std::string unit = !ask_.command_unit.empty() ? ask_.command_unit
                                 : log                      ? log->command_unit
                                 : ask_.rotary              ? "Nm"
                                                            : "V";
        if (log && log->command_unit != unit)
            throw bad_input(file_, fmt::format("the command of axis {} is in {}, not in {}", axis_,
                                               log->command_unit, unit));
        if (is_force(unit) && unit != key_of("N", kind_))
            throw bad_input("init", fmt::format("axis {} is {}: its command is in V, A or {}", axis_,
                                                name_of(kind_), key_of("N", kind_)));
        const std::optional<double> constant = asked("force-constant");
        const axis_regression found = log && !log->still ? regressed_from(*log) : axis_regression{};
        const double per_unit = constant.value_or(1);
        std::optional<double> mass = asked("mass");
        const bool estimated = !mass && ask_.from_log && (constant || is_force(unit)) &&
                               found.acceleration.sure() && found.acceleration.value > 0;
        if (estimated) mass = found.acceleration.value * per_unit;
        if (!mass || (!constant && !is_force(unit)))
            throw bad_input("init", missing(unit, mass, constant, found));
        for (const init_field& f : init_fields) {
            const auto given = asked(f.option);
            if (!given) continue;
            if (f.rotary_only && kind_ == axis_kind::linear)
                throw bad_input("init", fmt::format("--{}: axis {} is linear", f.option, axis_));
            std::string key = f.key;
            if (key == "force_constant_N_per_V") {
                if (is_force(unit))
                    throw bad_input("init",
                                    text_of("--force-constant contradicts a command in newtons", kind_));
                key.back() = unit[0];
            }
            put(f, key, *given, "given");
        }
        if (log && ask_.from_log) estimate(found, per_unit);
        if (log) read_from_log(*log);
        const bool by_name = log && log->command_is != command_origin::asked;
        if (by_name || ask_.command_is != command_origin::asked) {
            here()["actuator"]["command_is"] = name_of(command_origin::measured);
            text_.line(
                fmt::format("| `axes.{}.actuator.command_is` | measured | the log's command column was taken "
                            "behind the amplifier | {} |\n",
                            axis_, by_name ? "the column's name" : "given"));
        }
        if (here().contains("controller")) {
            nlohmann::ordered_json with_kind = {{"kind", "cascade_p_pi"}};
            with_kind.update(here()["controller"]);
            here()["controller"] = std::move(with_kind);
        }
        if (!log) return;
        if (!estimated) compare(unit, *mass, per_unit, found);
        describe(found, per_unit);
    }

private:
    /// A row's command acts after its delay, and is then its mean until the next row. What was measured acts.
    axis_regression regressed_from(const axis_log& log) const {
        const double period = text_.period();
        if (log.command_is != command_origin::asked || ask_.command_is != command_origin::asked)
            return regress(log, period);
        return regress(read_earlier(log, -0.5 * period - asked("delay").value_or(0), period), period);
    }
    std::string missing(const std::string& unit, const std::optional<double>& mass,
                        const std::optional<double>& constant, const axis_regression& found) const {
        std::string text = mass ? "--force-constant is missing" : "--mass is missing";
        const double by_log = found.acceleration.value;
        const bool told = found.acceleration.sure() && by_log > 0;
        if (told && !mass && (constant || is_force(unit)))
            text += fmt::format("; the log indicates about {:.4g} kg (--from-log uses it)",
                                by_log * constant.value_or(1));
        if (!told && by_log > 0 && std::isfinite(found.acceleration.spread) && !mass &&
            (constant || is_force(unit)))
            text += fmt::format(
                "; the log does not determine it well enough ({:.3g} kg with a standard deviation of {:.2g}): "
                "record faster motion",
                by_log * constant.value_or(1), found.acceleration.spread * constant.value_or(1));
        if (told && mass) text += fmt::format("; the log indicates about {:.4g} N/{}", *mass / by_log, unit);
        if (found.acceleration.sure() && by_log < 0)
            text += "; in the log the axis accelerates against its command: check the sign of one of the two";
        return fmt::format("axis {}: {}", axis_, text_of(text, kind_));
    }

    /// What the log is sure of and nobody gave. A negative friction is no friction.
    void estimate(const axis_regression& found, double per_unit) {
        const auto take = [&](std::string_view option, const regressed& by_log, double value) {
            if (asked(std::string(option)) || !by_log.sure() || !(by_log.value > 0)) return;
            const init_field& f = field(option);
            put(f, f.key, value, fmt::format("regression of the log below {:.3g} Hz", found.band_Hz));
        };
        take("mass", found.acceleration, found.acceleration.value * per_unit);
        take("viscous", found.speed, found.speed.value * per_unit);
        take("coulomb", found.direction, found.direction.value * per_unit);
        if (asked("gravity-phase")) return;
        take("gravity-torque", found.weight, found.weight.value * per_unit);
        take("gravity-phase", found.weight, found.phase);
    }

    void read_from_log(const axis_log& log) {
        read_count(log);
        const double most = std::max(std::abs(*std::max_element(log.command.begin(), log.command.end())),
                                     std::abs(*std::min_element(log.command.begin(), log.command.end())));
        const auto at_limit = std::count_if(log.command.begin(), log.command.end(),
                                            [&](double u) { return std::abs(u) >= most * (1 - 1e-6); });
        // A command that only passes its largest value has as many rows close below it.
        constexpr double close = 0.95;
        const auto below = std::count_if(log.command.begin(), log.command.end(), [&](double u) {
            return std::abs(u) > close * most && std::abs(u) < most * (1 - 1e-6);
        });
        constexpr long often = 5;
        if (!asked("limit") && at_limit >= often && at_limit > below && !goes_in_levels(log.command)) {
            const init_field& f = field("limit");
            put(f, f.key, most, fmt::format("{} rows of the log stop there", at_limit));
        }
    }

    /// Whether a command has a few values only, as a series of steps has: its largest is a level, no limit.
    static bool goes_in_levels(const std::vector<double>& command) {
        constexpr std::size_t few = 8;
        std::set<double> levels;
        for (std::size_t k = 0; k < command.size() && levels.size() <= few; ++k) levels.insert(command[k]);
        return levels.size() <= few;
    }

    /// The mass given beside the log's own, within four standard deviations of that.
    void compare(const std::string& unit, double mass, double constant, const axis_regression& found) {
        const regressed& a = found.acceleration;
        if (!a.sure()) return;
        const double least = (a.value - 4 * a.spread) * constant, most = (a.value + 4 * a.spread) * constant;
        if (mass <= 3 * most && mass >= least / 3) return;
        const std::string text = fmt::format(
            "axis {}: {}", axis_,
            text_of(
                fmt::format(
                    "{:g} kg and {:g} N/{} contradict this log, in which the command moves {:.3g} kg: check "
                    "the units",
                    mass, constant, unit, a.value * constant),
                kind_));
        if (!ask_.unchecked) throw bad_input(file_, text + " (--unchecked writes the file all the same)");
        text_.note(text);
    }

    /// What the regression found and how the signals were treated, in a note.
    void describe(const axis_regression& found, double constant) {
        if (!(found.band_Hz > 0)) {
            text_.note(fmt::format("axis {}: the log is too short, or its position too noisy, to compare the "
                                   "numbers with it",
                                   axis_));
            return;
        }
        std::string sure;
        const auto add = [&](std::string_view name, const regressed& r, std::string_view unit) {
            if (r.sure())
                sure += fmt::format("{}{} {:.3g} {}", sure.empty() ? "" : ", ", name, r.value * constant, unit);
        };
        add("mass", found.acceleration, "kg");
        add("viscous friction", found.speed, "N s/m");
        add("Coulomb friction", found.direction, "N");
        add("a constant force of", {-found.mean.value, found.mean.spread}, "N");
        add("Coulomb friction and a constant force together (the axis goes one way)", found.resists, "N");
        add("gravity", found.weight, "N");
        if (found.weight.sure()) sure += fmt::format(" with the weight down at {:.3g} m", found.phase);
        text_.note(fmt::format(
            "axis {}: {}", axis_,
            text_of(fmt::format("by the log {}; all signals behind the same zero-phase low-pass of {:.3g} Hz",
                                sure.empty() ? "no number is sure" : sure, found.band_Hz),
                    kind_)));
        constexpr double much = 0.1;
        if (!sure.empty() && found.left > much)
            text_.note(
                fmt::format("axis {}: that leaves {:.2g} % of the command's variance there: something else "
                            "acts, such as a load that swings, and the numbers hold a part of it",
                            axis_, 100 * found.left));
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
