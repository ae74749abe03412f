// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_keys.hpp"
#include "law_of_drive.hpp"

#include <quadrant/diagnosis/controller/json.hpp>
#include <quadrant/diagnosis/text/text.hpp>

#include <algorithm>
#include <initializer_list>

namespace quadrant_cnc {

/// One reading of a machine's file, box by box. Nothing in it is ignored; messages name the file and the path
/// of the key.
class cnc_reader {
public:
    cnc_reader(std::string_view text, std::string_view file)
        : root_(qd::parse_json(text, file)), top_{&root_, "", file} {}

    cnc_description read() {
        qd::need_schema(top_, "quadrant.cnc/1");
        qd::refuse_unknown_keys(top_, cnc_file_keys);
        out_.file = qd::one_line(top_.file);
        out_.servo_period_s = top_.need("servo_period_s").number(qd::rule::positive);
        if (const auto seed = top_.find("seed")) out_.seed = unsigned(seed->number(whole_number));
        read_trajectory(top_.need("trajectory").object());
        const qd::json_node axes = top_.need("axes").object();
        if (axes.value->empty()) axes.refuse("must name at least one axis");
        for (const auto& [name, value] : axes.value->items()) {
            const qd::json_node one = axes.at(name, value);
            if (name != "x" && name != "y" && name != "z") one.refuse("an axis is called x, y or z");
            read_axis(std::size_t(name[0] - 'x'), one.object());
        }
        return std::move(out_);
    }

private:
    void read_trajectory(const qd::json_node& node) {
        trajectory_description& t = out_.trajectory;
        qd::read_numbers(node, trajectory_keys, trajectory_other_keys, t);
        read_limits(node, t.limits);
        if (const auto kind = node.find("profile"))
            t.profile = profile(choice(*kind, {"constant_velocity", "constant_acceleration",
                                               "trapezoidal_acceleration", "cubic_acceleration"}));
        if (const auto start = node.find("start_m")) {
            const auto at = start->numbers(qd::rule::any_number);
            if (at.size() != 3) start->refuse("must be three numbers: x, y, z");
            std::copy(at.begin(), at.end(), t.start_m.begin());
        }
        if (const auto strict = node.find("reach_the_feed")) t.reach_the_feed = yes(*strict);
        refuse_what_the_profile_cannot_keep(node, t.limits);
    }

    static void read_limits(const qd::json_node& node, limits_description& limits) {
        for (const auto& key : limit_keys)
            if (const auto given = node.find(key.name)) key.set(limits, given->number(key.rule));
    }
    void refuse_what_the_profile_cannot_keep(const qd::json_node& node, const limits_description& l) const {
        const profile kind = out_.trajectory.profile;
        if (kind == profile::constant_velocity && l.acceleration_m_per_s2 < unlimited)
            node.find("acceleration_m_per_s2")->refuse("a profile of constant velocity keeps no such limit");
        if (kind < profile::trapezoidal_acceleration && l.jerk_m_per_s3 < unlimited)
            node.find("jerk_m_per_s3")->refuse("only trapezoidal and cubic acceleration keep such a limit");
    }

    void read_axis(std::size_t axis, const qd::json_node& node) {
        qd::refuse_unknown_keys(node, axis_keys);
        axis_description a;
        a.axis = axis;
        a.path = node.path;
        if (const auto travel = node.find("travel_m")) {
            const auto ends = travel->numbers(qd::rule::any_number);
            if (ends.size() != 2 || !(ends[0] < ends[1]))
                travel->refuse("must be two numbers, the lower first");
            a.from_m = ends[0], a.to_m = ends[1];
        }
        if (const auto limits = node.find("limits")) {
            qd::read_numbers(*limits, limit_keys, {}, a.limits);
            refuse_what_the_profile_cannot_keep(*limits, a.limits);
        }
        read_drive(node.need("drive").object(), a);
        if (const auto encoder = node.find("encoder")) {
            qd::read_numbers(*encoder, encoder_keys, encoder_other_keys, a.sensor);
            if (const auto on = encoder->find("on")) a.sensor.on_motor = choice(*on, {"table", "motor"}) == 1;
        }
        if (const auto tachometer = node.find("tachometer"))
            qd::read_numbers(*tachometer, tachometer_keys, {}, a.sensor);
        if (const auto accelerometer = node.find("accelerometer"))
            qd::read_numbers(*accelerometer, accelerometer_keys, {}, a.sensor);
        read_command(node.need("command"), a.command);
        read_law(node.need("control").object(), a);
        if (const auto friction = node.find("friction_feedforward")) read_friction_feedforward(*friction, a);
        if (const auto feedback = node.find("acceleration_feedback")) {
            acceleration_feedback_description f;
            qd::read_numbers(*feedback, acceleration_feedback_keys, {}, f);
            a.acceleration = f;
        }
        if (const auto load = node.find("cutting_load")) read_cutting_load(*load, a);
        out_.axes.push_back(std::move(a));
    }

    static void read_drive(const qd::json_node& node, axis_description& a) {
        if (choice(node.need("kind"), {"ball_screw", "linear_motor"}) == 0) {
            ball_screw_description d;
            qd::read_numbers(node, ball_screw_keys, ball_screw_other_keys, d);
            if (const auto friction = node.find("friction")) {
                qd::refuse_unknown_keys(friction->object(), directions);
                qd::read_numbers(friction->need("forward"), friction_keys, {}, d.forward);
                qd::read_numbers(friction->need("backward"), friction_keys, {}, d.backward);
            }
            a.drive = d;
            return;
        }
        linear_motor_description d;
        qd::read_numbers(node, linear_motor_keys, kind_key, d);
        if (d.static_N.has_value() != d.stribeck_velocity_m_per_s.has_value())
            node.refuse("static_N and stribeck_velocity_m_per_s need each other");
        if (d.static_N && *d.static_N < d.coulomb_N)
            node.find("static_N")->refuse("must not lie below coulomb_N");
        a.drive = d;
    }

    static void read_command(const qd::json_node& node, command_description& c) {
        qd::read_numbers(node, command_keys, command_other_keys, c);
        if (const auto bits = node.find("dac_bits")) c.dac_bits = int(bits->number(qd::rule::bits));
        if (c.dac_bits.has_value() != c.dac_range_V.has_value())
            node.refuse("dac_bits and dac_range_V need each other");
    }

    /// The law by its kind's record. What it believes of the plant is the drive where the file does not say it.
    void read_law(const qd::json_node& node, axis_description& a) const {
        const auto name = node.need("law");
        const auto* kind = quadrant::diagnosis::find_controller_kind(name.text());
        if (!kind)
            name.refuse(fmt::format("{} is none of {}", qd::in_quotes(name.text()), qd::names_of_kinds()));
        nlohmann::json whole = *node.value;
        for (const auto& [key, value] : plant_keys_of(a))
            if (has_key(*kind, key) && !whole.contains(key)) whole[key] = value;
        const qd::json_node filled{&whole, node.path, node.file};
        a.law = qd::read_controller(*kind, filled, out_.servo_period_s, "law", [](const std::string&) {});
    }
    static bool has_key(const quadrant::diagnosis::controller_kind& kind, std::string_view name) {
        return std::any_of(kind.keys.begin(), kind.keys.end(),
                           [&](const auto& key) { return key.name == name; });
    }

    void read_friction_feedforward(const qd::json_node& node, axis_description& a) const {
        const auto& kind = quadrant::diagnosis::kind_of(a.law);
        if (!has_key(kind, "friction.scale"))
            node.refuse(kind.coulomb.key.empty()
                            ? fmt::format("law {} feeds no friction of the drive forward", kind.name)
                            : fmt::format("{} has its own: control.{}", kind.name, kind.coulomb.key));
        if (a.law.has("friction.width_m_per_s")) node.refuse("contradicts control.friction: give one of them");
        friction_feedforward_description f;
        qd::read_numbers(node, friction_feedforward_keys, {}, f);
        feed_friction_forward(a, f);
    }

    static void read_cutting_load(const qd::json_node& node, axis_description& a) {
        cutting_load_description c;
        qd::read_numbers(node, cutting_load_keys, cutting_load_other_keys, c);
        const auto numbers = [&](const char* key, std::vector<double>& to) {
            const auto given = node.find(key);
            if (!given) return false;
            to = given->numbers(qd::rule::any_number);
            if (to.empty() || to.size() > cutting_load_description::most_harmonics)
                given->refuse(
                    fmt::format("must hold 1 to {} harmonics", cutting_load_description::most_harmonics));
            return true;
        };
        const auto mean = [&](const char* key) {
            const auto given = node.find(key);
            if (given) c.mean = given->number(qd::rule::any_number);
            return given.has_value();
        };
        // Every key is read, whichever was given before it.
        const auto any = [](std::initializer_list<bool> given) {
            return std::find(given.begin(), given.end(), true) != given.end();
        };
        const bool force = any({mean("mean_N"), numbers("cosine_N", c.cosine), numbers("sine_N", c.sine)});
        std::vector<double> cosine, sine;
        const double mean_N = c.mean;
        c.torque = any({mean("mean_Nm"), numbers("cosine_Nm", cosine), numbers("sine_Nm", sine)});
        if (force == c.torque)
            node.refuse(
                force ? "must be given in N or in N m, not in both"
                      : "must have at least one of mean_N, cosine_N, sine_N, mean_Nm, cosine_Nm, sine_Nm");
        if (!c.torque) c.mean = mean_N;
        if (c.torque && !std::holds_alternative<ball_screw_description>(a.drive))
            node.refuse("a linear motor has no screw for a torque: give it in N");
        if (c.torque) c.cosine = std::move(cosine), c.sine = std::move(sine);
        a.load = std::move(c);
    }

    template <class Names> static std::size_t choice(const qd::json_node& node, const Names& names) {
        std::string all;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (node.text() == std::data(names)[i]) return i;
            all += fmt::format("{}{}", i == 0 ? "" : ", ", std::data(names)[i]);
        }
        node.refuse(fmt::format("{} is none of {}", qd::in_quotes(node.text()), all));
    }
    static std::size_t choice(const qd::json_node& node, std::initializer_list<std::string_view> names) {
        return choice<std::initializer_list<std::string_view>>(node, names);
    }
    static bool yes(const qd::json_node& node) {
        if (!node.value->is_boolean()) node.refuse("must be true or false");
        return node.value->get<bool>();
    }

    nlohmann::json root_;
    qd::json_node top_;
    cnc_description out_;
};

/// Reads a machine's file or throws bad_input.
inline cnc_description read_cnc(const std::filesystem::path& path) {
    return cnc_reader(qd::read_whole(path), path.string()).read();
}

} // namespace quadrant_cnc
