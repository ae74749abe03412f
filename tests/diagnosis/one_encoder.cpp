// SPDX-License-Identifier: BSL-1.0
#include <doctest/doctest.h>
#include <quadrant/diagnosis/model/closed_drive.hpp>

using namespace quadrant::diagnosis;

TEST_CASE("closed drive: its loops hold what the one encoder reads, with a second one what the motor's reads") {
    constexpr double period = 0.005, held = 0.01025, wrong = 20e-6;
    plant_description d;
    d.mass_kg = 100;
    d.force_constant_N_per_V = 1;
    plant_model p(d, 1e-6);
    p.cyclic.count = 1;
    p.cyclic.period = 1e-3; // at a quarter of it the encoder reads most beside the truth
    p.cyclic.sine[0] = wrong;
    p.drive.kind = drive_kind::position;
    p.drive.velocity_gain = 25000;
    p.drive.velocity_integral = 1.2e6;
    p.drive.position_gain = 40;
    driven_motion m;
    m.period = period;
    m.set_point.assign(400, held);
    m.position.assign(400, 0.0);
    m.velocity.assign(400, 0.0);
    const auto reads_at_last = [&] {
        double out = 0;
        run_closed(p, m, period, 0, {}, [&](std::size_t, double reading, const auto&) { out = reading; });
        return out;
    };
    CHECK(reads_at_last() == doctest::Approx(held).epsilon(1e-6));
    m.one_encoder = false;
    CHECK(reads_at_last() == doctest::Approx(held + wrong).epsilon(1e-6));
}
