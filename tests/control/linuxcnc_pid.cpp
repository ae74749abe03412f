// SPDX-License-Identifier: BSL-1.0
#include <doctest/doctest.h>

#include "quadrant/base/in_si.hpp"
#include "quadrant/base/literals.hpp"
#include "quadrant/control/linuxcnc_pid.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;
using law = linuxcnc_pid<>;

namespace {

law::parameters pins_of(std::istringstream& line) {
    law::parameters p;
    p.pgain = {};
    std::string pin, value;
    while (line >> pin >> value) {
        const double x = std::strtod(value.c_str(), nullptr);
        const auto set = [&](const char* name, auto& place) {
            if (pin == name) place = in_si(x);
        };
        if (pin == "error-previous-target") p.error_previous_target = x != 0;
        set("Pgain", p.pgain), set("Igain", p.igain), set("Dgain", p.dgain), set("bias", p.bias);
        set("FF0", p.ff0), set("FF1", p.ff1), set("FF2", p.ff2), set("FF3", p.ff3);
        set("deadband", p.deadband), set("maxerror", p.maxerror), set("maxoutput", p.maxoutput);
        set("maxerrorI", p.maxerror_i), set("maxerrorD", p.maxerror_d), set("maxcmdD", p.maxcmd_d);
        set("maxcmdDD", p.maxcmd_dd), set("maxcmdDDD", p.maxcmd_ddd);
    }
    return p;
}

} // namespace

TEST_CASE("linuxcnc_pid: every output is that of LinuxCNC's component, bit for bit (a table that the component "
          "wrote: tests/linuxcnc/pid_table.sh)") {
    std::ifstream table(QUADRANT_SOURCE_DIR "/tests/control/linuxcnc_pid.table");
    std::optional<law> block;
    int cases = 0, samples = 0, equal = 0;
    for (std::string line; std::getline(table, line);) {
        std::istringstream cells(line);
        std::string first, second, third;
        cells >> first >> second;
        if (first == "case") {
            ++cases;
            block.emplace(pins_of(cells), in_si(1e-9 * std::atof(second.c_str())));
            continue;
        }
        cells >> third;
        const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
        REQUIRE(block);
        ++samples;
        equal += (*block)(law::position(in_si(number(first))), in_si(number(second))).value() == number(third);
    }
    CHECK(cases == 8);
    CHECK(samples == 8 * 60);
    CHECK(equal == samples);
}

TEST_CASE(
    "linuxcnc_pid: settled in an even motion it gives the command that it was told, and goes on from there") {
    law block({.pgain = 4150_V / 1_m,
               .igain = in_si(33000.0),
               .dgain = 35_V / 1_mps,
               .ff1 = 0.22_V / 1_mps,
               .error_previous_target = false},
              1_ms);
    block.settle({.reference = 20_mm,
                  .measured = 19.9_mm,
                  .reference_velocity = 50_mmps,
                  .measured_velocity = 50_mmps,
                  .command = 1.3_V});
    const auto u = block(law::position(20.05_mm), 19.95_mm); // the same error: only the integral has gone on
    CHECK(u.value() == doctest::Approx(1.3 + 33000 * 1e-4 * 1e-3));
    block.settle(5_mm, 0.7_V);
    CHECK(block(law::position(5_mm), 5_mm).value() == doctest::Approx(0.7));
}

TEST_CASE("linuxcnc_pid: the integral rests while the output is at its limit and the error points there") {
    law block({.pgain = 100_V / 1_m, .igain = in_si(1000.0), .maxoutput = 1_V, .error_previous_target = false},
              1_ms);
    for (int k = 0; k < 100; ++k) block(law::position(20_mm), 0_mm);
    CHECK(block.limited());
    CHECK(block.now().error_i.value() == doctest::Approx(20e-6)); // one sample of it, before the first limit
    block(law::position(-1_mm), 0_mm);
    CHECK(block.now().error_i.value() == doctest::Approx(19e-6));
}

TEST_CASE("linuxcnc_pid: a NaN holds the output and is seen; a limit below 0 is refused") {
    law block({.pgain = 100_V / 1_m}, 1_ms);
    const auto before = block(law::position(1_mm), 0_mm);
    CHECK(block(law::position(in_si(std::nan(""))), 0_mm) == before);
    CHECK(block.faulted());
    CHECK_THROWS_WITH_AS(law({.maxoutput = -1_V}, 1_ms),
                         "linuxcnc_pid.maxoutput = -1 V: must be finite and not below 0", invalid_parameter);
}
