// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../chain/fit.hpp"
#include "../fit/with_drives.hpp"
#include "../machine_file/drive_keys.hpp"
#include "../machine_file/machine_keys.hpp"
#include "../match.hpp"
#include "../read_machine.hpp"
#include "axis_start.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// An axis behind a drive with loops of its own: what nobody gives of plant and drive is identified from the
/// log.
class driven_axis : axis_start {
public:
    using axis_start::axis_start;

    void begin() {
        const axis_log* log = record_;
        const bool servo = ask_.drive == drive_kind::position_servo;
        here()["plant"] = nlohmann::ordered_json::object();
        here()["drive"] = {{"kind", name_of(ask_.drive)}};
        put_given();
        need(!servo || gives("supply"), "--supply is missing (the volts of a duty of 1)");
        if (log && log->still) throw bad_input(file_, fmt::format("axis {} never moves", axis_));
        if (!servo)
            need(gives("mass"),
                 "--mass is missing: the motion shows the gains of a drive only relative to the mass");
        if (!log) return;
        read_count(*log);
        const bool duty = !log->duty.empty() || log->command_unit == "duty" || log->command_unit == "V";
        if (servo) {
            need(gives("mass") || gives("force-constant") || gives("gravity-torque"),
                 "--mass, --force-constant or --gravity-torque is missing: without one of them, all forces "
                 "scaled by one factor give the same motion");
            need(duty || gives("servo-gain") || gives("force-constant"),
                 "--servo-gain or --force-constant is missing: without a measured duty their product alone "
                 "moves the axis");
        }
        estimate_drive_of(*log);
    }

private:
    /// Refuses what an axis with this drive cannot have, and puts what is given into its boxes.
    void put_given() {
        for (const init_field& f : init_fields) {
            const auto given = asked(f.option);
            if (!given) continue;
            if (f.rotary_only && kind_ == axis_kind::linear)
                throw bad_input("init", fmt::format("--{}: axis {} is linear", f.option, axis_));
            std::string key = f.key;
            if (key == "force_constant_N_per_V" && ask_.drive != drive_kind::position_servo) {
                need(!record_ || measured_unit() == "A",
                     "--force-constant is newtons per ampere of a measured current, and the log has none: "
                     "leave it out");
                key.back() = 'A';
            }
            put(f, key, *given, "given");
        }
        for (const init_field& f : drive_init_fields)
            if (const auto given = asked(f.option)) put(f, f.key, *given, "given");
    }

    /// Unit of what the log measured behind the drive; empty: nothing.
    std::string measured_unit() const {
        if (record_->command_is == command_origin::measured) return record_->command_unit;
        return record_->effort.empty() ? "" : record_->effort_unit;
    }

    bool gives(std::string_view option) const { return asked(std::string(option)).has_value(); }
    void need(bool there, std::string_view what) const {
        if (!there) throw bad_input("init", fmt::format("axis {}: {}", axis_, text_of(what, kind_)));
    }

    /// The machine file so far, with numbers in the place of those that it needs and nobody knows.
    axis_description placeholders() const {
        nlohmann::ordered_json text = text_.json();
        const nlohmann::ordered_json own = text["axes"][axis_];
        text["axes"] = {{axis_, own}};
        nlohmann::ordered_json& one = text["axes"][axis_];
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

    void estimate_drive_of(const axis_log& log) {
        axis_description description = placeholders();
        check_drive(description, log, "--drive", file_);
        std::set<std::string> known;
        for (const auto* fields : {init_fields.data(), drive_init_fields.data()})
            for (std::size_t i = 0;
                 i < (fields == init_fields.data() ? init_fields.size() : drive_init_fields.size()); ++i)
                if (gives(fields[i].option)) known.insert(fmt::format("{}.{}", fields[i].box, fields[i].key));
        const double period = text_.period();
        const drive_estimate found =
            estimate_drive(description, with_drive(description, log, period), period, known);
        if (ask_.drive == drive_kind::position) check_beside_follower(log, found);
        if (description.drive.takes_position() && found.between != interpolation::hold)
            here()["drive"]["interpolation"] = name_of(found.between);
        if (found.set_point_period_s) {
            here()["drive"]["set_point_period_s"] = rounded(*found.set_point_period_s);
            text_.note(
                fmt::format("axis {}: with set-points between the rows the drive fits the log better than "
                            "with one a row: the controller is faster than the log. Of its period, "
                            "set_point_period_s, the log says no more: {:.4g} s is {} to a row.",
                            axis_, *found.set_point_period_s, set_points_in_a_row));
        }
        std::string loose;
        for (const identified_number& n : found.numbers) {
            const init_field& f = field_of(n.key);
            const std::string unit = text_of(f.unit, kind_),
                              interval = fmt::format("{:.4g} to {:.4g}{}{}", n.low, n.high,
                                                     unit.empty() ? "" : " ", unit);
            const bool loop = std::string_view(f.box) == "drive";
            if (n.identified()) {
                put(f, f.key, rounded(n.value),
                    fmt::format("identified from the log, 95 % interval {}", interval));
                put_tolerance(n);
            } else if (is_needed(n.key)) {
                throw bad_input(file_, too_fast(f, n, period));
            } else if (loop || n.present()) {
                loose +=
                    fmt::format("{}{} ({})", loose.empty() ? "" : ", ", text_of(f.meaning, kind_), interval);
            }
        }
        text_.note(fmt::format("axis {}: the simulated path leaves {:.3g} {} rms of the log, whose "
                               "reading has {:.2g} {} of noise{}",
                               axis_, found.path_rms, key_of("m", kind_), found.path_noise, key_of("m", kind_),
                               loose.empty() ? "" : "; not identified from this log: " + loose));
    }
    /// Refuses loops that leave much more of the path than a position gain alone does: their velocity loop is
    /// faster than the rows show, and a search for it ended somewhere.
    void check_beside_follower(const axis_log& log, const drive_estimate& found) const {
        const std::vector<double>& asked = log.has_reference ? log.reference : log.command;
        const double period = text_.period();
        const auto left_by = [&](double lag) {
            const auto follows = chain::lagged(asked, period, lag);
            double sum = 0, square = 0;
            for (std::size_t k = 0; k < follows.size(); ++k) {
                const double e = log.position[k] - follows[k];
                sum += e, square += e * e;
            }
            const auto n = static_cast<double>(follows.size());
            return std::sqrt(std::max(0.0, square / n - sum * sum / (n * n)));
        };
        const double longest = period * static_cast<double>(asked.size()) / 20;
        const double lag = chain::least(left_by, 0.01 * period, longest, 24, 12), left = left_by(lag);
        if (left > 0.5 * found.path_rms) return;
        const std::string m = key_of("m", kind_);
        throw bad_input(file_,
                        fmt::format("axis {}: the loops that fit best leave {:.3g} {} rms of the path, and a "
                                    "position gain of {:.4g} 1/s alone leaves {:.3g} {}: the velocity loop "
                                    "is faster than rows of {:.3g} ms show; record more often, or give "
                                    "--drive-velocity-gain, or describe that gain alone and no plant",
                                    axis_, found.path_rms, m, 1 / lag, left, m, 1e3 * period));
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
    std::string too_fast(const init_field& f, const identified_number& n, double period) const {
        return fmt::format(
            "axis {}: {}", axis_,
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
    void put_tolerance(const identified_number& n) {
        for (const tolerance_name& t : tolerance_names(kind_))
            if (n.key == (t.key->name.find('.') == std::string_view::npos ? "plant." + std::string(t.key->name)
                                                                          : std::string(t.key->name)))
                here()["tolerance"][key_of(t.name, kind_)] =
                    rounded(std::clamp(n.half_width() / std::abs(n.value), 0.001, 0.99));
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
