// SPDX-License-Identifier: BSL-1.0
// Long: one class: begin_axis() and the other steps share the file that they write.
#pragma once
#include "fit/drive_estimate.hpp"
#include "fit/regression.hpp"
#include "fit/with_drives.hpp"
#include "import/units.hpp"
#include "log/sensor_box.hpp"
#include "machine_file/init_fields.hpp"
#include "match.hpp"
#include "read_machine.hpp"
#include "write_machine.hpp"

#include <map>

namespace quadrant::inline v0::diagnosis {

/// What a machine file is begun from: numbers by option (init_fields.hpp) and axis, in SI.
struct init_request {
    std::vector<std::string> axes; ///< empty: those of the log, else "x"
    double sample_period_s = 0;    ///< 0: the log's
    std::string command_unit;      ///< V, A or N (Nm); empty: the log's, else V or Nm
    /// Of every axis: a drive with loops of its own, whose numbers that nobody gives come from the log.
    /// Current: it has none.
    drive_kind drive = drive_kind::current;
    bool rotary = false;    ///< every axis; with a log each says so itself
    bool from_log = false;  ///< the log's own estimate of what is not given, where it is sure
    bool unchecked = false; ///< a mass that the log contradicts makes a note, not a refusal
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
        if (ask_.drive != drive_kind::current) return begin_driven(axis, log);
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
        const std::optional<double> constant = ask_.value("force-constant", axis);
        const axis_regression found =
            log && !log->still ? regress(*log, json_["sample_period_s"].get<double>()) : axis_regression{};
        const double per_unit = constant.value_or(1);
        std::optional<double> mass = ask_.value("mass", axis);
        const bool estimated = !mass && ask_.from_log && (constant || is_force(unit)) &&
                               found.acceleration.sure() && found.acceleration.value > 0;
        if (estimated) mass = found.acceleration.value * per_unit;
        if (!mass || (!constant && !is_force(unit)))
            throw bad_input("init", missing(axis, unit, mass, constant, found));
        for (const init_field& f : init_fields) {
            const auto given = ask_.value(f.option, axis);
            if (!given) continue;
            if (f.rotary_only && kind_ == axis_kind::linear)
                throw bad_input("init", fmt::format("--{}: axis {} is linear", f.option, axis));
            std::string key = f.key;
            if (key == "force_constant_N_per_V") {
                if (is_force(unit))
                    throw bad_input("init",
                                    text_of("--force-constant contradicts a command in newtons", kind_));
                key.back() = unit[0];
            }
            put(axis, f, key, *given, "given");
        }
        if (log && ask_.from_log) estimate(axis, found, per_unit);
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
        if (!log) return;
        if (!estimated) compare(axis, unit, *mass, per_unit, found);
        describe(axis, found, per_unit);
    }

    // ---- A drive with loops of its own.

    /// Refuses what an axis with this drive cannot have, and puts what is given into its boxes.
    void put_given(const std::string& axis) {
        for (const init_field& f : init_fields) {
            const auto given = ask_.value(f.option, axis);
            if (!given) continue;
            if (f.rotary_only && kind_ == axis_kind::linear)
                throw bad_input("init", fmt::format("--{}: axis {} is linear", f.option, axis));
            put(axis, f, f.key, *given, "given");
        }
        for (const init_field& f : drive_init_fields)
            if (const auto given = ask_.value(f.option, axis)) put(axis, f, f.key, *given, "given");
    }
    bool gives(std::string_view option, const std::string& axis) const {
        return ask_.value(std::string(option), axis).has_value();
    }
    void need(bool there, const std::string& axis, std::string_view what) const {
        if (!there) throw bad_input("init", fmt::format("axis {}: {}", axis, text_of(what, kind_)));
    }

    void begin_driven(const std::string& axis, const axis_log* log) {
        const bool servo = ask_.drive == drive_kind::position_servo;
        json_["axes"][axis]["plant"] = nlohmann::ordered_json::object();
        json_["axes"][axis]["drive"] = {{"kind", name_of(ask_.drive)}};
        put_given(axis);
        if (!servo)
            need(gives("mass", axis), axis,
                 "--mass is missing: the motion shows the gains of a drive beside the mass only");
        need(!servo || gives("supply", axis), axis, "--supply is missing (the volts of a duty of 1)");
        if (!log) return;
        read_count(axis, *log);
        if (log->still) throw bad_input(log_->file, fmt::format("axis {} never moves", axis));
        const bool duty = !log->duty.empty() || log->command_unit == "duty" || log->command_unit == "V";
        if (servo) {
            need(
                gives("mass", axis) || gives("force-constant", axis) || gives("gravity-torque", axis), axis,
                "--mass, --force-constant or --gravity-torque is missing: without one of them all forces times "
                "one factor move the axis alike");
            need(duty || gives("servo-gain", axis) || gives("force-constant", axis), axis,
                 "--servo-gain or --force-constant is missing: without a measured duty their product alone "
                 "moves "
                 "the axis");
        }
        estimate_drive_of(axis, *log);
    }

    /// The machine file so far, with numbers in the place of those that it needs and nobody knows.
    axis_description placeholders(const std::string& axis) const {
        nlohmann::ordered_json text = json_;
        nlohmann::ordered_json& here = text["axes"][axis];
        text["axes"] = {{axis, here}};
        nlohmann::ordered_json& one = text["axes"][axis];
        const auto hold = [&](const char* box, const std::string& key) {
            if (!one[box].contains(key_of(key, kind_))) one[box][key_of(key, kind_)] = 1;
        };
        hold("plant", "mass_kg");
        if (ask_.drive == drive_kind::position_servo) {
            hold("plant", "force_constant_N_per_V");
            hold("drive", "position_gain_per_m");
        } else {
            hold("drive", "velocity_gain_N_s_per_m");
        }
        if (ask_.drive == drive_kind::position) hold("drive", "position_gain_per_s");
        if (ask_.drive == drive_kind::velocity) hold("drive", "velocity_per_V");
        return read_machine(text.dump(), "init").axes.at(0);
    }

    void estimate_drive_of(const std::string& axis, const axis_log& log) {
        axis_description description = placeholders(axis);
        check_drive(description, log, "--drive", log_->file);
        std::set<std::string> known;
        for (const auto* fields : {init_fields.data(), drive_init_fields.data()})
            for (std::size_t i = 0;
                 i < (fields == init_fields.data() ? init_fields.size() : drive_init_fields.size()); ++i)
                if (gives(fields[i].option, axis))
                    known.insert(fmt::format("{}.{}", fields[i].box, fields[i].key));
        const double period = json_["sample_period_s"].get<double>();
        const drive_estimate found =
            estimate_drive(description, with_drive(description, log, period), period, known);
        if (description.drive.takes_position() && found.between != interpolation::hold)
            json_["axes"][axis]["drive"]["interpolation"] = name_of(found.between);
        std::string loose;
        for (const identified_number& n : found.numbers) {
            const init_field& f = field_of(n.key);
            const std::string unit = text_of(f.unit, kind_),
                              interval = fmt::format("{:.4g} to {:.4g}{}{}", n.low, n.high,
                                                     unit.empty() ? "" : " ", unit);
            const bool loop = std::string_view(f.box) == "drive";
            if (n.identified()) {
                put(axis, f, f.key, rounded(n.value),
                    fmt::format("identified from the log, 95 % interval {}", interval));
                put_tolerance(axis, n);
            } else if (is_needed(n.key)) {
                throw bad_input(log_->file, too_fast(axis, f, n, period));
            } else if (loop || n.present()) {
                loose +=
                    fmt::format("{}{} ({})", loose.empty() ? "" : ", ", text_of(f.meaning, kind_), interval);
            }
        }
        out_.notes.push_back(fmt::format("axis {}: the simulated path leaves {:.3g} {} rms of the log, whose "
                                         "reading has {:.2g} {} of noise{}",
                                         axis, found.path_rms, key_of("m", kind_), found.path_noise,
                                         key_of("m", kind_),
                                         loose.empty() ? "" : "; not identified from this log: " + loose));
    }
    static double rounded(double value) { // to five digits
        return value == 0 ? 0 : std::stod(fmt::format("{:.5g}", value));
    }
    bool is_needed(std::string_view key) const {
        const auto of_drive = [&](const key_of_drive& k) {
            return key == fmt::format("drive.{}", k.name) && k.needs[static_cast<std::size_t>(ask_.drive)];
        };
        return key == "plant.mass_kg" || key == "plant.force_constant_N_per_V" ||
               key == "drive.velocity_per_V" ||
               std::any_of(drive_key_table.begin(), drive_key_table.end(), of_drive);
    }
    std::string too_fast(const std::string& axis, const init_field& f, const identified_number& n,
                         double period) const {
        return fmt::format(
            "axis {}: {}", axis,
            text_of(fmt::format("the log does not show {} ({:.3g} to {:.3g} {} with 95 %): give --{}, "
                                "or record faster motion, or more often than every {:.3g} ms",
                                f.meaning, n.low, n.high, f.unit, f.option, 1e3 * period),
                    kind_));
    }
    static const init_field& field_of(std::string_view key) {
        const auto is = [&](const init_field& f) { return key == fmt::format("{}.{}", f.box, f.key); };
        const auto of_drive = std::find_if(drive_init_fields.begin(), drive_init_fields.end(), is);
        return of_drive != drive_init_fields.end() ? *of_drive
                                                   : *std::find_if(init_fields.begin(), init_fields.end(), is);
    }
    /// The half width of the interval, as the tolerance of the number, a thousandth at least.
    void put_tolerance(const std::string& axis, const identified_number& n) {
        for (const tolerance_name& t : tolerance_names(kind_))
            if (n.key == (t.key->name.find('.') == std::string_view::npos ? "plant." + std::string(t.key->name)
                                                                          : std::string(t.key->name)))
                json_["axes"][axis]["tolerance"][key_of(t.name, kind_)] =
                    rounded(std::clamp(n.half_width() / std::abs(n.value), 0.001, 0.99));
    }

    std::string missing(const std::string& axis, const std::string& unit, const std::optional<double>& mass,
                        const std::optional<double>& constant, const axis_regression& found) const {
        std::string text = mass ? "--force-constant is missing" : "--mass is missing";
        const double by_log = found.acceleration.value;
        const bool told = found.acceleration.sure() && by_log > 0;
        if (told && !mass && (constant || is_force(unit)))
            text += fmt::format("; the log speaks of about {:.4g} kg (--from-log takes it)",
                                by_log * constant.value_or(1));
        if (!told && by_log > 0 && std::isfinite(found.acceleration.spread) && !mass &&
            (constant || is_force(unit)))
            text +=
                fmt::format("; the log is not sure of it ({:.3g} kg with a standard deviation of {:.2g}): "
                            "record faster motion",
                            by_log * constant.value_or(1), found.acceleration.spread * constant.value_or(1));
        if (told && mass) text += fmt::format("; the log speaks of about {:.4g} N/{}", *mass / by_log, unit);
        if (found.acceleration.sure() && by_log < 0)
            text += "; in the log the axis accelerates against its command: check the sign of one of the two";
        return fmt::format("axis {}: {}", axis, text_of(text, kind_));
    }

    static const init_field& field(std::string_view option) {
        return *std::find_if(init_fields.begin(), init_fields.end(),
                             [&](const auto& f) { return f.option == option; });
    }

    /// What the log is sure of and nobody gave. A negative friction is no friction.
    void estimate(const std::string& axis, const axis_regression& found, double per_unit) {
        const auto take = [&](std::string_view option, const regressed& by_log, double value) {
            if (ask_.value(std::string(option), axis) || !by_log.sure() || !(by_log.value > 0)) return;
            const init_field& f = field(option);
            put(axis, f, f.key, value, fmt::format("regression of the log below {:.3g} Hz", found.band_Hz));
        };
        take("mass", found.acceleration, found.acceleration.value * per_unit);
        take("viscous", found.speed, found.speed.value * per_unit);
        take("coulomb", found.direction, found.direction.value * per_unit);
        if (ask_.value("gravity-phase", axis)) return;
        take("gravity-torque", found.weight, found.weight.value * per_unit);
        take("gravity-phase", found.weight, found.phase);
    }

    void read_count(const std::string& axis, const axis_log& log) {
        const double count = observed_count(log.position, log.position_step);
        if (!ask_.value("resolution", axis) && count > 0) {
            const init_field& f = field("resolution");
            put(axis, f, f.key, std::round(count * 1e12) / 1e12, "smallest step of the position in the log");
        }
    }
    void read_from_log(const std::string& axis, const axis_log& log) {
        read_count(axis, log);
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
        if (!ask_.value("limit", axis) && at_limit >= often && at_limit > below) {
            const init_field& f = field("limit");
            put(axis, f, f.key, most, fmt::format("{} rows of the log stop there", at_limit));
        }
    }

    /// The mass given beside the log's own, within four standard deviations of that.
    void compare(const std::string& axis, const std::string& unit, double mass, double constant,
                 const axis_regression& found) {
        const regressed& a = found.acceleration;
        if (!a.sure()) return;
        const double least = (a.value - 4 * a.spread) * constant, most = (a.value + 4 * a.spread) * constant;
        if (mass <= 3 * most && mass >= least / 3) return;
        const std::string text = fmt::format(
            "axis {}: {}", axis,
            text_of(fmt::format(
                        "{:g} kg and {:g} N/{} cannot be of this log, where the command moves {:.3g} kg: check "
                        "the units",
                        mass, constant, unit, a.value * constant),
                    kind_));
        if (!ask_.unchecked) throw bad_input(log_->file, text + " (--unchecked writes the file all the same)");
        out_.notes.push_back(text);
    }

    /// What the regression found and how the signals were treated, in a note.
    void describe(const std::string& axis, const axis_regression& found, double constant) {
        if (!(found.band_Hz > 0)) {
            out_.notes.push_back(
                fmt::format("axis {}: the log is too short, or its position too noisy, to compare the "
                            "numbers with it",
                            axis));
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
        add("gravity", found.weight, "N");
        if (found.weight.sure()) sure += fmt::format(" with the weight down at {:.3g} m", found.phase);
        out_.notes.push_back(fmt::format(
            "axis {}: {}", axis,
            text_of(fmt::format("by the log {}; all signals behind the same zero-phase low-pass of {:.3g} Hz",
                                sure.empty() ? "no number is sure" : sure, found.band_Hz),
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

/// Begins a machine file. Sample period, axes, unit of the command, resolution and, where the command stops
/// there, its limit come from the log when there is one; mass and force constant must fit its motion within a
/// factor of three (or a note says that they do not, `unchecked`). With `from_log` the log's regression gives
/// mass, friction and gravity where nobody does. What it returns passes read_machine. Throws bad_input.
inline initialised_machine init_machine(const init_request& request, const machine_log* log = nullptr) {
    return detail::machine_starter(request, log).take();
}

/// The description that a log gives of its own machine, where there is no machine file: mass, friction and
/// gravity by regression. Where the command is no force, one newton a unit of it is taken: masses and forces
/// are then in units of the command. Throws bad_input where the log is not sure of the mass.
inline initialised_machine machine_from_log(const machine_log& log) {
    init_request ask;
    ask.from_log = ask.unchecked = true;
    for (const axis_log& a : log.axes)
        if (!is_force(a.command_unit)) ask.values["force-constant"][a.name] = 1;
    return init_machine(ask, &log);
}

} // namespace quadrant::inline v0::diagnosis
