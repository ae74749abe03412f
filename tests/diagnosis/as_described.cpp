// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/which/as_described.hpp"
#include "quadrant/diagnosis/effect/cogging.hpp"
#include "quadrant/diagnosis/effect/drive_gain.hpp"
#include "quadrant/diagnosis/effect/presliding_friction.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

cause found(std::vector<parameter_estimate> values) {
    cause out;
    out.described = true;
    out.parameters = std::move(values);
    return out;
}

} // namespace

TEST_CASE("as described: a gain is compared with the one of its own key, whatever other gains the drive has") {
    axis_description axis;
    axis.kind = axis_kind::rotary;
    axis.drive.kind = drive_kind::position_servo;
    axis.drive.velocity_per_V = 1;
    axis.drive.position_gain_per_m = 0.575;
    const plant_model file(axis, workshop::usual.give());
    const auto gain = [&](double low, double high) {
        return detail::is_as_described(found({{"drive.position_gain_per_m", {{1.15, low, high}}}}),
                                       suspect::drive_gain, file);
    };
    CHECK_FALSE(gain(0.88, 1.42)); // 1, the volt's velocity, is inside
    CHECK(gain(0.5, 1.8));
}

TEST_CASE("as described: every number is, or the effect is another one") {
    axis_description axis;
    axis.plant.mass_kg = 10;
    axis.plant.cogging_period_m = 0.03;
    axis.plant.cogging_N = {30};
    axis.plant.cogging_phase_rad = {3.1};
    const plant_model file(axis, workshop::usual.give());
    const auto wave = [&](const estimate& size, const estimate& phase) {
        const auto values = found({{"cogging_period_m", {{0.03, 0.0299, 0.0301}}},
                                   {"cogging_N", {size}},
                                   {"cogging_phase_rad", {phase}}});
        return detail::is_as_described(values, suspect::cogging, file);
    };
    const estimate same{31, 29, 33}, larger{39, 37, 41}, turned{-3.15, -3.25, -3.05}, early{2.5, 2.4, 2.6};
    CHECK(wave(same, turned)); // 3.1 rad less a turn
    CHECK_FALSE(wave(larger, turned));
    CHECK_FALSE(wave(same, early));
    cause unknown = found({{"cogging_N", {same}}});
    unknown.described = false;
    CHECK_FALSE(detail::is_as_described(unknown, suspect::cogging, file));
}

TEST_CASE("as described: of a contact whose law others imitate its length decides") {
    axis_description axis;
    axis.plant.mass_kg = 10;
    axis.plant.coulomb_N = 20;
    axis.plant.presliding_length_m = 8e-6;
    const plant_model file(axis, workshop::usual.give());
    const auto read = suspect::presliding_friction.read(file);
    REQUIRE(read.size() > 1);
    std::vector<parameter_estimate> values;
    for (const key_value& k : read) { // every number but the length is far from the file's
        parameter_estimate p{k.key, {}};
        for (const double v : k.values) p.values.push_back({2 * v, 1.9 * v, 2.1 * v});
        values.push_back(p);
    }
    const double length = read.front().values.front();
    values.front().values.front() = {1.2 * length, 0.5 * length, 3 * length};
    CHECK(detail::is_as_described(found(values), suspect::presliding_friction, file));
    values.front().values.front() = {2 * length, 1.5 * length, 3 * length};
    CHECK_FALSE(detail::is_as_described(found(values), suspect::presliding_friction, file));
}
