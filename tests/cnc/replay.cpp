// SPDX-License-Identifier: BSL-1.0 What quadrant-cnc logs and exports is one controller: the machine file's,
// replayed on the log, gives the logged command.
#include <doctest/doctest.h>

#include "quadrant_cnc/gap_machine.hpp"
#include "quadrant_cnc/log_writer.hpp"
#include "quadrant_cnc/read_cnc.hpp"
#include "quadrant_cnc/simulate.hpp"

#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/where/controller_mismatch.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

#include <filesystem>
#include <fstream>

namespace {

namespace files = std::filesystem;
namespace gap = quadrant::diagnosis;

struct exported {
    gap::machine_description machine;
    gap::machine_log log;
};

/// The mill's x and y axis under a law, along the strokes, by way of files.
exported run(const nlohmann::json& law, const char* friction) {
    const files::path folder = files::temp_directory_path() / fmt::format("quadrant_cnc_replay.{}", getpid());
    files::create_directories(folder);
    std::ifstream file(QUADRANT_SOURCE_DIR "/examples/programs/quadrant_cnc/mill.json");
    auto mill = nlohmann::json::parse(file);
    mill["axes"].erase("z");
    for (auto& axis : mill["axes"]) {
        axis["control"] = law;
        if (*friction) axis["friction_feedforward"] = nlohmann::json::parse(friction);
    }
    std::ofstream(folder / "cnc.json") << mill.dump();
    const auto cnc = quadrant_cnc::read_cnc(folder / "cnc.json");
    quadrant_cnc::log_writer writer(folder / "log.csv", quadrant_cnc::log_header(cnc));
    quadrant_cnc::simulate(cnc, QUADRANT_SOURCE_DIR "/examples/path/diamond.nc", &writer, {});
    writer.finish();
    std::vector<std::string> notes;
    const std::string machine = to_json(quadrant_cnc::gap_machine(cnc, notes)).dump();
    exported out{gap::read_machine(machine, "machine.json"), gap::read_log(folder / "log.csv")};
    files::remove_all(folder);
    return out;
}

} // namespace

TEST_CASE(
    "quadrant-cnc: the exported controller, replayed on the log, gives the logged command to one DAC step") {
    struct one {
        const char *key, *law, *friction = "";
    };
    for (
        const one& c :
        {one{"gain_V_per_m", R"({"law": "pid", "gain_V_per_m": 70e3, "integral_gain_V_per_m_s": 800e3,
                  "derivative_gain_V_s_per_m": 300, "derivative_corner_Hz": 300})"},
         one{"gain_V_s_per_m",
             R"({"law": "p_pi", "position_gain_per_s": 40, "gain_V_s_per_m": 200, "integral_gain_V_per_m": 9000,
                  "acceleration_gain_V_s2_per_m": 1.5})"},
         one{"gain_V_s_per_m",
             R"({"law": "sliding_mode", "sliding_per_s": 200, "gain_V_s_per_m": 300, "adaptation_V_per_m": 3e4})",
             R"({"scale": 0.9, "width_m_per_s": 0.002})"},
         one{"velocity_gain_V_s_per_m",
             R"({"law": "cascade_p_pi", "position_gain_per_s": 40, "velocity_gain_V_s_per_m": 150,
                  "velocity_integral_V_per_m": 5000, "velocity_filter_Hz": 200, "velocity_feedforward": 1})"},
         one{"natural_Hz", R"({"law": "pole_placement", "natural_Hz": 15, "observer_Hz": 25})"},
         one{"natural_Hz", R"({"law": "zero_phase", "natural_Hz": 15, "observer_Hz": 25})"},
         one{"crossover_Hz", R"({"law": "lead_lag", "crossover_Hz": 20})"},
         one{"plant_gain_m_per_s2_V", R"({"law": "generalized_predictive", "effort_m_per_V": 1e-5})"},
         one{"position_gain_V_per_m",
             R"({"law": "state_feedback", "position_gain_V_per_m": 5e4, "velocity_gain_V_s_per_m": 400,
                  "encoder_noise_m": 4e-7, "drift_V": 10})",
             R"({"scale": 0.9})"}}) {
        CAPTURE(c.law);
        const auto [machine, log] = run(nlohmann::json::parse(c.law), c.friction);
        for (std::size_t i = 0; i < log.axes.size(); ++i) {
            const gap::axis_description& axis = machine.axes[i];
            const gap::axis_log& column = log.axes[i];
            REQUIRE(axis.controller);
            const double dac = *axis.actuator.dac_range_V / std::exp2(*axis.actuator.dac_bits);
            const auto replayed = gap::replay_controller(
                *axis.controller, axis.actuator, machine.sample_period_s, gap::loop_columns::of(column));
            double worst = 0;
            for (std::size_t k = 100; k < replayed.size(); ++k)
                worst = std::max(worst, std::abs(replayed[k] - column.command[k]));
            CHECK(worst <= 1.01 * dac);
            auto other = *axis.controller; // and one that is off by 10 % does not
            other.set(c.key, 1.1 * other.number(c.key));
            const auto off = gap::replay_controller(other, axis.actuator, machine.sample_period_s,
                                                    gap::loop_columns::of(column));
            double most = 0;
            for (std::size_t k = 100; k < off.size(); ++k)
                most = std::max(most, std::abs(off[k] - column.command[k]));
            CHECK(most > 3 * dac);
        }
    }
}
