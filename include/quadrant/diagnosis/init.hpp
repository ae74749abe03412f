// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "import/check_physics.hpp"
#include "init_fields.hpp"
#include "read_machine.hpp"
#include "sensor_box.hpp"
#include "write_machine.hpp"

#include <map>

namespace quadrant::diagnosis {

/// What a machine file is begun from: numbers by option (init_fields.hpp) and axis, in SI.
struct init_request {
    std::vector<std::string> axes;                     ///< empty: those of the log, else "x"
    double sample_period_s = 0;                        ///< 0: the log's
    std::string command_unit;                          ///< V, A or N (Nm); empty: the log's, else V or Nm
    bool rotary = false;                               ///< every axis; with a log each says so itself
    command_origin command_is = command_origin::asked; ///< of every axis: where the log's command was taken
    std::map<std::string, std::map<std::string, double>> values; ///< option, then axis ("" is every axis)

    std::optional<double> value(const std::string& option, const std::string& axis) const {
        const auto of = values.find(option);
        if (of == values.end()) return {};
        for (const std::string& name : {axis, std::string()})
            if (const auto found = of->second.find(name); found != of->second.end()) return found->second;
        return {};
    }
};

/// A machine file to begin with, and where each of its numbers is from.
struct initialised_machine {
    nlohmann::ordered_json machine;
    std::string comments; ///< Markdown: every key, its value, what it means and where it is from
    std::vector<std::string> notes;
};

namespace detail {

class machine_starter {
public:
    machine_starter(const init_request& request, const machine_log* log) : ask_(request), log_(log) {}

    initialised_machine take() {
        double period = ask_.sample_period_s;
        if (period == 0 && log_) period = std::round(log_->sample_period_s * 1e9) / 1e9;
        if (period == 0)
            throw bad_input("init", "--sample-period is missing, and there is no --log to tell it");
        json_["schema"] = "quadrant.machine/1";
        json_["sample_period_s"] = period;
        row("sample_period_s", period, "period of the servo loop",
            ask_.sample_period_s > 0 ? "given" : "from the log");
        auto axes = ask_.axes;
        if (axes.empty() && log_)
            for (const auto& a : log_->axes) axes.push_back(a.name);
        if (axes.empty()) axes = {"x"};
        for (const auto& name : axes) begin_axis(name);
        const auto machine = read_machine(json_.dump(), "init");
        out_.notes.insert(out_.notes.end(), machine.notes.begin(), machine.notes.end());
        out_.machine = std::move(json_);
        out_.comments =
            "# Machine file, value by value\n\nSI units. What is not described is an effect that the "
            "simulation "
            "does not have; `docs/formats.md` lists every key.\n\n| key | value | meaning | from |\n"
            "|---|---|---|---|\n" +
            rows_;
        return std::move(out_);
    }

private:
    void row(const std::string& key, double value, std::string_view meaning, std::string_view from) {
        rows_ += fmt::format("| `{}` | {:.6g} | {} | {} |\n", key, value, meaning, from);
    }
    void put(const std::string& axis, const init_field& f, const std::string& linear, double value,
             std::string_view from) {
        const std::string key = key_of(linear, kind_), unit = text_of(f.unit, kind_);
        nlohmann::ordered_json& place = place_in(json_["axes"][axis][f.box], key);
        if (f.whole && value == std::floor(value))
            place = static_cast<std::int64_t>(value);
        else
            place = value;
        row(fmt::format("axes.{}.{}.{}", axis, f.box, key), value, text_of(f.meaning, kind_), from);
        if (unit == f.unit && value != 0 && (std::abs(value) < f.low || std::abs(value) > f.high))
            out_.notes.push_back(
                fmt::format("axes.{}.{}.{} = {:g} is unusual (most lie between {:g} and {:g}): is it in {}?",
                            axis, f.box, key, value, f.low, f.high, unit));
    }

    void begin_axis(const std::string& axis) {
        if (!is_axis_name(axis))
            throw bad_input("init",
                            fmt::format("{}: an axis is named by letters, digits, _ and -", in_quotes(axis)));
        const axis_log* log = nullptr;
        for (std::size_t i = 0; log_ && i < log_->axes.size(); ++i)
            if (log_->axes[i].name == axis) log = &log_->axes[i];
        if (log_ && !log) throw bad_input(log_->file, fmt::format("axis {} is not in the log", axis));
        kind_ = log ? log->kind : ask_.rotary ? axis_kind::rotary : axis_kind::linear;
        if (log && ask_.rotary && kind_ == axis_kind::linear)
            throw bad_input(log_->file, fmt::format("axis {} is linear, not rotary", axis));
        const std::string unit = !ask_.command_unit.empty() ? ask_.command_unit
                                 : log                      ? log->command_unit
                                 : ask_.rotary              ? "Nm"
                                                            : "V";
        if (log && log->command_unit != unit)
            throw bad_input(log_->file, fmt::format("the command of axis {} is in {}, not in {}", axis,
                                                    log->command_unit, unit));
        if (is_force(unit) && unit != key_of("N", kind_))
            throw bad_input("init", fmt::format("axis {} is {}: its command is in V, A or {}", axis,
                                                name_of(kind_), key_of("N", kind_)));
        const std::optional<double> mass = ask_.value("mass", axis),
                                    constant = ask_.value("force-constant", axis);
        const unit_check found =
            log && !log->still ? check_units(*log, json_["sample_period_s"].get<double>()) : unit_check{};
        if (!mass || (!constant && !is_force(unit)))
            throw bad_input("init", missing(axis, unit, mass, constant, found));
        for (const init_field& f : init_fields) {
            const auto given = ask_.value(f.option, axis);
            if (!given) continue;
            std::string key = f.key;
            if (key == "force_constant_N_per_V") {
                if (is_force(unit))
                    throw bad_input("init",
                                    text_of("--force-constant contradicts a command in newtons", kind_));
                key.back() = unit[0];
            }
            put(axis, f, key, *given, "given");
        }
        if (log) read_from_log(axis, *log);
        const bool by_name = log && log->command_is != command_origin::asked;
        if (by_name || ask_.command_is != command_origin::asked) {
            json_["axes"][axis]["actuator"]["command_is"] = name_of(command_origin::measured);
            rows_ +=
                fmt::format("| `axes.{}.actuator.command_is` | measured | the log's command column was taken "
                            "behind the amplifier | {} |\n",
                            axis, by_name ? "the column's name" : "given");
        }
        if (json_["axes"][axis].contains("controller")) {
            nlohmann::ordered_json with_kind = {{"kind", "cascade_p_pi"}};
            with_kind.update(json_["axes"][axis]["controller"]);
            json_["axes"][axis]["controller"] = std::move(with_kind);
        }
        if (log) compare(axis, unit, *mass, constant.value_or(1), found);
    }

    std::string missing(const std::string& axis, const std::string& unit, const std::optional<double>& mass,
                        const std::optional<double>& constant, const unit_check& found) const {
        std::string text = mass ? "--force-constant is missing" : "--mass is missing";
        const bool told = found.sign_is_known() && found.command_per_acceleration > 0;
        if (told && !mass && (constant || is_force(unit)))
            text += fmt::format("; the log speaks of about {:.4g} kg",
                                found.command_per_acceleration * constant.value_or(1));
        if (told && mass)
            text += fmt::format("; the log speaks of about {:.4g} N/{}", *mass / found.command_per_acceleration,
                                unit);
        return fmt::format("axis {}: {}", axis, text_of(text, kind_));
    }

    void read_from_log(const std::string& axis, const axis_log& log) {
        const auto field = [](std::string_view option) -> const init_field& {
            return *std::find_if(init_fields.begin(), init_fields.end(),
                                 [&](const auto& f) { return f.option == option; });
        };
        const double count = observed_count(log.position, log.position_step);
        if (!ask_.value("resolution", axis) && count > 0) {
            const init_field& f = field("resolution");
            put(axis, f, f.key, std::round(count * 1e12) / 1e12, "smallest step of the position in the log");
        }
        const double most = std::max(std::abs(*std::max_element(log.command.begin(), log.command.end())),
                                     std::abs(*std::min_element(log.command.begin(), log.command.end())));
        const auto at_limit = std::count_if(log.command.begin(), log.command.end(),
                                            [&](double u) { return std::abs(u) >= most * (1 - 1e-6); });
        constexpr long often = 5;
        if (!ask_.value("limit", axis) && at_limit >= often) {
            const init_field& f = field("limit");
            put(axis, f, f.key, most, fmt::format("{} rows of the log stop there", at_limit));
        }
    }

    void compare(const std::string& axis, const std::string& unit, double mass, double constant,
                 const unit_check& found) {
        if (!found.sign_is_known()) return;
        const double by_log = found.command_per_acceleration * constant, times = by_log / mass;
        if (times > 3 || times < 1.0 / 3)
            throw bad_input(
                log_->file,
                fmt::format("axis {}: {}", axis,
                            text_of(fmt::format("{:g} kg and {:g} N/{} cannot be of this log, where the "
                                                "command moves {:.3g} kg: check the units",
                                                mass, constant, unit, by_log),
                                    kind_)));
        out_.notes.push_back(fmt::format(
            "axis {}: {}", axis,
            text_of(fmt::format("by the log the command moves about {:.3g} kg ({:.0f} % of the mass given)",
                                by_log, 100 * times),
                    kind_)));
    }

    const init_request& ask_;
    const machine_log* log_;
    axis_kind kind_ = axis_kind::linear; ///< of the axis being begun
    nlohmann::ordered_json json_;
    std::string rows_;
    initialised_machine out_{};
};

} // namespace detail

/// Begins a machine file. Sample period, axes, unit of the command, resolution and, where the command stops there, its limit
/// come from the log when there is one; mass and force constant must fit its motion within a factor of three. What it
/// returns passes read_machine. Throws bad_input.
inline initialised_machine init_machine(const init_request& request, const machine_log* log = nullptr) {
    return detail::machine_starter(request, log).take();
}

} // namespace quadrant::diagnosis
