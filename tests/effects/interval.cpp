// SPDX-License-Identifier: BSL-1.0
// How sure a value is beside forces that have no name.
#include "arm.hpp"

using namespace arms;

TEST_CASE("intervals: what is left beside a number of the file moves it by a share of what it is off, not of "
          "itself") {
    const arm real{.gravity = 3.2, .rumble = 0.2};
    auto file = described(real);
    file.axes[0].plant.gravity_torque_Nm = 3.2;
    file.axes[0].plant.gravity_phase_rad = 0;
    file.axes[0].plant.force_constant_N_per_V = 1.05;
    const auto d = diagnose(file, run(real));
    CAPTURE(said(d));
    REQUIRE(claims(d) == std::vector<std::string>{"force_constant"});
    const estimate found = value_of(d.causes[0], "torque_constant_Nm_per_V");
    CHECK(found.low < real.torque_constant);
    CHECK(real.torque_constant < found.high);
    CHECK(found.high - found.low < 0.2 * found.value); // half of the gap is the rumble
    CHECK(found.low > 1.05);
}
