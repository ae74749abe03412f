// SPDX-License-Identifier: BSL-1.0
// Long: the candidates of three machines, one machine after the other.
#pragma once
#include "milling_table.hpp"
#include "stage.hpp"
#include "virtual_cnc.hpp"

#include "quadrant_reproduce/wrong_y_axis.hpp"

/// What the sources could not explain: their machines with one candidate cause each, their motions, and machine
/// files that do not know of the cause. docs/explanation/gaps_of_the_sources.md is made of them.
namespace sources::causes {

using namespace quadrant;
using namespace quadrant::literals;

/// A log with one cause in it, another motion with the same cause, and the file of the machine without it.
struct made {
    recording log, holdout;
    nlohmann::ordered_json machine;
    double seen = 0; ///< the figure that puzzled the source, in its unit
};
/// One candidate. `truth`: effects of the diagnosis that are the cause or say the same of this motion; empty:
/// nothing differs.
struct candidate {
    std::string name, puzzle, words;
    std::vector<std::string> truth;
    std::function<made()> make;
};

// --- The milling table: 1.2 um simulated, 10 um measured behind a reversal of y with GMS feedforward. ---

/// The law of Table 4.2 in the words of a machine file, and the y axis of the tables.
inline nlohmann::ordered_json table_file() {
    const thesis::axis& a = thesis::y;
    auto d = milling_table::described(a, {});
    diagnosis::controller_description c;
    c.kind = "milling_axis";
    const auto n = thesis::notch_of(a);
    c.set("position_gain_per_s", thesis::position_gain.value());
    c.set("velocity_gain_V_s_per_m", a.kp.value());
    c.set("velocity_integral_V_per_m", a.ki.value());
    c.set("velocity_filter_Hz", thesis::estimator_corner.value());
    c.set("acceleration_feedforward_V_s2_per_m", 1 / a.B.value());
    c.set("viscous_feedforward_V_s_per_m", a.A_gms.value() / a.B.value());
    c.set("notch.frequency_Hz", n.centre.value());
    c.set("notch.width", n.width);
    const auto f = thesis::gms_model::of(a);
    const thesis::gms_model::box box(f, thesis::period);
    c.set("friction.coulomb_V", f.curve.coulomb.value());
    c.set("friction.static_V", f.curve.static_level.value());
    c.set("friction.stribeck_velocity_m_per_s", f.curve.stribeck_velocity.value());
    c.set("friction.viscous_V_s_per_m", f.curve.viscous.value());
    std::vector<double> weights, stiffness;
    for (const double w : box.weights()) weights.push_back(w);
    for (const auto& k : f.stiffness) stiffness.push_back(k.value());
    c.values["friction.gms_weights"] = weights;
    c.values["friction.gms_stiffness_V_per_m"] = stiffness;
    c.set("friction.gms_attraction_V_per_s", f.attraction.value());
    d.controller = c;
    diagnosis::machine_description file;
    file.sample_period_s = thesis::period.value();
    file.excluded_effects = {"backlash"}; // a direct drive
    file.axes.push_back(d);
    auto out = to_json(file);
    out["axes"][a.name]["plant"]["gms_attraction_N_per_s"] = a.C.value();
    return out;
}
inline recording table_log(const thesis::difference& d, const motion& m) {
    recording out{thesis::period.value(), {{"y", "V", {}}}};
    thesis::drive_wrong(
        d, [&](double t) { return m.at(t).y; }, m.lasts,
        [&](double, const axis_motion<>& asked, double, double reading, double command) {
            out.axes[0].rows.push_back({asked.position.value(), reading, command});
            return true;
        });
    return out;
}
/// The sizes are those that leave 10 um (docs/reproduction.md, milling.sensitivity), rounded.
inline void add_table(std::vector<candidate>& to) {
    const auto put = [&](const char* name, const char* words, std::vector<std::string> truth,
                         const thesis::difference& d) {
        to.push_back({std::string("table.") + name, "table", words, std::move(truth), [=] {
                          made out;
                          out.log = table_log(d, sinusoid("sine100", 0.1, 3));
                          out.holdout = table_log(d, diamond());
                          out.machine = table_file();
                          if (const auto found = thesis::reversals_with(d)) out.seen = found->glitch;
                          return out;
                      }});
    };
    put("none", "nothing differs", {}, {});
    put("friction_above", "all friction 33 % above the table",
        {"coulomb_friction", "stribeck_friction", "presliding_friction"}, {.level = 1.33});
    put("friction_below", "all friction 34 % below the table",
        {"coulomb_friction", "stribeck_friction", "presliding_friction"}, {.level = 0.66});
    put("coulomb_above", "Fc alone 40 % above", {"coulomb_friction", "stribeck_friction"}, {.coulomb = 1.4});
    put("stiffer", "springs 11 times stiffer", {"presliding_friction"}, {.stiffness = 11});
    put("softer", "springs 6.7 times softer", {"presliding_friction"}, {.stiffness = 1 / 6.7});
    put("viscous", "1670 N s/m of viscous friction more", {"viscous_friction"}, {.viscous = 1670});
    put("motor_weaker", "force constant 23 % below", {"force_constant", "mass"}, {.force_constant = 0.77});
    put("motor_stronger", "force constant 51 % above", {"force_constant", "mass"}, {.force_constant = 1.51});
    put("cogging", "cogging of 200 N, one wave in 32 mm", {"cogging"}, {.cogging = 200});
    put("velocity_lag", "velocity estimate later by 4.3 ms", {"controller_mismatch"}, {.lag = 4.3e-3});
    put("encoder_noise", "7.9 um rms of noise on the encoder", {}, {.noise = 7.9e-6});
}

// --- The Virtual CNC: predicted against measured errors, the y axis among them. ---

struct cnc_difference {
    double friction_y = 1, inertia_y = 1, torque_constant_y = 1;
    quantity<si::length> play{};
    int late = 0; ///< whole periods of the command
};
inline vcnc::machine_boxes::parameters cnc_machine(const vcnc::axis& a, const cnc_difference& d,
                                                   std::uint64_t seed) {
    const bool of_y = a.name[0] == 'y';
    auto p = vcnc::drive(a, d.play, seed);
    if (of_y) {
        for (auto* side : {&p.drive.friction.forward, &p.drive.friction.backward})
            side->static_level *= d.friction_y, side->coulomb *= d.friction_y;
        p.drive.inertia *= d.inertia_y;
        p.drive.torque_constant *= d.torque_constant_y;
    }
    return p;
}
inline recording cnc_log(const cnc_difference& d, const motion& m, double* most_of_y = nullptr) {
    recording out{vcnc::period.value(), {}};
    std::uint64_t seed = 1;
    for (const vcnc::axis* a : {&vcnc::x_axis, &vcnc::y_axis}) {
        feed_drive<vcnc::machine_boxes> drive{.box = {cnc_machine(*a, d, seed++), vcnc::period}};
        feed_control<feed_control_boxes<sliding_mode<>>> control{
            .box = {
                {.law = vcnc::sliding_mode_of(*a), .limit = vcnc::command_limit, .dac_step = vcnc::dac_step},
                vcnc::period}};
        const bool of_x = a->name[0] == 'x';
        const auto asked = [&](std::size_t k) {
            const auto both = m.at(static_cast<double>(k) * vcnc::period.value());
            return of_x ? both.x : both.y;
        };
        drive.settle(asked(0).position);
        control.settle(asked(0).position);
        recording::axis logged{a->name, "V", {}};
        std::vector<quantity<si::electric_potential>> waiting(static_cast<std::size_t>(d.late));
        for (std::size_t k = 0; static_cast<double>(k) * vcnc::period.value() <= m.lasts; ++k) {
            const auto now = drive.measured();
            const auto command = control(asked(k), now);
            const double error = asked(k).position.value() - drive.wire.place.value();
            if (most_of_y && !of_x) *most_of_y = std::max(*most_of_y, 1e6 * std::abs(error));
            logged.rows.push_back({asked(k).position.value(), now.position.value(), command.value()});
            waiting.push_back(command);
            drive(waiting.front());
            waiting.erase(waiting.begin());
        }
        out.axes.push_back(std::move(logged));
    }
    return out;
}
inline void add_cnc(std::vector<candidate>& to) {
    const auto put = [&](const char* name, const char* words, std::vector<std::string> truth,
                         const cnc_difference& d) {
        to.push_back({std::string("cnc.") + name, "cnc", words, std::move(truth), [=] {
                          made out;
                          out.log = cnc_log(d, diamond(), &out.seen);
                          out.holdout = cnc_log(d, cnc_circle());
                          diagnosis::machine_description file;
                          file.sample_period_s = vcnc::period.value();
                          for (const vcnc::axis* a : {&vcnc::x_axis, &vcnc::y_axis})
                              file.axes.push_back(virtual_cnc::described(*a, 0_m));
                          out.machine = to_json(file);
                          return out;
                      }});
    };
    put("none", "nothing differs", {}, {});
    put("friction_y", "friction of y 0.65 of the table", {"coulomb_friction", "stribeck_friction"},
        {.friction_y = 0.65});
    put("play", "play of 3 um in both screws", {"backlash"}, {.play = 3_um});
    put("inertia_y", "inertia of y 20 % above", {"mass", "force_constant"}, {.inertia_y = 1.2});
    put("motor_y", "torque constant of y 15 % below", {"force_constant", "mass", "coulomb_friction"},
        {.torque_constant_y = 0.85});
    put("late", "command one period late", {"time_delay"}, {.late = 1});
}

// --- The precision stage: how long 500 um take to settle. ---

inline recording stage_log(const stage::machine& is, const std::function<axis_motion<>(double)>& reference,
                           double lasts, double length, double* settles) {
    recording out{stage::period.value(), {{"x", "A", {}}}};
    stage::run<stage::no_feedforward>(is, stage::believed, stage::moderate, reference, lasts,
                                      [&](const stage::moment& m) {
                                          out.axes[0].rows.push_back({m.reference, m.measured, m.command});
                                          if (settles && std::abs(length - m.position) > 2e-6)
                                              *settles = 1e3 * (m.time + stage::period.value());
                                      });
    return out;
}
/// What the diagnosis asks for after the source's move: swings at 1.8 Hz, both ways.
inline std::function<axis_motion<>(double)> stage_swings(double stroke) {
    return [size = stroke / 2, w = 2 * std::numbers::pi * 1.8](double t) {
        return axis_motion<>{size * (1 - std::cos(w * t)) * 1_m, size * w * std::sin(w * t) * 1_mps,
                             size * w * w * std::cos(w * t) * 1_mps2};
    };
}
inline void add_stage(std::vector<candidate>& to, bool swings) {
    const auto put = [&](const char* name, const char* words, std::vector<std::string> truth,
                         const stage::machine& is) {
        const std::string puzzle = swings ? "stage_swings" : "stage";
        to.push_back({puzzle + "." + name, puzzle, words, std::move(truth), [=] {
                          const auto curve = [](double length, double time) {
                              return [s = trajectory::s_curve({length * 1_m, time * 1_s})](double t) {
                                  const auto m = s(t * 1_s);
                                  return axis_motion<>{m.position, m.velocity, m.acceleration};
                              };
                          };
                          made out;
                          out.log = stage_log(is, curve(500e-6, 0.2), 2.2, 500e-6, &out.seen);
                          out.holdout = stage_log(is, curve(0.02, 0.5), 1.2, 0.02, nullptr);
                          if (swings) {
                              out.log = stage_log(is, stage_swings(20e-3), 4 / 1.8, 0, nullptr);
                              out.holdout = stage_log(is, stage_swings(10e-3), 4 / 1.8, 0, nullptr);
                          }
                          diagnosis::machine_description file;
                          file.sample_period_s = stage::period.value();
                          file.excluded_effects = {"backlash"}; // a direct drive
                          file.axes.push_back(precision_stage::described(false));
                          out.machine = to_json(file);
                          return out;
                      }});
    };
    const auto with = [](auto change) {
        stage::machine m = stage::real;
        change(m);
        return m;
    };
    put("none", "nothing differs", {}, stage::real);
    put("friction", "all friction 30 % above", {"coulomb_friction", "stribeck_friction", "presliding_friction"},
        with([](auto& m) { m.coulomb *= 1.3, m.static_level *= 1.3; }));
    put("breakaway", "breakaway 50 % above", {"stribeck_friction", "presliding_friction"},
        with([](auto& m) { m.static_level *= 1.5; }));
    put("softer", "bristles 3 times softer", {"presliding_friction"}, with([](auto& m) { m.stiffness /= 3; }));
    put("load", "2 kg more on the table", {"mass", "force_constant"}, with([](auto& m) { m.mass += 2; }));
    put("motor", "force constant 15 % below", {"force_constant", "mass", "coulomb_friction"},
        with([](auto& m) { m.force_constant *= 0.85; }));
}

inline std::vector<candidate> all() {
    std::vector<candidate> out;
    add_table(out);
    add_cnc(out);
    add_stage(out, false);
    add_stage(out, true);
    return out;
}

} // namespace sources::causes
