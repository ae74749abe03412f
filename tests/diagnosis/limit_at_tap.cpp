// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/model/driven_motion.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

TEST_CASE("a drive at its limit: what its tap reads is what was asked at that moment, cut off") {
    // A set-point that is lost, with a velocity feedforward: nothing is asked for a row, and twice as much in
    // the next one. Both are beyond the limit, and the reading is at the step between two rows.
    constexpr double step = 0.3e-3, gain = 1e4, limit = 1500;
    constexpr std::size_t lost = 20;
    drive_model d;
    d.kind = drive_kind::position;
    d.between = quadrant::interpolation::linear;
    d.velocity_gain = gain;
    d.velocity_feedforward = 1;
    d.force_limit = limit;
    driven_motion m;
    m.period = 1e-3;
    for (std::size_t k = 0; k < 40; ++k) m.position.push_back(step * static_cast<double>(k));
    m.set_point = m.position;
    m.set_point[lost] = m.set_point[lost - 1];
    m.measured.assign(m.position.size(), 0.0);
    m.find_velocity();
    for (const bool after : {false, true}) {
        CAPTURE(after);
        d.read.tap = after ? tap_reading::after_set_point : tap_reading::before_set_point;
        const auto beside = m.run(d).beside;
        const std::size_t first = after ? lost : lost + 1;
        for (std::size_t k = 10; k < 30; ++k) {
            CAPTURE(k);
            const double given = k == first ? -limit : k == first + 1 ? limit : 0;
            CHECK(std::abs(beside[k] + given) < 1e-6);
        }
    }
}
