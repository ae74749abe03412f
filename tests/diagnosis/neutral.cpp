// SPDX-License-Identifier: BSL-1.0
// A model is continuous where an effect vanishes: a machine file that has a key at its neutral value, or a
// billionth of a typical size beside it, predicts what the file without the key predicts. The gaps agree
// within 1e-6: an effect of typical size moves the gap by less than a thousand times the gap, a billionth of
// it by less than a millionth. A jump at the neutral value is larger by orders, however small the key.
#include "quadrant/diagnosis/effect/effect_list.hpp"
#include "quadrant/diagnosis/machine_file/machine_keys.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/simulate.hpp"
#include "quadrant/diagnosis/write_machine.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string_view>

using namespace quadrant::diagnosis;
using json = nlohmann::ordered_json;

namespace {

/// Where a key is neutral, by its size: `with` what it needs in the file, as box.key, which stays in the file
/// without it.
struct neutral_place {
    json at;   ///< the neutral value; null: none can be written
    json near; ///< a billionth of a typical size beside it
    json with = json::object();
    bool together = true; ///< the companions mean nothing without the key, and go with it
};

const std::map<std::string, neutral_place>& places() {
    static const std::map<std::string, neutral_place> all{
        {"plant.viscous_N_s_per_m", {0, 250e-9}},
        {"plant.delay_s", {0, 1e-12}},
        {"plant.coulomb_N", {0, 60e-9}},
        {"plant.static_N", {60, 60 + 60e-9, {{"plant.stribeck_velocity_m_per_s", 0.004}}}},
        {"plant.stribeck_exponent",
         {1, 1 + 1e-9, {{"plant.static_N", 90}, {"plant.stribeck_velocity_m_per_s", 0.004}}, false}},
        {"plant.viscous_asymmetry", {0, 1e-10}},
        {"plant.coulomb_asymmetry", {0, 1e-10}},
        {"plant.static_asymmetry",
         {0, 1e-10, {{"plant.static_N", 90}, {"plant.stribeck_velocity_m_per_s", 0.004}}, false}},
        {"plant.stribeck_velocity_asymmetry",
         {0, 1e-10, {{"plant.static_N", 90}, {"plant.stribeck_velocity_m_per_s", 0.004}}, false}},
        {"plant.constant_force_N", {0, 20e-9}},
        {"plant.cogging_N", {{0}, {15e-9}, {{"plant.cogging_period_m", 0.03}}}},
        {"plant.cogging_phase_rad",
         {{0}, {1e-9}, {{"plant.cogging_N", {15}}, {"plant.cogging_period_m", 0.03}}, false}},
        {"plant.presliding_length_m", {nullptr, 1e-12}},
        {"plant.presliding_damping_s", {0, 1e-12, {{"plant.presliding_length_m", 1e-5}}, false}},
        {"plant.gms_stiffness_N_per_m", {nullptr, {1e12}, {{"plant.gms_weights", {1}}}}},
        {"plant.gms_attraction_N_per_s",
         {nullptr, 1e12, {{"plant.gms_weights", {1}}, {"plant.gms_stiffness_N_per_m", {1e7}}}, false}},
        {"plant.friction_position_amplitude", {0, 1e-10, {{"plant.friction_position_period_m", 0.07}}}},
        {"plant.friction_position_phase_rad",
         {0,
          1e-9,
          {{"plant.friction_position_amplitude", 0.2}, {"plant.friction_position_period_m", 0.07}},
          false}},
        {"plant.load_friction", {0, 1e-10}},
        {"plant.friction_drift", {0, 1e-10, {{"plant.friction_drift_time_s", 3}}}},
        {"plant.mode_mass_kg", {nullptr, 20e-9, {{"plant.mode_frequency_Hz", 70}}}},
        {"plant.backlash_m", {0, 1e-12}},
        {"plant.spring_N_per_m", {0, 800e-9}},
        {"plant.coupling", {0, 1e-10}},
        {"plant.ripple", {0, 1e-11, {{"plant.ripple_period_m", 0.024}}}},
        {"plant.ripple_phase_rad",
         {0, 1e-9, {{"plant.ripple", 0.02}, {"plant.ripple_period_m", 0.024}}, false}},
        {"actuator.limit_V", {nullptr, 1e12}},
        {"actuator.lag_s", {0, 2e-12}},
        {"actuator.drive_limit_V", {nullptr, 1e12}},
        {"actuator.dead_zone_V", {0, 5e-11}},
        {"actuator.loss_probability", {0, 1e-11}},
        {"encoder.resolution_m", {0, 1e-12}},
        {"encoder.cyclic_m", {0, 1e-12, {{"encoder.cyclic_period_m", 4e-4}}}},
        {"encoder.cyclic_phase_rad",
         {0, 1e-9, {{"encoder.cyclic_m", 1e-6}, {"encoder.cyclic_period_m", 4e-4}}, false}},
        {"process.force_N", {{0}, {20e-9}, {{"process.fundamental_Hz", 23.3}}}},
        {"process.phase_rad",
         {{0}, {1e-9}, {{"process.force_N", {20}}, {"process.fundamental_Hz", 23.3}}, false}},
        {"process.mean_N", {0, 20e-9}},
        {"controller.velocity_integral_V_per_m", {0, 300e-9}},
        {"controller.velocity_feedforward", {0, 1e-9}},
        {"controller.acceleration_feedforward_V_s2_per_m", {0, 1e-10}},
        {"controller.viscous_feedforward_V_s_per_m", {0, 1e-10}},
        {"controller.coulomb_feedforward_V", {0, 5e-11}}};
    return all;
}
/// What the trial puts into a machine of this motion, at most.
class trial_sizes : public trial_machine {
public:
    explicit trial_sizes(const trial_injection& t) : trial_machine(t.high, around_) { t.into(*this); }
    double of(std::string_view key) const { return values_.at(std::string(key)); }

    double described(std::string_view) const override { return 0; }
    double now(std::string_view) const override { return 0; }
    void set(std::string_view key, double value) override { values_[std::string(key)] = value; }
    void set(std::string_view key, const std::vector<double>& values) override { set(key, values[0]); }
    void set_untold(std::string_view, const std::vector<double>&) override {}
    void change_controller() override {}
    double uniform() override { return 0.5; }

private:
    static constexpr trial_scale around_{.peak_command = 0.1, .peak_force = 100};
    std::map<std::string, double> values_{};
};

/// Where a key is neutral: as listed; a number of a law that an effect brings along needs no line there: its
/// law is absent at 0, and its typical size is what the trial puts in.
std::optional<neutral_place> place_of(const std::string& key) {
    if (const auto listed = places().find(key); listed != places().end()) return listed->second;
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (e->law && e->trial.into && std::string(k.box()) + "." + k.key_for(axis_kind::linear) == key)
                return neutral_place{0, 1e-9 * trial_sizes(e->trial).of(k.name)};
    return {};
}
/// Keys without a neutral value: what every machine has, and what only says where another key's effect is.
const std::set<std::string> without_neutral{
    "actuator.command_is", // a word
    // Two bodies, however narrow the play.
    "plant.backlash_behind_m", "plant.backlash_motor_mass_kg", "plant.backlash_motor_coulomb_N",
    "plant.mass_kg", "plant.force_constant_N_per_V", "plant.force_constant_N_per_A",
    "plant.stribeck_velocity_m_per_s", "plant.cogging_period_m", "plant.friction_position_period_m",
    "plant.gms_weights", // shares of what is there
    "plant.friction_drift_time_s", "plant.mode_frequency_Hz", "plant.mode_damping", "plant.ripple_period_m",
    "actuator.dac_bits", // rounding is a jump by nature
    "actuator.dac_range_V", "encoder.cyclic_period_m", "process.fundamental_Hz",
    "controller.position_gain_per_s", "controller.velocity_gain_V_s_per_m", "controller.velocity_filter_Hz"};
/// Lost commands are found in the log, and that they are looked for at all is a yes or a no. Were it to jump no
/// longer, the test would fail, so that this line goes.
constexpr std::string_view jumps = "actuator.loss_probability";

struct gaps {
    double force, position, command;
};
gaps gap_of(const json& file, const machine_log& log) {
    const auto s = simulate(read_machine(file.dump(), "neutral.json"), log);
    return {s.axes[0].gap.force_rms_N, s.axes[0].gap.position_rms_m, s.axes[0].gap.command_rms_V};
}
/// The largest relative difference of the gaps.
double apart(const gaps& a, const gaps& b) {
    const auto one = [](double x, double y) { return x == y ? 0 : std::abs(x - y) / std::max(x, y); };
    return std::max({one(a.force, b.force), one(a.position, b.position), one(a.command, b.command)});
}
json& at(json& file, const std::string& key) {
    const auto dot = key.find('.');
    return file["axes"]["x"][key.substr(0, dot)][key.substr(dot + 1)];
}
void erase(json& file, const std::string& key) {
    const auto dot = key.find('.');
    json& axis = file["axes"]["x"];
    const std::string box = key.substr(0, dot);
    if (!axis.contains(box)) return;
    axis[box].erase(key.substr(dot + 1));
    if (axis[box].empty()) axis.erase(box);
}

/// Every key that the reader knows in the boxes of an axis, as box.key.
std::vector<std::string> keys_of_reader() {
    std::vector<std::string> out;
    for (const char* box : {"plant", "actuator", "encoder", "process", "controller"})
        for (const std::string& key : quadrant::diagnosis::detail::keys_of_box(box, axis_kind::linear))
            out.push_back(std::string(box) + "." + key);
    return out;
}

} // namespace

TEST_CASE("neutral: every key of the reader has a neutral value here, or says that it has none") {
    for (const std::string& key : keys_of_reader()) {
        CAPTURE(key);
        CHECK(place_of(key).has_value() != without_neutral.contains(key));
    }
}

TEST_CASE(
    "neutral: a key at its neutral value, and a billionth beside it, leaves every gap as without the key" *
    doctest::test_suite("all")) {
    const workshop::machine real;
    auto log = workshop::as_log(workshop::run(real, workshop::strokes));
    axis_log other = log.axes[0]; // for the coupling
    other.name = "y";
    log.axes.push_back(other);
    auto described = workshop::described(real);
    auto& axis = described.axes[0];
    axis.plant.mass_kg *= 1.03; // a gap of all kinds to begin with
    axis.plant.coulomb_N = 60;
    // Rounding is a jump by nature: in a closed loop the smallest change may move a count.
    axis.encoder.resolution_m = 0;
    axis.actuator.dac_bits.reset();
    axis.actuator.dac_range_V.reset();
    const json file = to_json(described);
    for (const std::string& key : keys_of_reader()) {
        const auto found = place_of(key);
        if (!found) continue;
        const neutral_place& place = *found;
        json without = file;
        if (!place.together)
            for (const auto& [companion, value] : place.with.items()) at(without, companion) = value;
        erase(without, key);
        const gaps expected = gap_of(without, log);
        double worst = 0;
        for (const json& value : {place.at, place.near}) {
            if (value.is_null()) continue;
            json with = without;
            for (const auto& [companion, size] : place.with.items()) at(with, companion) = size;
            at(with, key) = value;
            worst = std::max(worst, apart(gap_of(with, log), expected));
        }
        CAPTURE(key);
        CHECK((worst <= 1e-6) == (key != jumps));
    }
}
