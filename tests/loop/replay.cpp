// SPDX-License-Identifier: BSL-1.0
// The cascade against recorded machines: the logs of the practice set whose controller is the one described.
#include "shared.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr double dac_step = 20.0 / 65536;
struct difference {
    double worst = 0; ///< in DAC steps
    long rows = 0, off = 0;
};
template <class Boxes>
difference replay(const char* number, const typename Boxes::parameters& p, duration period) {
    std::ifstream log(shared_data() / "gap/practice" / number / "log.csv");
    REQUIRE(log);
    cascade<Boxes> axis{.box = {p, period}};
    difference d;
    std::string line;
    std::getline(log, line);
    double t = 0, r = 0, y = 0, u = 0;
    char comma = 0;
    while (log >> t >> comma >> r >> comma >> y >> comma >> u) {
        const auto command = axis(quantity<si::length>::from_value(r), quantity<si::length>::from_value(y));
        const double steps = std::abs(command.value() - u) / dac_step;
        d.worst = std::max(d.worst, steps);
        d.off += steps > 0.01;
        ++d.rows;
    }
    return d;
}
} // namespace

// A reference written to 12 decimals is off by 5e-13 m; over T^2 and the acceleration feedforward that is
// 0.001, 0.004 and 0.01 DAC steps. The command is written to 6 decimals: 0.0016 steps. So: one step at a tie,
// never two.
TEST_CASE("cascade: gives the recorded command of practice 003, 005 and 015 to one DAC step" *
          doctest::skip(shared_missing())) {
    using plain = cascade_p_pi_boxes<>;
    using notched =
        cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
    const auto near = [](const difference& d, long rows, double share_off) {
        CHECK(d.rows == rows);
        CHECK(d.worst < 1.02);
        CHECK(double(d.off) < share_off * double(d.rows));
    };
    near(replay<notched>("003",
                         {.position_gain = 104.861 / 1_s,
                          .velocity_gain = 39.4461_V / 1_mps,
                          .velocity_integral = 384.125_V / 1_m,
                          .estimator = {163.943_Hz},
                          .acceleration_feedforward = 0.187806_V / 1_mps2,
                          .viscous_feedforward = 0.224606_V / 1_mps,
                          .coulomb_feedforward = 0.0850344_V,
                          .notch = {307.429_Hz, 0.08},
                          .limit = 8_V,
                          .dac_step = dac_step * 1_V},
                         1_ms),
         14105, 0.001);
    near(replay<plain>("005",
                       {.position_gain = 101.982 / 1_s,
                        .velocity_gain = 40.0052_V / 1_mps,
                        .velocity_integral = 294.35_V / 1_m,
                        .estimator = {227.731_Hz},
                        .acceleration_feedforward = 0.138457_V / 1_mps2,
                        .viscous_feedforward = 0.195975_V / 1_mps,
                        .coulomb_feedforward = 0.057815_V,
                        .limit = 10_V,
                        .dac_step = dac_step * 1_V},
                       500_us),
         28007, 0.002);
    const plain::parameters fifteen{.position_gain = 106.902 / 1_s,
                                    .velocity_gain = 27.264_V / 1_mps,
                                    .velocity_integral = 226.886_V / 1_m,
                                    .estimator = {217.598_Hz},
                                    .acceleration_feedforward = 0.0966016_V / 1_mps2,
                                    .viscous_feedforward = 0.234335_V / 1_mps,
                                    .limit = 8_V,
                                    .dac_step = dac_step * 1_V};
    near(replay<plain>("015", fifteen, 250_us), 55811, 0.005);

    auto wrong = fifteen; // and a gain that is off by a thousandth is seen
    wrong.position_gain = 1.001 * wrong.position_gain;
    CHECK(double(replay<plain>("015", wrong, 250_us).off) > 0.05 * 55811);
}
