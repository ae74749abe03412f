// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// A part of the record, in rows.
struct stretch_of_rows {
    std::size_t begin = 0, end = 0;
};

/// The part in which a force of zero in place of the drive's explains the most of what is left: the largest sum
/// of r^2 - (r - u)^2 over neighbouring rows. Empty where it explains less than half of the drive's own force
/// there.
inline stretch_of_rows silent_part(std::span<const double> left, std::span<const double> given) {
    stretch_of_rows best;
    double most = 0, sum = 0;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < std::min(left.size(), given.size()); ++k) {
        if (sum <= 0) {
            sum = 0;
            begin = k;
        }
        sum += given[k] * (2 * left[k] - given[k]);
        if (sum > most) {
            most = sum;
            best = {begin, k + 1};
        }
    }
    double whole = 0;
    for (std::size_t k = best.begin; k < best.end; ++k) whole += given[k] * given[k];
    return most > 0.5 * whole ? best : stretch_of_rows{};
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// The drive gives nothing in one part of the record, and no column says so: it switched itself off, or its
/// power failed. Joins the drive. The two times are of the record, so that no machine file has a key for them.
inline constexpr effect drive_dropout{
    .name = "drive_dropout",
    .label = "drive that switched itself off",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "the same motion again, with the drive's enable signal in the log",
    .once = true,
    .shows = "the drive's whole force, in one part of the record only",
    .prior = {0.1, "over-temperature, over-current and loose plugs; most leave a message in the drive"},
    .remedy = "Read the drive's fault memory, and log its enable signal as the column `_enabled`.",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const driven_motion* drive = s.record.observer.drive;
        if (!drive) return {};
        const double T = s.record.period, response = s.record.scale.response();
        auto given = drive->to_actuator(s.leader.drive, drive->given(s.leader.drive));
        for (double& f : given) f *= s.leader.force_constant;
        given = zero_phase(given, s.record.bandwidth_Hz, T);
        std::vector<double> left = s.residual;
        if (drive->tapped())
            left = zero_phase(drive->force_beside_tap(s.leader.drive, s.leader.force_constant),
                              s.record.bandwidth_Hz, T);
        const auto part = detail::silent_part(left, given);
        const double begin = static_cast<double>(part.begin) * T, end = static_cast<double>(part.end) * T;
        const double whole = static_cast<double>(given.size()) * T;
        if (end - begin < 3 * response || end - begin > 0.5 * whole) return {};
        const double within = std::max(10 * response, 0.2 * (end - begin));
        const auto moment = [&](const char* key, double& (*of)(plant_model&), double at) {
            return parameter{
                .key = key, .of = of, .start = at, .low = at - within, .high = at + within, .step = T / 2};
        };
        return {{moment(
                     "off_from_s", [](plant_model& p) -> double& { return p.drive.off_from; }, begin),
                 moment(
                     "off_until_s", [](plant_model& p) -> double& { return p.drive.off_until; }, end)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"off_from_s", {p.drive.off_from}}, {"off_until_s", {p.drive.off_until}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
