// SPDX-License-Identifier: BSL-1.0
// The shoulder of an arm whose elbow bends: its inertia follows the elbow's angle, which no machine file
// describes. It is told, and no name stands in for it.
#include "claims.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace quadrant::diagnosis;
using workshop::said;

namespace {

/// Torque and angle of a shoulder of 0.5 kg m^2 plus `swing` cos(elbow), while the elbow bends by a drive of
/// its own.
std::string shoulder_and_elbow(double inertia, double swing) {
    constexpr double period = 0.002, h = period / 40, count = 2e-6, band = 2 * std::numbers::pi * 12;
    std::string out = "t_s,q1_ref_rad,q1_pos_rad,q1_cmd_Nm,q2_pos_rad\n";
    double q = 0, v = 0, before = 0;
    for (int k = 0; k < 6000; ++k) {
        const double t = k * period, a = 2 * std::numbers::pi * t, grown = std::min(t, 1.0);
        const double asked = grown * (0.5 * std::sin(0.41 * a) + 0.2 * std::sin(1.3 * a + 1));
        const auto elbow = [&](double at) { return 1.2 * std::sin(0.23 * 2 * std::numbers::pi * at) + 0.6; };
        const double read = count * std::round(q / count);
        const double torque = 0.5 * band * (band * (asked - read) - 1.8 * (read - before) / period);
        before = read;
        char row[120];
        std::snprintf(row, sizeof row, "%.4f,%.9f,%.8f,%.6f,%.8f\n", t, asked, read, torque, elbow(t));
        out += row;
        for (int i = 0; i < 40; ++i) {
            const double now = t + i * h, e = elbow(now), rate = (elbow(now + 1e-6) - elbow(now - 1e-6)) / 2e-6;
            v += h * (torque - 0.8 * v + swing * std::sin(e) * rate * v) / (inertia + swing * std::cos(e));
            q += h * v;
        }
    }
    return out;
}

diagnosis_result diagnosed(const std::string& csv) {
    const auto machine =
        read_machine(std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002,
        "axes": {"q1": {"plant": {"inertia_kg_m2": 0.6, "viscous_Nm_s_per_rad": 0.8},
                        "tolerance": {"inertia": 0.03, "viscous": 0.2}, "encoder": {"resolution_rad": 2e-6}}}})"),
                     "arm.json");
    std::istringstream text(csv);
    auto log = read_log(text, "arm.csv");
    keep_described(machine, log);
    check_match(machine, log);
    return diagnose(machine, log);
}
std::string told(const diagnosis_result& d) {
    for (const auto& n : d.notes)
        if (n.find("inertia depends on the angle") != n.npos) return n;
    return {};
}

} // namespace

TEST_CASE("turning inertia: a shoulder's inertia that follows the elbow is told with its size, and no name is "
          "claimed") {
    const auto d = diagnosed(shoulder_and_elbow(0.5, 0.15));
    CAPTURE(said(d));
    CHECK(workshop::claims(d).empty());
    CHECK(d.verdict >= verdict::partly_explained);
    const std::string note = told(d);
    CAPTURE(note);
    CHECK(note.find("angle of axis q2: 0.15 ") != note.npos);
}
TEST_CASE("turning inertia: a constant one that is wrong is the mass, whatever the elbow does") {
    const auto d = diagnosed(shoulder_and_elbow(0.9, 0));
    CAPTURE(said(d));
    CHECK(workshop::claims(d) == std::vector<std::string>{"mass"});
    CHECK(told(d).empty());
}
